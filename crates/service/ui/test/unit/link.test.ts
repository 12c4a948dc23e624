import { randomBytes } from 'node:crypto';
import { deflateRawSync } from 'node:zlib';
import { expect, it, vi } from 'vitest';
import type { Case } from '../../src/api';
import { fromFragment, toFragment } from '../../src/link';

const fragmentOf = (text: string) => `#case=${deflateRawSync(text).toString('base64url')}`;
const CUT = fragmentOf(JSON.stringify({ vehicle: {}, initial_state: {} })).slice(0, -8);

it('a case in an address comes back as it was', async () => {
  const tree = {
    name: 'Böck „Ω“ #1 & 2',
    vehicle: { mass: 0.1 + 0.2 },
    initial_state: { type: 'eci', position: [1e-300, -0.5, 6.5e6] },
  } as unknown as Case;
  const fragment = await toFragment(tree);
  expect(fragment).toMatch(/^#case=[\w-]+$/);
  expect(await fromFragment(fragment)).toEqual(tree);
});

it.each(['', '#', '#other=abc'])('%j is not of a case', async (fragment) => {
  expect(await fromFragment(fragment)).toBeNull();
});

it.each(['#case=', '#case=!!', '#case=A', '#case=AAAA', '#case=ü', CUT])('%j is incomplete or damaged', async (fragment) => {
  await expect(fromFragment(fragment)).rejects.toThrow('it is incomplete or damaged');
});

it('what is in a link is a case', async () => {
  await expect(fromFragment(await toFragment([1] as unknown as Case))).rejects.toThrow('it is not a JSON object');
  await expect(fromFragment(fragmentOf('text'))).rejects.toThrow('is not valid JSON');
  const tree = { vehicle: {}, initial_state: {}, events: 'text' };
  await expect(fromFragment(fragmentOf(JSON.stringify(tree)))).rejects.toThrow('/events must be an array');
});

it('a link is no longer than a case may be', async () => {
  await expect(fromFragment(`#case=${'A'.repeat(3 << 19)}`)).rejects.toThrow('it exceeds 1 MiB');
  // What cannot be deflated, up to the limit.
  const name = randomBytes(780_000).toString('base64url');
  const tree = { name, vehicle: {}, initial_state: {} } as unknown as Case;
  expect(await fromFragment(await toFragment(tree))).toEqual(tree);
});

it('of a link that inflates without bound a little is read', async () => {
  let inflated = 0;
  const Original = DecompressionStream;
  const counted = vi.fn(function counted(format: CompressionFormat) {
    const { readable, writable } = new Original(format);
    const counter = new TransformStream<Uint8Array, Uint8Array>({
      transform(part, controller) {
        inflated += part.length;
        controller.enqueue(part);
      },
    });
    return { readable: readable.pipeThrough(counter), writable };
  });
  vi.stubGlobal('DecompressionStream', counted);
  const fragment = fragmentOf(' '.repeat(60e6));
  expect(fragment.length).toBeLessThan(80_000);
  await expect(fromFragment(fragment)).rejects.toThrow('it exceeds 1 MiB');
  vi.unstubAllGlobals();
  expect(inflated).toBeGreaterThan(1 << 20);
  expect(inflated).toBeLessThan(4 << 20);
});
