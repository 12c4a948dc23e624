import type { Case, FootprintOptions, FootprintRequest, Goal } from '../api';
import { get, type Path, pathOf, set } from '../case';
import { searched } from '../target/request';

/** So many numbers may be free. */
export const MOST_FREE = 8;

/** The limits that the landings of a footprint keep: those of the case, and the goals that are ranges or ways to end. */
export function limitsOf(tree: Case): NonNullable<FootprintRequest['limits']> {
  // One that is flown with other numbers is of a corridor alone.
  const own = (tree.limits ?? []).filter((limit) => get(limit, ['with']) === undefined);
  const goals = (tree.achieve ?? []).filter(isRange).map((goal) => {
    const { tolerance: _, ...limit } = goal as { tolerance?: number };
    return limit;
  });
  return [...own, ...goals] as NonNullable<FootprintRequest['limits']>;
}

/** Whether a goal is a range of a quantity or a way to end, which a footprint keeps too; a place is where one wants to be in it. */
function isRange(goal: Goal): boolean {
  return 'termination' in goal || ('quantity' in goal && ['at_least', 'at_most', 'between'].some((name) => name in goal));
}

/** The request of `/footprint` that a case makes; null where none is asked for, or nothing is free, or too much. */
export function footprintRequest(tree: Case): FootprintRequest | null {
  const { vary, footprint } = tree;
  if (!footprint || !vary?.length || vary.length > MOST_FREE) return null;
  const { resolution, flights }: FootprintOptions = typeof footprint === 'object' ? footprint : {};
  const limits = limitsOf(tree);
  return {
    ...searched(tree),
    vary,
    ...(limits.length > 0 ? { limits } : {}),
    ...(resolution === undefined ? {} : { resolution }),
    ...(flights === undefined ? {} : { search: { flights } }),
  };
}

/** What is asked while the case moves. */
const COARSE = { flights: 1500, factor: 5 };

/** A request of the same with a coarse outline, of which the accuracy is known that an outline at rest had, m. */
export function coarse(request: FootprintRequest, resolution: number | undefined): FootprintRequest {
  const own = request.resolution ?? resolution;
  return {
    ...request,
    ...(own === undefined ? {} : { resolution: COARSE.factor * own }),
    search: { flights: Math.min(COARSE.flights, request.search?.flights ?? COARSE.flights) },
  };
}

/** The same request without its limits; null where it has none. */
export function withoutLimits({ limits, ...request }: FootprintRequest): FootprintRequest | null {
  return limits?.length ? request : null;
}

/**
 * What a footprint depends on: its own values of what is free change nothing of it, as long as they are within the bounds. Two requests
 * with the same text have the same footprint.
 */
export function dependence(request: FootprintRequest): string {
  const fixed = request.vary.reduce((tree, { pointer, between }) => {
    const [least, greatest] = between as [number, number];
    const path = pathOf(tree, pointer);
    const masked = (value: unknown): unknown =>
      Array.isArray(value) ? value.map(masked) : typeof value === 'number' && value >= least && value <= greatest ? true : value;
    const own = get(tree, path);
    return own === undefined ? tree : set(tree, path, masked(own));
  }, request);
  return JSON.stringify(fixed);
}

/** A case with other numbers for what is free, in the order in which a search has them: of a list one each. */
export function withValues(tree: Case, values: number[]): Case {
  let at = 0;
  return (tree.vary ?? []).reduce((next, { pointer, also = [] }) => {
    const places = placesOf(tree, pointer);
    const own = values.slice(at, at + places.length);
    at += own.length;
    const last = own.at(-1);
    if (last === undefined) return next;
    const moved = own.reduce((to, value, index) => set(to, places[index] as Path, value), next);
    const coupled = also.flatMap(({ pointer: along, factor }) =>
      placesOf(tree, along).map((place) => [place, (factor ?? 1) * last] as const),
    );
    return coupled.reduce((to, [place, value]) => set(to, place, value), moved);
  }, tree);
}

/** The paths of the numbers of a pointer: of a list one each. */
function placesOf(tree: Case, pointer: string): Path[] {
  const path = pathOf(tree, pointer);
  const own = get(tree, path);
  return Array.isArray(own) ? own.map((_, index) => [...path, index]) : [path];
}
