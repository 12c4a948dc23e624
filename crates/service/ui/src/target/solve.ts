import { effect, signal } from '@preact/signals';
import { type Case, type Corridor, type CorridorRequest, corridor, type Problem, simulate, type Target, target } from '../api';
import { alone, pathOf, set, tidied } from '../case';
import { COLOURS, type Flight, flightOf, type Run } from '../flight';
import { passed, problemOf, retryOf } from '../fly';
import { withValues } from '../footprint/request';
import { draft } from '../store';
import { corridorRequest, targetRequest } from './request';

/** What a search for a target has found, and the flights of it. */
export interface Found {
  /** The case with its goals, as it was sent. */
  asked: Case;
  answer: Target;
  /** The flights of the solutions, or of what comes nearest, as far as there are colours. */
  runs: Run[];
}

/** The answer to the newest goals that could be searched for. */
export const found = signal<Found | null>(null);

/** Why the goals as they are typed cannot be searched for. */
export const targetProblem = signal<Problem | null>(null);

/** Whether a search for a target is under way. */
export const isSolving = signal(false);

/** The values of the one free number with which the limits are kept, and its pointer. */
export const allowed = signal<{ pointer: string; bands: Corridor['bands'] } | null>(null);

/** Flights across each band of the corridor, from one end to the other. */
export const corridorFlights = signal<Flight[][]>([]);

/** Why the limits as they are typed give no corridor. */
export const corridorProblem = signal<Problem | null>(null);

/** A search is asked for so often at most, ms. */
const INTERVAL = 30;
/** Rows of a track. */
const ROWS = 240;

/** From now on searches for what is asked of the case, as it changes. */
export function startSearches(): void {
  const solve = newest(
    isSolving,
    async () => {
      const asked = tidied(draft.peek());
      const request = targetRequest(asked);
      if (!request) {
        found.value = null;
        targetProblem.value = null;
        return;
      }
      const answer = await target(request);
      const runs = await flights(asked, answer);
      // Nothing is asked any more, or of another case.
      if (!targetRequest(draft.peek())) return;
      found.value = { asked, answer, runs };
      targetProblem.value = null;
    },
    targetProblem,
  );
  const divide = newest(
    signal(false),
    async () => {
      const request = corridorRequest(draft.peek());
      const answer = request && (await corridor(request));
      allowed.value = request && answer && { pointer: request.vary.pointer, bands: answer.bands };
      corridorProblem.value = null;
      corridorFlights.value = request && answer ? await across(request, answer) : [];
    },
    corridorProblem,
  );
  let [ofTarget, ofCorridor] = ['', ''];
  effect(() => {
    const next = JSON.stringify(targetRequest(draft.value));
    if (next !== ofTarget) solve();
    ofTarget = next;
  });
  effect(() => {
    const request = corridorRequest(draft.value);
    // Its own value changes nothing of a corridor.
    const next = JSON.stringify(request && set(request, pathOf(request, request.vary.pointer), null));
    if (next !== ofCorridor) divide();
    ofCorridor = next;
  });
}

/** Flies the solutions, or what comes nearest, for the map. */
async function flights(asked: Case, { solutions, nearest }: Target): Promise<Run[]> {
  const all = [...solutions, ...(solutions.length === 0 && nearest ? [nearest] : [])].slice(0, COLOURS);
  const runs = all.map(async (solution, index): Promise<Run | null> => {
    const { echo: _, ...tree } = solution.case;
    const answer = await simulate({ ...tree, output: { count: ROWS, columns: COLUMNS } }).catch(() => null);
    return answer && { id: index + 1, label: `${index + 1}`, colour: index + 1, case: asked, flight: flightOf(answer) };
  });
  return (await Promise.all(runs)).filter((run) => run !== null);
}

/** So many ranges of a corridor are drawn. */
const MOST_BANDS = 3;

/** Into so many strips a band is divided, so that a strip is about what lies between its two flights. */
const STRIPS = 8;

/** Flies across the bands of a corridor, for the plot. */
async function across({ vary, limits: _, ...flight }: CorridorRequest, { bands }: Corridor): Promise<Flight[][]> {
  const fly = async (value: number): Promise<Flight | null> => {
    const moved = alone(withValues({ ...flight, vary: [vary] } as Case, [value]));
    const answer = await simulate({ ...moved, output: { count: ROWS, columns: ['time', 'altitude', 'speed'] } }).catch(() => null);
    return answer && flightOf(answer);
  };
  const flown = bands.slice(0, MOST_BANDS).map(async ({ from, to }) => {
    const values = Array.from({ length: STRIPS + 1 }, (_, index) => from + ((to - from) * index) / STRIPS);
    return (await Promise.all(values.map(fly))).filter((flight) => flight !== null);
  });
  return (await Promise.all(flown)).filter(({ length }) => length > 1);
}

/** The columns of a track. */
const COLUMNS = ['time', 'longitude', 'geodetic_latitude', 'altitude'];

/** Does a task once it is asked for, one at a time: what is asked meanwhile is done once, after it; where the service is busy, again. */
function newest(isBusy: { value: boolean }, task: () => Promise<void>, problem: { value: Problem | null }): () => void {
  let [isWanted, isRunning] = [false, false];
  const go = async () => {
    isRunning = true;
    isBusy.value = true;
    while (isWanted) {
      isWanted = false;
      const began = performance.now();
      try {
        await task();
      } catch (error) {
        const pause = retryOf(error);
        if (pause === null) problem.value = problemOf(error);
        else {
          isWanted = true;
          await passed(pause);
        }
      }
      await passed(Math.max(began + INTERVAL - performance.now(), 0));
    }
    isRunning = false;
    isBusy.value = false;
  };
  return () => {
    isWanted = true;
    if (!isRunning) void go();
  };
}
