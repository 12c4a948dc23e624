import type { Case, Goal, Limit, Target } from '../api';
import { get, pathOf, turned } from '../case';
import { kilometres, number } from '../figures';
import { at, type Flight, wrapped } from '../flight';
import { type CaseNumber, numberAt } from '../numbers';
import { type AngleUnit, type Name, QUANTITIES, scaleOf, unitOf } from '../quantities';
import { missesOf } from './request';

type Nearest = NonNullable<Target['nearest']>;

/** What a sentence about a search is made of. */
export interface Searched {
  /** The case with its goals, as it was sent. */
  asked: Case;
  answer: Target;
  /** The unit in which the reader reads angles. */
  reader: AngleUnit;
  /** The azimuth in which the nearest flight arrives, degrees clockwise from north; null where it is not known. */
  course: number | null;
}

/** What a search has found, in a sentence; where it has found nothing, why. */
export function outcomeInWords(searched: Searched): string {
  const { outcome, solutions, complete, nearest } = searched.answer;
  if (solutions.length > 0) {
    const count = solutions.length === 1 ? '1 solution' : `${solutions.length} solutions`;
    if (complete) return `${count}, and no others within the bounds`;
    return outcome === 'out_of_budget' ? `${count} before the search ran out of time` : count;
  }
  if (outcome === 'out_of_budget' && !nearest) return 'not found in time';
  if (!nearest) return `cannot reach: ${noneEnds(searched.answer)}`;
  const head = outcome === 'out_of_budget' ? 'not found in time: nearest so far' : 'cannot reach:';
  const because = reasons(searched, nearest);
  return [`${head} ${missed(searched, nearest).join(', ')}`, ...because].join(', ');
}

/** How flights end, in the plural. */
const ENDS: Record<string, string> = {
  surface_impact: 'reach the surface',
  stop_altitude: 'reach the stop altitude',
  time_limit: 'run into the time limit',
  condition: 'meet a stop condition',
  atmosphere_exit: 'leave the atmosphere',
};

function noneEnds({ search: { classes } }: Target): string {
  if (classes.length === 0) return 'no flight can be computed';
  return `no flight ends as it should, they ${endsInWords(classes)}`;
}

/** How flights end, after `they`. */
export function endsInWords(classes: string[]): string {
  return classes.map((end) => ENDS[end] ?? end).join(' or ');
}

/** What is missed, each in a few words. */
function missed({ asked, reader, answer, course }: Searched, { misses }: Nearest): string[] {
  let at = 0;
  const told = (asked.achieve ?? []).flatMap((goal) => {
    const own = misses.slice(at, at + missesOf(goal));
    at += own.length;
    return missInWords(goal, own, { reader, own: answer.angle_unit, course }) ?? [];
  });
  return told.length > 0 ? told : ['near every goal, outside the tolerance of one'];
}

interface Units {
  reader: AngleUnit;
  own: AngleUnit;
  course: number | null;
}

/** By how much a goal is missed; null where it is met. */
function missInWords(goal: Goal, misses: (number | null)[], { reader, own, course }: Units): string | null {
  const [first, second] = misses;
  if (first === undefined) return null;
  if ('site' in goal) {
    const { body } = goal as { body?: string };
    const subject = body === undefined ? '' : `${body} `;
    if (typeof first !== 'number' || second === null) return body === undefined ? 'no landing' : `no landing of ${body}`;
    if (second === undefined) return first > 0 ? `${subject}${distance(first)} too far from the place` : null;
    return Math.hypot(first, second) > (goal.tolerance ?? SMALL * RADIUS) ? `${subject}${offset(first, second, course)}` : null;
  }
  if (!('quantity' in goal)) return null;
  const name = goal.quantity as Name;
  const what = goalInWords(goal);
  if (first === null) return `no flight has a ${what}`;
  if (Math.abs(first) <= (goal.tolerance ?? SMALL * sizeOf(goal, own))) return null;
  const angular = QUANTITIES[name].angle ? (turned(first, own, 'deg') as number) : first;
  const unit = unitOf(name, reader);
  const amount = number(Math.abs(angular) * scaleOf(name, reader), 3);
  return `${what} ${amount}${unit === '' || unit === '°' ? unit : ` ${unit}`} too ${first > 0 ? 'high' : 'low'}`;
}

