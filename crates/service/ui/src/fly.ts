import { batch, effect } from '@preact/signals';
import { type Answer, analytic, type Case, type Problem, ProblemError, type Solution, simulate, type Theory } from './api';
import { adopted, alone, tidied } from './case';
import { flightOf, isLaunched } from './flight';
import { forget } from './form/held';
import { begin, follow, keep, separate } from './history';
import { fromFragment, toFragment } from './link';
import { drawn } from './plots/curves';
import type { Name } from './quantities';
import { added, current, draft, isBusy, notice, pins, problem, solution, theory, theoryProblem, waiting } from './store';

/** At most so often, ms, a case that is being changed is flown; less often where the service asks for that. */
const INTERVAL = { least: 30, most: 2000 };
/** After so long without a change, ms, a case is at rest: it is flown with all its rows, and kept in the address. */
export const REST = 250;
/** Rows in a plot are no more than this, as far as a flight's number of steps tells. */
const ROWS = { moving: 240, resting: 2400 };
const DENSEST = 8;
/** How long, ms, the service may be away before the reader is told. */
const PATIENCE = 3000;

let isMoving = false;
let isWanted = false;
/** Whether the flight that is shown has but the rows of a case that moves. */
let isCoarse = false;
let interval = INTERVAL.least;
let steps = 0;
let flying = new AbortController();
let address = '';

/** From now on flies the case as it changes, sets the theory beside it, and keeps it in the address. */
export function start(): void {
  let changed = Number.NEGATIVE_INFINITY;
  let before: unknown[] = [];
  const rest = debounced(REST, () => {
    isMoving = false;
    if (isCoarse) want();
    void kept();
  });
  follow();
  effect(() => {
    if (Object.keys(draft.value).length === 0) return;
    rest();
    // What is asked of a case changes nothing of its flight.
    const parts = [...Object.values(alone(draft.value)), solution.value, added.value];
    const isSame = parts.length === before.length && parts.every((part, index) => part === before[index]);
    before = parts;
    if (isSame) return;
    const now = performance.now();
    isMoving = now - changed < REST;
    changed = now;
    want();
  });
  effect(() => {
    document.title = draft.value.name ? `${draft.value.name} · reentry` : 'reentry';
  });
  addEventListener('hashchange', () => void opened());
}

/** Takes the case of the address, if it has one; whether it has. Why a link cannot be opened the reader is told, and keeps what is there. */
export async function opened(): Promise<boolean> {
  const { hash } = location;
  if (hash === address) return address !== '';
  const found = await fromFragment(hash).catch((error: Error) => error);
  // The reader may have gone on meanwhile.
  if (location.hash !== hash) return true;
  address = hash;
  if (found instanceof Error) {
    notice.value = `Cannot open the case in this link: ${found.message}.`;
    if (Object.keys(draft.peek()).length > 0) kept();
    return false;
  }
  if (found) {
    notice.value = null;
    take(found);
  }
  return found !== null;
}

/** Opens a case in place of the one that is there, to which the browser's Back returns. */
export function open(tree: Case & { solution?: Solution }): void {
  const left = tidied(draft.peek());
  take(tree);
  if (Object.keys(left).length === 0) return;
  const next = tidied(draft.peek());
  addressed(async () => {
    await replaceAddress(left);
    const fragment = await toFragment(next);
    history.pushState(null, '', fragment);
    address = fragment;
  });
}

/** Takes a case; one of `/analytic` with the theory that it asks for. What is under way for another is given up. */
function take(tree: Case & { solution?: Solution }): void {
  const { solution: asked, ...flight } = adopted(tree);
  keep(tidied(draft.peek()));
  begin(flight);
  forget();
  separate();
  flying.abort();
  batch(() => {
    draft.value = flight;
    if (asked) solution.value = asked;
  });
  separate();
}

let addressing = Promise.resolve();

/** Changes of the address follow each other, as a fragment takes a while to make. */
function addressed(change: () => Promise<void>): void {
  addressing = addressing.then(change).catch(() => {});
}

function kept(): void {
  keep(tidied(draft.peek()));
  addressed(() => replaceAddress(tidied(draft.peek())));
}

/** Writes a case into the address; not where the browser's Back or Forward went on meanwhile, as the address is another case's then. */
async function replaceAddress(tree: Case): Promise<void> {
  const before = address;
  const fragment = await toFragment(tree);
  if (location.hash !== before || address !== before) return;
  history.replaceState(null, '', fragment);
  address = fragment;
}

function want(): void {
  isWanted = true;
  if (!isBusy.peek()) void flyOn();
}

/** Flies the case as it is now, and again as long as it changed meanwhile: one request at a time, and none of a drag is given up. */
async function flyOn(): Promise<void> {
  isBusy.value = true;
  let failing = 0;
  while (isWanted) {
    isWanted = false;
    flying = new AbortController();
    const began = performance.now();
    try {
      const show = await flown(alone(tidied(draft.peek())), isMoving);
      // The case came to rest meanwhile.
      if (isCoarse && !isMoving) isWanted = true;
      // The next is asked for while this one is drawn.
      setTimeout(show);
      failing = 0;
      interval = Math.max(interval / 2, INTERVAL.least);
      waiting.value = null;
    } catch (error) {
      if (flying.signal.aborted) continue;
      const found = problemOf(error);
      const pause = retryOf(error);
      if (pause === null) {
        problem.value = found;
        waiting.value = null;
      } else {
        // The newest case is flown then.
        isWanted = true;
        failing ||= began;
        if (found.status === 429) interval = Math.min(2 * interval, INTERVAL.most);
        waiting.value = isAway(found) ? 'Service not responding; retrying …' : 'Service busy; retrying …';
        if (isAway(found) && performance.now() - failing > PATIENCE) problem.value = found;
        await passed(pause);
      }
    }
    const early = began + interval - performance.now();
    if (early > 0) await passed(early);
  }
  isBusy.value = false;
}

