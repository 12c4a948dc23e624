import { batch, effect } from '@preact/signals';
import { analytic, type Case, type Problem, ProblemError, type Solution, simulate } from './api';
import { tidied } from './case';
import { flightOf } from './flight';
import { fromFragment, toFragment } from './link';
import { current, draft, isBusy, problem, solution, theory, theoryProblem } from './store';

/** At most so often, ms, a case that is being changed is flown. */
const INTERVAL = 30;
/** The address follows the case after so long a pause, ms: browsers allow few changes of it. */
const PAUSE = 300;
/** Rows in a plot are no more than this, as far as a flight's number of steps tells. */
const ROWS = 2400;
const DENSEST = 8;

let samples = DENSEST;
let flying: AbortController | null = null;
let address = '';

/** From now on flies the case as it changes, sets the theory beside it, and keeps it in the address. */
export function start(): void {
  const fly = throttled(INTERVAL, () => void flown(tidied(draft.peek()), solution.peek()));
  const keep = debounced(PAUSE, () => void kept(tidied(draft.peek())));
  effect(() => {
    if (Object.keys(draft.value).length > 0) {
      void solution.value;
      fly();
      keep();
    }
  });
  addEventListener('hashchange', () => void opened());
}

/** Takes the case of the address, if it has one; whether it has. */
export async function opened(): Promise<boolean> {
  if (location.hash === address) return address !== '';
  const found = await fromFragment(location.hash);
  if (found) take(found);
  return found !== null;
}

/** Takes a case; one of `/analytic` with the theory that it asks for. */
export function take(tree: Case & { solution?: Solution }): void {
  const { solution: asked, ...flight } = tree;
  batch(() => {
    draft.value = flight;
    if (asked) solution.value = asked;
  });
}

async function kept(tree: Case): Promise<void> {
  address = await toFragment(tree);
  history.replaceState(null, '', address);
}

/** Flies a case. Where another is to be flown before it is answered, this one is given up. */
async function flown(tree: Case, beside: Solution | null): Promise<void> {
  flying?.abort();
  const request = new AbortController();
  flying = request;
  isBusy.value = true;
  try {
    const answer = await answered(tree, request.signal);
    if (request.signal.aborted) return;
    samples = Math.min(Math.max(Math.floor(ROWS / answer.solver.steps), 1), DENSEST);
    current.value = { id: 0, label: tree.name ?? 'Current', colour: 0, case: tree, flight: flightOf(answer) };
    problem.value = null;
    await predicted(tree, beside, request.signal);
  } catch (error) {
    if (!request.signal.aborted) problem.value = problemOf(error);
  } finally {
    if (flying === request) isBusy.value = false;
  }
}

/** The flight with rows for plots: many where it is fast, or evenly where those would be too many. */
async function answered(tree: Case, signal: AbortSignal) {
  try {
    return await simulate({ ...tree, output: { samples_per_step: samples } }, signal);
  } catch (error) {
    const isTooLong = error instanceof ProblemError && error.problem.errors?.some(({ pointer }) => pointer.startsWith('/output'));
    if (!isTooLong) throw error;
    return simulate({ ...tree, output: { count: ROWS } }, signal);
  }
}

/** The theory beside the flight; it knows no heating, which changes nothing of the flight. */
async function predicted(tree: Case, beside: Solution | null, signal: AbortSignal): Promise<void> {
  if (!beside) {
    theory.value = null;
    theoryProblem.value = null;
    return;
  }
  const { heating: _, sensitivities: __, verify: ___, ...flight } = tree;
  try {
    const answer = await analytic({ ...flight, solution: beside, output: { samples_per_step: samples } }, signal);
    if (signal.aborted) return;
    theory.value = answer;
    theoryProblem.value = null;
  } catch (error) {
    if (signal.aborted) return;
    theory.value = null;
    theoryProblem.value = problemOf(error);
  }
}

/** What went wrong, as a problem document, also where the service did not answer. */
function problemOf(error: unknown): Problem {
  if (error instanceof ProblemError) return error.problem;
  return { type: 'about:blank', title: 'No answer', status: 0, detail: 'The service does not answer. Is it running?' };
}

/** Calls at once, and then at most so often, the last time after the last request. */
function throttled(interval: number, call: () => void): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let last = Number.NEGATIVE_INFINITY;
  return () => {
    clearTimeout(timer);
    const run = () => {
      last = performance.now();
      call();
    };
    const wait = last + interval - performance.now();
    if (wait <= 0) run();
    else timer = setTimeout(run, wait);
  };
}

/** Calls when nothing was asked for so long. */
function debounced(pause: number, call: () => void): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  return () => {
    clearTimeout(timer);
    timer = setTimeout(call, pause);
  };
}
