import { expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { fromFragment, toFragment } from '../../src/link';

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

it.each(['', '#', '#case=', '#case=!!', '#case=AAAA', '#other=abc'])('%j has no case', async (fragment) => {
  expect(await fromFragment(fragment)).toBeNull();
});

it('a list is no case', async () => {
  expect(await fromFragment(await toFragment([1] as unknown as Case))).toBeNull();
});