export const passed = (pause: number) => new Promise((resolve) => setTimeout(resolve, pause));

/** Flies a case, with the theory beside it; what shows them. */
async function flown(tree: Case, moving: boolean): Promise<() => void> {
  const { signal } = flying;
  const rows = moving ? ROWS.moving : ROWS.resting;
  const [answer, beside] = await Promise.all([answered(tree, rows, signal), predicted(tree, rows, signal)]);
  steps = answer.solver.steps;
  isCoarse = moving;
  return () => {
    // Another case was opened meanwhile.
    if (signal.aborted) return;
    const flight = flightOf(answer);
    batch(() => {
      current.value = { id: 0, label: tree.name ?? 'Current', colour: 0, case: tree, flight };
      problem.value = null;
      theory.value = beside.theory;
      theoryProblem.value = beside.problem;
    });
    // Other models have other columns, of which some are to be drawn.
    if (columnsDrawn().some((name) => !flight.columns[name])) want();
  };
}

const samplesFor = (rows: number) => Math.min(Math.max(Math.floor(rows / (steps || 1)), 1), DENSEST);

/** The flight with rows for plots: many where it is fast, or evenly where those would be too many. */
async function answered({ echo: _, ...tree }: Case, rows: number, signal: AbortSignal): Promise<Answer> {
  const chosen = columnsOf(tree);
  try {
    return await simulate({ ...tree, output: { samples_per_step: samplesFor(rows), ...chosen } }, signal);
  } catch (error) {
    const isTooLong = error instanceof ProblemError && error.problem.errors?.some(({ pointer }) => pointer.startsWith('/output'));
    if (!isTooLong) throw error;
    return simulate({ ...tree, output: { count: rows, ...chosen } }, signal);
  }
}

/** The columns that are drawn, where the models are those of the flight that is shown; all where it is not known which there are. */
function columnsOf(tree: Case): { columns?: string[] } {
  const shown = current.peek();
  return shown && modelsOf(shown.case) === modelsOf(tree) ? { columns: columnsDrawn() } : {};
}

/** The columns that are drawn of the flight that is shown. */
function columnsDrawn(): Name[] {
  const shown = current.peek();
  return shown ? drawn(shown.flight.final, added.peek(), isLaunched(shown)) : [];
}

/** On which it depends what is known of a flight. */
function modelsOf({ planet, atmosphere, epoch, heating, events, vehicle, initial_state }: Case): string {
  const parts = Array.isArray(vehicle?.parts);
  return JSON.stringify([planet, atmosphere, epoch, heating, events, parts, initial_state?.type === 'launch']);
}

/** The theory beside the flight; it knows no heating, which changes nothing of the flight. */
async function predicted(tree: Case, rows: number, signal: AbortSignal): Promise<{ theory: Theory | null; problem: Problem | null }> {
  const beside = solution.peek();
  if (!beside) return { theory: null, problem: null };
  const { heating: _, sensitivities: __, dispersions: ___, verify: ____, echo: _____, ...flight } = tree;
  try {
    return {
      theory: await analytic({ ...flight, solution: beside, output: { samples_per_step: samplesFor(rows) } }, signal),
      problem: null,
    };
  } catch (error) {
    if (retryOf(error) !== null || signal.aborted) throw error;
    return { theory: null, problem: problemOf(error) };
  }
}

/** A run with all its columns and rows, whatever is drawn later; as it is where the service does not give it. */
export async function completed(id: number): Promise<void> {
  const run = pins.peek().find((pin) => pin.id === id);
  if (!run) return;
  const { echo: _, ...tree } = run.case;
  const rows = { samples_per_step: samplesFor(ROWS.resting) };
  const answer = await simulate({ ...tree, output: rows }).catch(() => null);
  if (answer) pins.value = pins.peek().map((pin) => (pin.id === id ? { ...pin, flight: flightOf(answer) } : pin));
}

/** What went wrong, as a problem document, also where the service did not answer. */
export function problemOf(error: unknown): Problem {
  if (error instanceof ProblemError) return error.problem;
  return { type: 'about:blank', title: 'No response', status: 0, detail: 'The service does not respond. Check that it is running.' };
}

/** Whether nobody answered, or a proxy in the service's place. */
const isAway = ({ status }: Problem) => [0, 502, 504].includes(status);

/** After how long, ms, the service is to be asked again; null where the case is at fault. */
export function retryOf(error: unknown): number | null {
  const { status } = problemOf(error);
  if (status !== 503 && status !== 429 && !isAway({ status } as Problem)) return null;
  const asked = error instanceof ProblemError ? error.retryAfter : null;
  return 1e3 * Math.min(asked ?? 1, 60);
}

/** Calls when nothing was asked for so long. */
export function debounced(pause: number, call: () => void): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(call, pause);
  };
}
