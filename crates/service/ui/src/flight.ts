import type { Answer, Case, Schemas } from './api';
import { type Name, QUANTITIES } from './quantities';

/** The numbers of a row, in SI, angles in degrees. */
export type Numbers = Partial<Record<Name, number>>;

/** The columns of a trajectory, in SI, angles in degrees. */
export type Trajectory = Partial<Record<Name, number[]>> & { time: number[] };

/** Something at an instant of a flight: its end, a peak, an event. */
export interface Mark {
  kind: 'start' | 'event' | 'peak' | 'end';
  /** What a person calls it. */
  label: string;
  /** s. */
  time: number;
}

/** A flight as the page holds it: angles in degrees, whatever the case has. */
export interface Flight {
  answer: Answer;
  columns: Trajectory;
  initial: Numbers;
  final: Numbers;
  marks: Mark[];
  /** What left the vehicle, or a body that did. */
  bodies: Body[];
}

/** A body that left the vehicle, and its flight, on the clock of the case. */
export interface Body {
  name: string;
  /** The body that it left; null where it left the vehicle. */
  parent: string | null;
  /** The event that separated it. */
  separatedBy: string;
  /** s. */
  separatedAt: number;
  flight: Flight;
}

/** A flight beside others. */
export interface Run {
  /** 0 of the current flight, above it of a pinned one, below it of a body that left the current one. */
  id: number;
  /** What it is called where several are shown. */
  label: string;
  /** Its colour, `--run-0` to `--run-6` in the style sheet; the current run has 0. */
  colour: number;
  case: Case;
  flight: Flight;
}

const DEGREES = 180 / Math.PI;

const PEAKS: Partial<Record<keyof Answer['peaks'], string>> = {
  load_factor: 'peak load factor',
  dynamic_pressure: 'peak dynamic pressure',
  heat_flux: 'peak heat flux',
  altitude: 'maximum altitude',
};

const ENDS: Record<Answer['termination'], string> = {
  stop_altitude: 'stopped',
  surface_impact: 'impact',
  time_limit: 'time limit',
  condition: 'stop condition',
  atmosphere_exit: 'atmosphere exit',
};

/** The flight of an answer with a trajectory. */
export function flightOf(answer: Answer): Flight {
  const factor = (name: Name) => (QUANTITIES[name].angle && answer.angle_unit === 'rad' ? DEGREES : 1);
  const numbers = (row: object): Numbers =>
    Object.fromEntries(
      Object.entries(row)
        .filter(([name, value]) => name in QUANTITIES && typeof value === 'number')
        .map(([name, value]) => [name, value * factor(name as Name)]),
    );
  const columnOf = (values: (number | null)[], scale: number) => values.map((value) => (value === null ? Number.NaN : value * scale));
  const columns = Object.fromEntries(
    Object.entries(answer.trajectory ?? {})
      .filter(([name]) => name in QUANTITIES)
      .map(([name, values]) => [name, columnOf(values as (number | null)[], factor(name as Name))]),
  ) as Trajectory;
  return {
    answer,
    columns,
    initial: numbers(answer.initial_state),
    final: numbers(answer.final_state),
    marks: marksOf(answer),
    bodies: (answer.bodies ?? []).map((body) => bodyOf(answer, body)),
  };
}

/** A body of an answer: its flight is one like that of the vehicle, with the same models. */
function bodyOf({ bodies: _, ...answer }: Answer, body: Schemas['BodyReport']): Body {
  const { name, parent, separated_by: by, separated_at: separatedAt, solver, ...flight } = body;
  const { events: __, phases: ___, trajectory: ____, condition: _____, ...shared } = answer;
  return {
    name,
    parent: parent ?? null,
    separatedBy: typeof by === 'number' ? `event ${by + 1}` : by,
    separatedAt,
    flight: flightOf({ ...shared, ...flight, solver: { ...answer.solver, ...solver } }),
  };
}

/** The colours of runs that are not the current one. */
export const COLOURS = 6;

/** A flight and the bodies that left it, each with a colour; there may be more of them than colours. */
export function withBodies(run: Run): Run[] {
  const bodies = run.flight.bodies.map(({ name, flight }, index) => ({
    ...run,
    id: -1 - index,
    label: name,
    colour: 1 + (index % COLOURS),
    flight,
  }));
  return [run, ...bodies];
}

/** Whether a flight begins on the ground, or loses bodies: it passes the same altitude more than once. */
export function isLaunched({ case: tree, flight }: Run): boolean {
  return tree.initial_state.type === 'launch' || flight.bodies.length > 0;
}

/** Whether a flight is under way at an instant: a body is not before its separation. */
export function isFlying(flight: Flight, time: number): boolean {
  return time >= (flight.initial.time ?? 0) && time <= (flight.final.time ?? 0);
}

/** How a flight ended, in a few words. */
export function endOf({ termination, final_state }: Answer): string {
  if (termination !== 'stop_altitude') return ENDS[termination];
  return `${ENDS.stop_altitude} at ${Number((final_state.altitude / 1e3).toPrecision(4))} km`;
}

function marksOf(answer: Answer): Mark[] {
  const { initial_state, final_state, peaks, events } = answer;
  const marks: Mark[] = [{ kind: 'start', label: 'start', time: initial_state.time }];
  for (const event of events ?? []) marks.push({ kind: 'event', label: event.name ?? `event ${event.index + 1}`, time: event.time });
  for (const [name, label] of Object.entries(PEAKS)) {
    const peak = peaks[name as keyof typeof peaks];
    // A peak at an end of the flight is the end.
    if (peak && peak.time > initial_state.time && peak.time < final_state.time) marks.push({ kind: 'peak', label, time: peak.time });
  }
  marks.push({ kind: 'end', label: endOf(answer), time: final_state.time });
  return marks;
}

/** The greatest index whose value is at most a given one, of an ascending list; 0 where none is. */
export function indexBefore(ascending: number[], value: number): number {
  let low = 0;
  let high = ascending.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((ascending[middle] as number) <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** A column at an instant, in a straight line between its rows (for an angle that wraps by the shorter way); NaN where there is none. */
export function at(flight: Flight, name: Name, time: number): number {
  const { time: times } = flight.columns;
  const values = flight.columns[name];
  if (!values?.length) return Number.NaN;
  const before = indexBefore(times, time);
  const after = Math.min(before + 1, times.length - 1);
  const [t0, t1, v0, v1] = [times[before], times[after], values[before], values[after]] as [number, number, number, number];
  const part = t1 > t0 ? Math.min(Math.max((time - t0) / (t1 - t0), 0), 1) : 0;
  const step = QUANTITIES[name].angle ? wrapped(v1 - v0) : v1 - v0;
  return v0 + part * step;
}

/** An angle, degrees, within half a turn. */
export function wrapped(angle: number): number {
  return angle - 360 * Math.round(angle / 360);
}
