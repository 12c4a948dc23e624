import { signal } from '@preact/signals';
import { get, type Path, pointer } from '../case';
import { draft } from '../store';

/** What parts of the case held before another choice took their place. */
const held = new Map<string, unknown>();

/** What a part is to be when one of its choices takes another's place: what it was when that was chosen last, or else a start. */
export function exchanged(path: Path, from: string, to: string, start: unknown, left = get(draft.peek(), path)): unknown {
  held.set(`${pointer(path)} ${from}`, left);
  return held.get(`${pointer(path)} ${to}`) ?? start;
}

/** What another planet changed beside itself, and for which planet that holds. */
export const settled = signal<{ model: string; changes: string[] } | null>(null);

/** Nothing of one case comes back in another, nor of one element of a list in the next. */
export function forget(): void {
  held.clear();
  settled.value = null;
}
