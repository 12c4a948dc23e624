import { effect, signal } from '@preact/signals';
import { type Case, type Footprint, type FootprintRequest, footprint, type Problem } from '../api';
import { tidied } from '../case';
import { debounced, passed, problemOf, REST, retryOf } from '../fly';
import type { ListedSite } from '../sites';
import { draft } from '../store';
import { coarse, dependence, footprintRequest, withoutLimits } from './request';

/** A footprint as it is shown. */
export interface Reached {
  /** The case that it is of. */
  asked: Case;
  answer: Footprint;
  /** The same without the limits, where there are some and it is known. */
  wide: Footprint | null;
  /** Whether it is the outline of a case that moves, which is refined at rest. */
  isCoarse: boolean;
}

/** The newest footprint that could be found. */
export const reached = signal<Reached | null>(null);

/** Why the footprint that is asked for cannot be found. */
export const footprintProblem = signal<Problem | null>(null);

/** Whether one is being found. */
export const isSurveying = signal(false);

/** Where vehicles land that is within the footprint; the map, which has the sites, says it. */
export const sitesWithin = signal<ListedSite[]>([]);

/** A footprint is asked for so often at most, ms. */
const INTERVAL = 30;

/** What is known of the case as it is now: nothing, a coarse outline, all. */
type Known = 'nothing' | 'outline' | 'all';

/** From now on finds the footprint that is asked of the case: coarsely as the case changes, and as exactly as it is to be once that rests. */
export function startFootprints(): void {
  let request: FootprintRequest | null = null;
  let on = '';
  let known: Known = 'all';
  let isAtRest = true;
  let isRunning = false;
  /** Of a search at rest, which is given up where the case moves on. */
  let refining: AbortController | null = null;
  /** The accuracy of the last one at rest, m, and what was free in it. */
  let fine = { vary: '', resolution: 0 };
  /** The last one without limits, and on what it depends. */
  let last: { on: string; answer: Footprint } | null = null;

  const wideOf = (of: FootprintRequest): Footprint | null => {
    const wide = withoutLimits(of);
    return wide && last?.on === dependence(wide) ? last.answer : null;
  };
  const show = (answer: Footprint, of: { asked: Case; request: FootprintRequest; isCoarse: boolean }) => {
    // It is not asked for any more.
    if (!request) return;
    reached.value = { asked: of.asked, answer, wide: wideOf(of.request), isCoarse: of.isCoarse };
    footprintProblem.value = null;
  };

  const outline = async (of: FootprintRequest, asked: Case) => {
    const isLike = fine.vary === JSON.stringify(of.vary);
    show(await footprint(coarse(of, isLike ? fine.resolution : undefined)), { asked, request: of, isCoarse: true });
    return 'outline' as const;
  };
  const refine = async (of: FootprintRequest, asked: Case) => {
    refining = new AbortController();
    const { signal: given } = refining;
    const answer = await footprint(of, given);
    fine = { vary: JSON.stringify(of.vary), resolution: answer.resolution };
    show(answer, { asked, request: of, isCoarse: false });
    const wide = withoutLimits(of);
    if (wide && !wideOf(of)) {
      last = { on: dependence(wide), answer: await footprint(wide, given) };
      show(answer, { asked, request: of, isCoarse: false });
    }
    return 'all' as const;
  };

  const go = async () => {
    if (isRunning) return;
    isRunning = true;
    isSurveying.value = true;
    while (request && (known === 'nothing' || (known === 'outline' && isAtRest))) {
      const [of, began, before] = [request, performance.now(), on];
      const asked = tidied(draft.peek());
      let next: Known = known;
      try {
        next = await (known === 'nothing' ? outline : refine)(of, asked);
      } catch (error) {
        if (!refining?.signal.aborted) {
          const pause = retryOf(error);
          if (pause !== null) await passed(pause);
          else {
            next = 'all';
            if (before === on) footprintProblem.value = problemOf(error);
          }
        }
      }
      refining = null;
      // Of another case nothing is known yet.
      if (before === on) known = next;
      await passed(Math.max(began + INTERVAL - performance.now(), 0));
    }
    isRunning = false;
    isSurveying.value = false;
  };

  const rest = debounced(REST, () => {
    isAtRest = true;
    void go();
  });
  effect(() => {
    const asked = footprintRequest(draft.value);
    const next = asked ? dependence(asked) : '';
    request = asked;
    if (next === on) return;
    on = next;
    refining?.abort();
    if (!asked) {
      reached.value = null;
      footprintProblem.value = null;
      return;
    }
    known = 'nothing';
    isAtRest = false;
    rest();
    void go();
  });
}
