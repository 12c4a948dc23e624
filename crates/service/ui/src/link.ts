import type { Case } from './api';

/** A case as the fragment of an address: its JSON, deflated, in base64 for addresses (RFC 4648). */
export async function toFragment(tree: Case): Promise<string> {
  const bytes = await through(new TextEncoder().encode(JSON.stringify(tree)), new CompressionStream('deflate-raw'));
  const binary = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  return `#case=${btoa(binary).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '')}`;
}

/** The case of a fragment; null where it has none that can be read. */
export async function fromFragment(fragment: string): Promise<Case | null> {
  const encoded = /^#case=([\w-]+)$/.exec(fragment)?.[1];
  if (!encoded) return null;
  try {
    const binary = atob(encoded.replaceAll('-', '+').replaceAll('_', '/'));
    const bytes = await through(
      Uint8Array.from(binary, (character) => character.charCodeAt(0)),
      new DecompressionStream('deflate-raw'),
    );
    const tree = JSON.parse(new TextDecoder().decode(bytes));
    return typeof tree === 'object' && tree !== null && !Array.isArray(tree) ? tree : null;
  } catch {
    return null;
  }
}

async function through(bytes: Uint8Array<ArrayBuffer>, stream: CompressionStream | DecompressionStream): Promise<Uint8Array> {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}
