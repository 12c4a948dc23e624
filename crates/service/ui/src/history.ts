import { batch, effect, signal, untracked } from '@preact/signals';
import type { Case } from './api';
import { tidied } from './case';
import { whyNoCase } from './form/shape';
import { remember, remembered } from './memory';
import { draft } from './store';

/** The cases before the one that is typed, the last the nearest. */
export const past = signal<Case[]>([]);
/** The cases that were undone, the last the nearest. */
export const future = signal<Case[]>([]);

const MOST = 200;
/** Changes by keys that follow each other within this, ms, are undone together. */
const PAUSE = 600;

let before: Case = draft.peek();
/** Whether the next change belongs to the last entry. */
let isOpen = false;
let isHeld = false;
let last = Number.NEGATIVE_INFINITY;

/** The next change gets an entry of its own. */
export function separate(): void {
  isOpen = false;
}

/** From now on keeps every case that is changed; what one does without letting go of a pointer is one change. */
export function follow(): void {
  addEventListener(
    'pointerdown',
    () => {
      isHeld = true;
      separate();
    },
    true,
  );
  const released = () => {
    isHeld = false;
  };
  // A key as well: where a list drops down, browsers do not tell of the pointer any more.
  for (const end of ['pointerup', 'pointercancel', 'keydown']) addEventListener(end, released, true);
  addEventListener('focusin', () => {
    if (!isHeld) separate();
  });
  addEventListener('keydown', byKey);
  effect(() => {
    const now = draft.value;
    untracked(() => noted(now));
  });
}

function noted(now: Case): void {
  if (now === before) return;
  const isSame = JSON.stringify(now) === JSON.stringify(before);
  if (!isSame && Object.keys(before).length > 0) {
    const time = performance.now();
    if (!isOpen || (!isHeld && time - last > PAUSE)) past.value = [...past.value, before].slice(-MOST);
    isOpen = true;
    last = time;
    future.value = [];
  }
  before = now;
}

/** The case before the last change. */
export function undo(): void {
  move(past, future);
}

/** The case that was undone last. */
export function redo(): void {
  move(future, past);
}

function move(from: typeof past, to: typeof past): void {
  const found = from.peek().at(-1);
  if (!found) return;
  batch(() => {
    from.value = from.peek().slice(0, -1);
    to.value = [...to.peek(), before];
    before = found;
    draft.value = found;
  });
  separate();
}

/** Every field writes into the case at once, so that the browser's own undoing within a field is not needed. */
function byKey(event: KeyboardEvent): void {
  if (!(event.ctrlKey || event.metaKey) || event.altKey || document.querySelector('dialog[open]')) return;
  const key = event.key.toLowerCase();
  if (key !== 'z' && key !== 'y') return;
  event.preventDefault();
  if (key === 'y' || event.shiftKey) redo();
  else undo();
}

/** A case that was worked on. */
export interface Recent {
  id: number;
  /** When it was changed last, ms since 1970. */
  at: number;
  case: Case;
}

const KEPT = 20;

/** The cases that were worked on, the last first, kept over visits. */
export const recent = signal<Recent[]>(read());

/** The case that is being worked on: its place in the list, and how it was when it was opened. */
let work = { id: Date.now(), opened: '' };

/** Begins to work on another case. */
export function begin(tree: Case): void {
  work = { id: Math.max(Date.now(), work.id + 1), opened: JSON.stringify(tidied(tree)) };
}

/** Keeps the case that is being worked on, if it was changed. */
export function keep(tree: Case): void {
  const text = JSON.stringify(tree);
  if (text === work.opened || Object.keys(tree).length === 0) return;
  const others = recent.peek().filter((other) => other.id !== work.id && JSON.stringify(other.case) !== text);
  recent.value = [{ id: work.id, at: Date.now(), case: tree }, ...others].slice(0, KEPT);
  remember('recent', JSON.stringify(recent.peek()));
}

function read(): Recent[] {
  try {
    const found = JSON.parse(remembered('recent') ?? '[]');
    const isSound = (entry: Partial<Recent> | null) =>
      Number.isFinite(entry?.id) && Number.isFinite(entry?.at) && whyNoCase(entry?.case) === null;
    return Array.isArray(found) ? found.filter(isSound) : [];
  } catch {
    return [];
  }
}
