import schema from 'virtual:schema';
import type { Case } from './api';
import type { AngleUnit } from './quantities';

/** Where in a case: names of fields, and places in lists. */
export type Path = readonly (string | number)[];

/** The JSON pointer (RFC 6901) of a path, by which the service names a field. */
export function pointer(path: Path): string {
  return path.map((part) => `/${String(part).replaceAll('~', '~0').replaceAll('/', '~1')}`).join('');
}

/** What is at a path; undefined where there is nothing. What objects have by nature, such as `at` of lists, is not in them. */
export function get(tree: unknown, path: Path): unknown {
  return path.reduce<unknown>(
    (at, part) =>
      typeof at === 'object' && at !== null && Object.hasOwn(at, part) ? (at as Record<string | number, unknown>)[part] : undefined,
    tree,
  );
}

/** A tree with something else at a path; undefined takes it away. Parts that are not on the way are shared, none is changed. */
export function set<T>(tree: T, path: Path, value: unknown): T {
  const [part, ...rest] = path;
  if (part === undefined) return value as T;
  const inner = set(get(tree, [part]) ?? (typeof rest[0] === 'number' ? [] : {}), rest, value);
  if (Array.isArray(tree)) {
    const copy = [...tree];
    if (inner === undefined) copy.splice(Number(part), 1);
    else copy[Number(part)] = inner;
    return copy as T;
  }
  // Written so, a part that is called `__proto__` is one like others.
  const { [part]: _, ...others } = tree as Record<string | number, unknown>;
  return (inner === undefined ? others : { ...tree, [part]: inner }) as T;
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

/** The names of fields that are angles; the values of a schedule are told by what they stand in. */
const ANGLES = new Set(
  Object.values(schema).flatMap(({ properties = {} }) =>
    Object.keys(properties).filter((name) => properties[name]?.['x-unit'] === 'angle' && name !== 'value'),
  ),
);

/** The quantities of conditions that are angles. */
export const ANGLE_QUANTITIES: ReadonlySet<unknown> = new Set(
  Object.entries(schema.Quantity?.['x-units'] ?? {}).flatMap(([quantity, unit]) => (unit === 'angle' ? [quantity] : [])),
);

/** An angle in another unit; what is no number stays as it is. */
export function turned(value: unknown, from: AngleUnit, to: AngleUnit): unknown {
  if (from === to || typeof value !== 'number') return value;
  return to === 'deg' ? (value * 180) / Math.PI : (value * Math.PI) / 180;
}

/** An angle in another unit as one reads it: to 14 digits, so that 60° there and back is 60 and not 59.99999999999999. */
export function legible(value: unknown, from: AngleUnit, to: AngleUnit): unknown {
  if (from === to || typeof value !== 'number') return value;
  return Number((turned(value, from, to) as number).toPrecision(14));
}

/** A case with its angles in another unit: the same flight. Degrees are rounded to what one reads, radians not. */
export function inUnit(tree: Case, unit: AngleUnit): Case {
  const from = tree.angle_unit ?? 'rad';
  if (from === unit) return tree;
  const scale = (value: unknown): unknown => {
    if (Array.isArray(value)) return value.map(scale);
    return unit === 'deg' ? legible(value, from, unit) : turned(value, from, unit);
  };
  const walk = (value: unknown): unknown => {
    if (Array.isArray(value)) return value.map(walk);
    if (typeof value !== 'object' || value === null) return value;
    const ofAngle = 'quantity' in value && ANGLE_QUANTITIES.has(value.quantity);
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