/** A tolerance that is not given, in parts of the size of a quantity, and sizes on the Earth, m and m/s. */
const SMALL = 1e-6;
const RADIUS = 6.4e6;
const SPEED = 7.9e3;

/** The size of a quantity, of which the default tolerance is a part. */
function sizeOf(goal: Goal, own: AngleUnit): number {
  const { unit, angle, scale } = QUANTITIES[goal.quantity as Name];
  if (angle) return own === 'deg' ? 180 / Math.PI : 1;
  if (unit === 'km') return RADIUS;
  if (unit === 'm/s') return SPEED;
  if (unit === 's') return RADIUS / SPEED;
  const values = ['equals', 'at_least', 'at_most', 'between'].flatMap((key) => (goal as Record<string, unknown>)[key] ?? []);
  return Math.max(...values.map((value) => Math.abs(Number(value))), scale > 0 ? 0 : 1);
}

const MOMENTS: Record<string, string> = { start: 'at the start', end: 'at the end' };

/** A goal on a quantity, without its value: `peak load factor`, `speed of first stage at the end`. */
export function goalInWords({ quantity = '', at = 'end', body }: { quantity?: string; at?: unknown; body?: string }): string {
  const ofVehicle = (QUANTITIES[quantity as Name]?.label ?? quantity).toLowerCase();
  const label = body === undefined ? ofVehicle : `${ofVehicle} of ${body}`;
  if (at === 'peak') return `peak ${label}`;
  if (at === 'lowest') return `lowest ${label}`;
  if (typeof at === 'string') return `${label} ${Object.hasOwn(MOMENTS, at) ? MOMENTS[at] : at}`;
  const { event, side = 'before' } = (at ?? {}) as { event?: string; side?: string };
  return `${label} ${side} ${event}`;
}

/** A limit of a corridor: `peak load factor at most 10 g, with bank angle at 0°`. */
export function limitInWords(asked: Case, limit: Limit, reader: AngleUnit): string {
  const own = asked.angle_unit ?? 'rad';
  const {
    quantity,
    at: moment,
    site,
    within,
    termination,
    at_least,
    at_most,
    between,
    body,
    with: others = {},
  } = limit as Record<string, unknown>;
  const flown = Object.entries(others ?? {}).map(([pointer, value]) => {
    const number = numberAt(asked, pathOf(asked, pointer));
    return `${number.label.toLowerCase()} at ${valueInWords(number, Number(value), own, reader)}`;
  });
  const value = (of: unknown) => {
    const name = quantity as Name;
    const angular = QUANTITIES[name]?.angle ? (turned(Number(of), own, 'deg') as number) : Number(of);
    return number(angular * (QUANTITIES[name] ? scaleOf(name, reader) : 1), 6);
  };
  const unit = QUANTITIES[quantity as Name] ? unitOf(quantity as Name, reader) : '';
  const [least, greatest] = (Array.isArray(between) ? between : [at_least, at_most]) as unknown[];
  const range = [least === undefined ? [] : [`at least ${value(least)}`], greatest === undefined ? [] : [`at most ${value(greatest)}`]];
  const whose = typeof body === 'string' ? { body } : {};
  const subject = typeof body === 'string' ? `${body} ` : '';
  const what =
    termination !== undefined
      ? `${subject}ends with ${[termination].flat().join(' or ').replaceAll('_', ' ')}`
      : site !== undefined
        ? `${subject}lands within ${distance(Number(within))} of the place`
        : `${goalInWords({ quantity: String(quantity), ...whose, ...(moment === undefined ? {} : { at: moment }) })} ${range.flat().join(' and ')} ${unit}`.trim();
  return flown.length > 0 ? `${what}, with ${flown.join(', ')}` : what;
}

