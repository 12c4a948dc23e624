import type { Case } from './api';
import { LONGEST, TOO_LONG, whyNoCase } from './form/shape';

const MARK = '#case=';

/** A case as the fragment of an address: its JSON, deflated, in base64 for addresses (RFC 4648). */
export async function toFragment(tree: Case): Promise<string> {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(tree)), new CompressionStream('deflate-raw'));
  const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  return `${MARK}${btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '')}`;
}

/** The case of a fragment; null where the fragment is not of a case. Throws what is wrong with one that cannot be opened. */
export async function fromFragment(fragment: string): Promise<Case | null> {
  if (!fragment.startsWith(MARK)) return null;
  const encoded = fragment.slice(MARK.length);
  // Base64 has four characters for three bytes, and what cannot be deflated gets hardly longer by it.
  if (encoded.length > 1.4 * LONGEST) throw new Error(TOO_LONG);
  const tree = JSON.parse(new TextDecoder().decode(await through(decoded(encoded), new DecompressionStream('deflate-raw'), LONGEST)));
  const why = whyNoCase(tree);
  if (why) throw new Error(why);
  return tree;
}

const DAMAGED = 'it is incomplete or damaged';

function decoded(base64: string): Uint8Array<ArrayBuffer> {
  try {
    const binary = atob(base64.replaceAll('-', '+').replaceAll('_', '/'));
    return Uint8Array.from(binary, (character) => character.charCodeAt(0));
  } catch {
    throw new Error(DAMAGED);
  }
}

/** Bytes go into a stream so many at once: of one chunk browsers make all that it gives before anybody reads, a thousand times as much. */
const CHUNK = 1024;

/** What a stream makes of bytes. Throws where that is more than so many, and reads no further. */
async function through(
  bytes: Uint8Array<ArrayBuffer>,
  stream: CompressionStream | DecompressionStream,
  most = Number.POSITIVE_INFINITY,
): Promise<Uint8Array> {
  let at = 0;
  const source = new ReadableStream<BufferSource>({
    pull(controller) {
      if (at < bytes.length) controller.enqueue(bytes.subarray(at, at + CHUNK));
      else controller.close();
      at += CHUNK;
    },
  });
  const reader = source.pipeThrough(stream).getReader();
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let length = 0;
  for (;;) {
    const { done, value } = await reader.read().catch(() => {
      throw new Error(DAMAGED);
    });
    if (done) return new Uint8Array(await new Blob(parts).arrayBuffer());
    length += value.length;
    if (length > most) {
      void reader.cancel().catch(() => {});
      throw new Error(TOO_LONG);
    }
    parts.push(value as Uint8Array<ArrayBuffer>);
  }
}
