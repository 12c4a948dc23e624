import type { Case } from './api';
import type { AngleUnit } from './quantities';

/** Where in a case: names of fields, and places in lists. */
export type Path = readonly (string | number)[];

/** The JSON pointer (RFC 6901) of a path, by which the service names a field. */
export function pointer(path: Path): string {
  return path.map((part) => `/${String(part).replaceAll('~', '~0').replaceAll('/', '~1')}`).join('');
}

/** What is at a path; undefined where there is nothing. */
export function get(tree: unknown, path: Path): unknown {
  return path.reduce<unknown>((at, part) => (at as Record<string | number, unknown> | null | undefined)?.[part], tree);
}

/** A tree with something else at a path; undefined takes it away. Parts that are not on the way are shared, none is changed. */
export function set<T>(tree: T, path: Path, value: unknown): T {
  const [part, ...rest] = path;
  if (part === undefined) return value as T;
  const copy = (Array.isArray(tree) ? [...tree] : { ...tree }) as Record<string | number, unknown>;
  const inner = set(copy[part] ?? (typeof rest[0] === 'number' ? [] : {}), rest, value);
  if (inner !== undefined) copy[part] = inner;
  else if (Array.isArray(copy)) copy.splice(Number(part), 1);
  else delete copy[part];
  return copy as T;
}

/** A case without the optional parts in which nothing is left. */
export function tidied(tree: Case): Case {
  const needed = ['vehicle', 'initial_state', 'heating'];
  const isEmpty = (part: unknown) => typeof part === 'object' && part !== null && Object.keys(part).length === 0;
  return Object.fromEntries(Object.entries(tree).filter(([name, part]) => needed.includes(name) || !isEmpty(part))) as Case;
}

/** What was typed: a number, nothing, or the text itself, of which the service then says what is wrong. */
export function typed(text: string): number | string | undefined {
  const trimmed = text.trim();
  if (trimmed === '') return undefined;
  const value = Number(trimmed);
  return Number.isFinite(value) && !/^[+-]?0[xob]/i.test(trimmed) ? value : trimmed;
}

const ANGLES = new Set([
  'longitude',
  'geocentric_latitude',
  'geodetic_latitude',
  'flight_path_angle',
  'heading',
  'azimuth',
  'inertial_flight_path_angle',
  'inertial_heading',
  'inertial_azimuth',
  'inclination',
  'raan',
  'argument_of_periapsis',
  'true_anomaly',
  'mean_anomaly',
  'sidereal_angle',
  'bank_angle',
  'angle_of_attack',
]);

/** A case with its angles in another unit: the same flight. */
export function inUnit(tree: Case, unit: AngleUnit): Case {
  if ((tree.angle_unit ?? 'rad') === unit) return tree;
  const scale = (value: unknown): unknown => {
    if (Array.isArray(value)) return value.map(scale);
    return typeof value === 'number' ? rounded(unit === 'deg' ? (value * 180) / Math.PI : (value * Math.PI) / 180) : value;
  };
  const walk = (value: unknown): unknown => {
    if (Array.isArray(value)) return value.map(walk);
    if (typeof value !== 'object' || value === null) return value;
    const ofAngle = 'quantity' in value && (value.quantity === 'flight_path_angle' || value.quantity === 'inclination');
    return Object.fromEntries(
      Object.entries(value).map(([name, inner]) => {
        if (ofAngle && (name === 'falls_through' || name === 'rises_through')) return [name, scale(inner)];
        if (!ANGLES.has(name)) return [name, walk(inner)];
        const isSchedule = typeof inner === 'object' && inner !== null && !Array.isArray(inner);
        return [name, isSchedule ? { ...inner, value: scale((inner as { value?: unknown }).value) } : scale(inner)];
      }),
    );
  };
  return { ...(walk(tree) as Case), angle_unit: unit };
}

/** To 15 digits, so that 30° there and back is 30° and not 29.999999999999996°. */
function rounded(value: number): number {
  return Number(value.toPrecision(15));
}
