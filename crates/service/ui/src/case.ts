import schema from 'virtual:schema';
import type { Case } from './api';
import { type AngleUnit, type Name, QUANTITIES } from './quantities';

/** Where in a case: names of fields, and places in lists. */
export type Path = readonly (string | number)[];

/** The path of a JSON pointer; what is a place in a list is known by the tree. */
export function pathOf(tree: unknown, at: string): Path {
  const parts = String(at)
    .split('/')
    .slice(1)
    .map((part) => part.replaceAll('~1', '/').replaceAll('~0', '~'));
  const path: (string | number)[] = [];
  for (const part of parts) path.push(Array.isArray(get(tree, path)) && /^\d+$/.test(part) ? Number(part) : part);
  return path;
}

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

/** A case without what is asked of it: what `/simulate` takes. */
export function alone({ vary: _, achieve: __, limits: ___, sliders: ____, footprint: _____, ...flight }: Case): Case {
  return flight;
}

/** A case of `/corridor` varies one number: here it is a list of one. */
export function withList<T>(tree: T): T {
  const vary = get(tree, ['vary']);
  return vary === undefined || Array.isArray(vary) ? tree : set(tree, ['vary'], [vary]);
}

/** A case of a search as the page has it: what is free as a list, and the options of a footprint by themselves. */
export function adopted<T extends Case>(tree: T): T {
  const { resolution, search, ...others } = withList(tree) as T & { resolution?: unknown; search?: unknown };
  const next = others as unknown as T;
  const isOfCorridor = !Array.isArray(tree.vary) || (tree.limits ?? []).some((limit) => get(limit, ['with']) !== undefined);
  const isAsking = [tree.limits, resolution, search].some((part) => part !== undefined);
  if (tree.footprint !== undefined || tree.vary === undefined || tree.achieve !== undefined || !isAsking) return next;
  if (isOfCorridor) return { ...next, footprint: false };
  const flights = get(search, ['flights']);
  const options = {
    ...(typeof resolution === 'number' ? { resolution } : {}),
    ...(typeof flights === 'number' ? { flights } : {}),
  };
  return { ...next, footprint: Object.keys(options).length > 0 ? options : true };
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

/** Whether the number of a pointer is an angle. */
export function isAngleAt(tree: unknown, at: string): boolean {
  const path = pathOf(tree, at);
  const name = path.at(-1);
  if (name === 'falls_through' || name === 'rises_through') return ANGLE_QUANTITIES.has(get(tree, [...path.slice(0, -1), 'quantity']));
  return path.some((part) => ANGLES.has(String(part))) && name !== 'at';
}

/** Whether a quantity of a condition or a column is an angle. */
function isAngleQuantity(quantity: unknown): boolean {
  return ANGLE_QUANTITIES.has(quantity) || (typeof quantity === 'string' && QUANTITIES[quantity as Name]?.angle === true);
}

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
  const ofQuantity = ['falls_through', 'rises_through', 'equals', 'at_least', 'at_most', 'between', 'tolerance'];
  const walk = (value: unknown): unknown => {
    if (Array.isArray(value)) return value.map(walk);
    if (typeof value !== 'object' || value === null) return value;
    const ofAngle =
      ('quantity' in value && isAngleQuantity(value.quantity)) ||
      ('pointer' in value && 'between' in value && isAngleAt(tree, String(value.pointer)));
    return Object.fromEntries(
      Object.entries(value).map(([name, inner]) => {
        if (ofAngle && ofQuantity.includes(name)) return [name, scale(inner)];
        if (!ANGLES.has(name)) return [name, walk(inner)];
        const isSchedule = typeof inner === 'object' && inner !== null && !Array.isArray(inner);
        return [name, isSchedule ? { ...inner, value: scale((inner as { value?: unknown }).value) } : scale(inner)];
      }),
    );
  };
  return { ...(walk(tree) as Case), angle_unit: unit };
}
