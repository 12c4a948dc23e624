import { signal } from '@preact/signals';
import type { Case, Goal } from '../api';
import { set, turned } from '../case';
import { sites } from '../sites';
import { draft } from '../store';

/** Whether the next click on the map is the place to be reached. */
export const isAiming = signal(false);

/** Where a goal has the flight end, degrees, and within which distance that is enough, m. */
export interface TargetPlace {
  place: [number, number];
  within: number | null;
}

/** The goal that is a place: its index; -1 where there is none. */
export function placeGoal(tree: Case): number {
  return tree.achieve?.findIndex((goal) => 'site' in goal) ?? -1;
}

/** The place that is to be reached; null where none is, or is not known. */
export function targetPlace(tree: Case): TargetPlace | null {
  const goal = tree.achieve?.[placeGoal(tree)] as { site?: unknown; within?: unknown } | undefined;
  if (!goal) return null;
  const within = typeof goal.within === 'number' ? goal.within : null;
  const own = tree.angle_unit === 'deg' ? 'deg' : 'rad';
  const { site } = goal;
  if (typeof site === 'string') {
    const listed = sites.value.find(({ slug }) => slug === site);
    return listed ? { place: [listed.longitude, listed.geodetic_latitude], within } : null;
  }
  const { longitude, geodetic_latitude: latitude } = (site ?? {}) as Record<string, unknown>;
  const place = [longitude, latitude].map((angle) => turned(angle, own, 'deg'));
  return place.every((angle) => typeof angle === 'number') ? { place: place as [number, number], within } : null;
}

/** How near to a place is there, m, where nothing else is said. */
const TOLERANCE = 100;

/** A case with another place to be reached, degrees; with a goal of it, where it has none. */
export function withPlace(tree: Case, [longitude, latitude]: [number, number]): Case {
  const own = tree.angle_unit === 'deg' ? 'deg' : 'rad';
  const site = {
    longitude: turned(longitude, 'deg', own),
    geodetic_latitude: turned(latitude, 'deg', own),
  };
  const index = placeGoal(tree);
  if (index >= 0) return set(tree, ['achieve', index, 'site'], site);
  const goal = { site, tolerance: TOLERANCE } as unknown as Goal;
  return { ...tree, achieve: [goal, ...(tree.achieve ?? [])] };
}

/** Puts the place to be reached elsewhere, degrees, in as many decimals. */
export function aimAt([longitude, latitude]: [number, number], decimals: number): void {
  const rounded = (angle: number) => Number(angle.toFixed(decimals));
  draft.value = withPlace(draft.peek(), [rounded(longitude), rounded(latitude)]);
}