const distance = (metres: number) => (metres < 1000 ? `${number(metres, 3)} m` : `${kilometres(metres, 3)} km`);

/** A part of an offset below this share of the other is not worth a word. */
const SHARE = 0.1;

/** An end east and north of the place, along the course and across it. */
function offset(east: number, north: number, course: number | null): string {
  const total = Math.hypot(east, north);
  if (course === null) return `${distance(total)} off`;
  const angle = (wrapped((Math.atan2(east, north) * 180) / Math.PI - course) * Math.PI) / 180;
  const [along, across] = [total * Math.cos(angle), total * Math.sin(angle)];
  const told = [
    { size: Math.abs(along), text: `${distance(Math.abs(along))} ${along < 0 ? 'short' : 'long'}` },
    { size: Math.abs(across), text: `${distance(Math.abs(across))} to the ${across < 0 ? 'left' : 'right'}` },
  ].filter(({ size }) => size >= SHARE * total);
  return told.map(({ text }) => text).join(' and ');
}

/** Why nothing comes nearer. */
function reasons({ asked, answer, reader }: Searched, { at_bounds, edge, insensitive, stationary, values }: Nearest): string[] {
  const bounds = at_bounds.map(({ vary }) => {
    const varied = variedNumbers(asked)[vary];
    return varied ? `${varied.label.toLowerCase()} at ${valueInWords(varied, values[vary] ?? Number.NaN, answer.angle_unit, reader)}` : '';
  });
  const fixed = insensitive.flatMap((index) => {
    const goal = asked.achieve?.[index];
    if (!goal || 'termination' in goal) return [];
    return [`no free number changes the ${'quantity' in goal ? goalInWords(goal) : 'place of landing'}`];
  });
  const beyond = edge ? [`beyond it flights ${edge.beyond ? (ENDS[edge.beyond] ?? edge.beyond) : 'fail'}`] : [];
  const told = [...(bounds.length > 0 ? [`bound by ${bounds.join(' and ')}`] : []), ...fixed, ...beyond];
  return told.length > 0 || !stationary ? told : ['no small change of the free numbers comes nearer'];
}

/** The free numbers of a case, in the order of the values of a solution; of a list one each. */
export function variedNumbers(asked: Case): CaseNumber[] {
  return (asked.vary ?? []).flatMap(({ pointer }) => {
    const path = pathOf(asked, pointer);
    const own = get(asked, path);
    const paths = Array.isArray(own) ? own.map((_, index) => [...path, index]) : [path];
    return paths.map((one) => numberAt(asked, one));
  });
}

/** A value of a number, with its unit, as the reader reads it. */
export function valueInWords({ isAngle, unit }: CaseNumber, value: number, own: AngleUnit, reader: AngleUnit): string {
  if (!isAngle) return unit === '' ? number(value, 6) : `${number(value, 6)} ${unit}`;
  const shown = number(turned(value, own, reader) as number, 6);
  return reader === 'deg' ? `${shown}°` : `${shown} rad`;
}

/** The azimuth in which a flight arrives, degrees clockwise from north: from where it is slowed most to its end; of one that comes straight down none. */
export function courseOf(flight: Flight): number | null {
  const end = flight.final.time ?? 0;
  const from = flight.answer.peaks.load_factor.time;
  const [[lon0, lat0], [lon1, lat1]] = [from, end].map((time) => [
    at(flight, 'longitude', time),
    at(flight, 'geodetic_latitude', time),
  ]) as [[number, number], [number, number]];
  const rad = Math.PI / 180;
  const east = Math.sin((lon1 - lon0) * rad) * Math.cos(lat1 * rad);
  const north = Math.cos(lat0 * rad) * Math.sin(lat1 * rad) - Math.sin(lat0 * rad) * Math.cos(lat1 * rad) * Math.cos((lon1 - lon0) * rad);
  if (Math.hypot(east, north) > 1e-5) return (Math.atan2(east, north) / rad + 360) % 360;
  return null;
}
