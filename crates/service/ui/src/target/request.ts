import type { Case, CorridorRequest, Goal, Limit, Target, TargetRequest } from '../api';
import { alone, get, pathOf, set, tidied } from '../case';

/** A search tells of flights: what else is asked of one flight is no part of it. */
export function searched(tree: Case) {
  const { output: _, sensitivities: __, dispersions: ___, verify: ____, echo: _____, ...flight } = alone(tidied(tree));
  return flight;
}

/** The request of `/target` that a case makes; null where no number is free or nothing is to be achieved. */
export function targetRequest(tree: Case): TargetRequest | null {
  const { vary, achieve } = tree;
  if (!vary?.length || !achieve?.length) return null;
  return { ...searched(tree), vary, achieve };
}

/** The request of `/corridor` that a case makes: with one free number, and limits; null of any other. */
export function corridorRequest(tree: Case): CorridorRequest | null {
  const [number, another] = tree.vary ?? [];
  const limits = tree.limits ?? (tree.achieve ?? []).filter(isLimit).map(asLimit);
  if (!number || another || limits.length === 0) return null;
  return { ...searched(tree), vary: number, limits };
}

/** Whether a goal is a range, and so a limit too. */
function isLimit(goal: Goal): boolean {
  return 'termination' in goal || ['at_least', 'at_most', 'between', 'within'].some((name) => name in goal);
}

function asLimit(goal: Goal): Limit {
  const { tolerance: _, ...limit } = goal as { tolerance?: number };
  return limit as Limit;
}

/** A case with the numbers of a solution, as the case writes them. */
export function taken(tree: Case, solution: Pick<Target['solutions'][number], 'case'>): Case {
  const pointers = (tree.vary ?? []).flatMap(({ pointer, also = [] }) => [pointer, ...also.map((along) => along.pointer)]);
  return pointers.reduce((next, at) => {
    const path = pathOf(solution.case, at);
    const value = get(solution.case, path);
    return value === undefined ? next : set(next, path, value);
  }, tree);
}

/** How many misses a goal has: a site that is to be met has two. */
export function missesOf(goal: Goal): number {
  if ('termination' in goal) return 0;
  return 'site' in goal && !('within' in goal) ? 2 : 1;
}
