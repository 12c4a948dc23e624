import type { Theory } from '../api';
import { at, type Flight, type Run } from '../flight';
import { type AngleUnit, type Name, QUANTITIES, scaleOf, unitOf } from '../quantities';

/** How the plots are laid out: as in the thesis, or all against one quantity. */
export type Layout = 'thesis' | 'time' | 'altitude' | 'speed' | 'downrange';

/** What a plot shows: one quantity against another. */
export interface Axes {
  x: Name;
  y: Name;
}

/** The plots of the thesis, figures of its chapter IV, and those that every planner asks for where the flight has them. */
const THESIS: Name[] = ['altitude', 'deceleration', 'flight_path_angle', 'longitude', 'geocentric_latitude', 'speed', 'heading'];
const OTHERS: Name[] = [
  'load_factor',
  'dynamic_pressure',
  'mach',
  'convective_heat_flux',
  'radiative_heat_flux',
  'heat_load',
  'wall_temperature',
  'mass',
  'thrust',
  'throttle',
];

/** The quantities that are plotted of a flight of which these are known. */
export function plotted(known: object, added: Name[]): Name[] {
  return [...THESIS, ...OTHERS, ...added].filter((name, index, all) => name in known && all.indexOf(name) === index);
}

/** The columns that plots and maps draw; of a launch the downrange as well. */
export function drawn(known: object, added: Name[], isLaunched: boolean): Name[] {
  const placed: Name[] = ['time', 'longitude', 'geodetic_latitude'];
  const ranged: Name[] = isLaunched && 'downrange' in known ? ['downrange'] : [];
  return [...placed, ...ranged, ...plotted(known, added)].filter((name, index, all) => all.indexOf(name) === index);
}

/** The quantities that may be added. */
export function addable(known: object, added: Name[]): Name[] {
  const shown = plotted(known, added);
  return (Object.keys(QUANTITIES) as Name[]).filter((name) => name !== 'time' && name in known && !shown.includes(name));
}

/** The axes of the plot of a quantity. Against itself a quantity says nothing: then it is against time. */
export function axesOf(y: Name, layout: Layout): Axes {
  const x = layout === 'thesis' ? 'altitude' : layout;
  return { x: x === y ? 'time' : x, y };
}

/** A curve in the units in which it is shown. */
export interface Curve {
  x: number[];
  y: number[];
}

/** The curve of a flight. */
export function curveOf(flight: Flight, axes: Axes, unit: AngleUnit): Curve {
  return { x: scaled(flight, axes.x, unit), y: scaled(flight, axes.y, unit) };
}

function scaled(flight: Flight, name: Name, unit: AngleUnit): number[] {
  const scale = scaleOf(name, unit);
  return (flight.columns[name] ?? []).map((value) => value * scale);
}

/** Flights across each band of a corridor, which is told by altitude and speed: nothing on other axes. */
export function bandsOf(bands: Flight[][], axes: Axes, unit: AngleUnit): Curve[][] {
  const isOfBoth = [axes.x, axes.y].every((name) => name === 'altitude' || name === 'speed');
  return isOfBoth ? bands.map((band) => band.map((flight) => curveOf(flight, axes, unit))) : [];
}

/** What the columns of a theory are called in a flight. */
const PREDICTED = {
  time: 'time',
  altitude: 'altitude',
  speed: 'speed',
  flight_path_angle: 'flight_path_angle',
  deceleration: 'drag_deceleration',
} as const;

/** The curve of a theory, with gaps (NaN) where it gives no number; null where it has no such quantities. */
export function predictedOf(theory: Theory, axes: Axes, unit: AngleUnit): Curve | null {
  const column = (name: Name): number[] | null => {
    if (!(name in PREDICTED)) return null;
    const values = theory.predicted[PREDICTED[name as keyof typeof PREDICTED]];
    const perDegree = QUANTITIES[name].angle && theory.angle_unit === 'rad' ? 180 / Math.PI : 1;
    return values.map((value) => (value === null ? Number.NaN : value * perDegree * scaleOf(name, unit)));
  };
  const [x, y] = [column(axes.x), column(axes.y)];
  return x && y ? { x, y } : null;
}

/** The least and the greatest number of several lists, a little widened; what has no extent gets one. */
export function rangeOf(lists: number[][]): [number, number] {
  let [low, high] = [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY];
  for (const list of lists)
    for (const value of list) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
  if (low > high) return [0, 1];
  const margin = high > low ? 0.04 * (high - low) : Math.abs(high) * 0.01 || 1;
  return [low - margin, high + margin];
}

/** Where a curve goes on from one point to the next: not over a gap, and not where an angle begins anew. */
export function isJoined(before: number, after: number, name: Name, unit: AngleUnit): boolean {
  const half = QUANTITIES[name].angle ? 180 * scaleOf(name, unit) : Number.POSITIVE_INFINITY;
  return Math.abs(after - before) < half;
}

/** The index of the point that is nearest on the screen; -1 where there is none. */
export function nearest(points: { length: number; at(index: number): [number, number] }, x: number, y: number): number {
  let [best, least] = [-1, Number.POSITIVE_INFINITY];
  for (let index = 0; index < points.length; index += 1) {
    const [px, py] = points.at(index);
    const distance = (px - x) ** 2 + (py - y) ** 2;
    if (distance < least) [best, least] = [index, distance];
  }
  return best;
}

/** A quantity of a flight at an instant, in the unit in which it is shown. */
export function valueAt(run: Run, name: Name, time: number, unit: AngleUnit): number {
  return at(run.flight, name, time) * scaleOf(name, unit);
}

/** The title of an axis. */
export function titleOf(name: Name, unit: AngleUnit): string {
  const shown = unitOf(name, unit);
  return shown ? `${QUANTITIES[name].label}, ${shown}` : QUANTITIES[name].label;
}

/** So many rows of a flight, evenly picked, the first and the last among them. */
export function picked(rows: number, wanted: number): number[] {
  if (rows <= wanted) return Array.from({ length: rows }, (_, index) => index);
  return Array.from({ length: wanted }, (_, index) => Math.round((index * (rows - 1)) / (wanted - 1)));
}
