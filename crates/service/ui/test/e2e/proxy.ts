import { createServer, type OutgoingHttpHeaders, request } from 'node:http';
import type { AddressInfo } from 'node:net';

/** An answer in place of the service's. */
export interface Refusal {
  status: number;
  headers?: OutgoingHttpHeaders;
}

/** A network between the page and the service. */
export interface Network {
  address: string;
  /** How long, ms, it takes there and back. */
  delay: number;
  /** What a POST is answered in place of the service, if anything. */
  refuse: () => Refusal | null;
  stop(): Promise<void>;
}

/** A network to a service, without a delay at first. */
export async function networkTo(service: string): Promise<Network> {
  const target = new URL(service);
  const half = () => new Promise((resolve) => setTimeout(resolve, network.delay / 2));
  const server = createServer(async (incoming, outgoing) => {
    const chunks: Buffer[] = [];
    for await (const chunk of incoming) chunks.push(chunk as Buffer);
    await half();
    const refusal = incoming.method === 'POST' ? network.refuse() : null;
    if (refusal) {
      await half();
      outgoing.writeHead(refusal.status, refusal.headers).end();
      return;
    }
    const { host: _, ...headers } = incoming.headers;
    const onward = request(
      { host: target.hostname, port: target.port, path: incoming.url, method: incoming.method, headers },
      async (answer) => {
        const body: Buffer[] = [];
        for await (const chunk of answer) body.push(chunk as Buffer);
        await half();
        outgoing.writeHead(answer.statusCode ?? 502, answer.headers).end(Buffer.concat(body));
      },
    );
    onward.on('error', () => outgoing.writeHead(502).end());
    onward.end(Buffer.concat(chunks));
  });
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  const network: Network = {
    address: `http://127.0.0.1:${(server.address() as AddressInfo).port}`,
    delay: 0,
    refuse: () => null,
    async stop() {
      server.closeAllConnections();
      await new Promise((resolve) => server.close(resolve));
    },
  };
  return network;
}
