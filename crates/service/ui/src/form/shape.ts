import { get, type Path, pointer, withList } from '../case';
import { type Field, type Fields, kindOf, SCHEDULE, SECTIONS, SINCE, SUTTON_GRAVES, THRUST } from './fields';

/** The bytes that a case may have: the service takes no longer body, unless its settings say so. */
export const LONGEST = 1 << 20;
/** How many objects and arrays may lie within each other; the forms go down seven. */
const DEEPEST = 32;
/** Of so many faults each is told. */
const TOLD = 3;

/**
 * What keeps a value that comes from outside from being a case that the forms can show; null where nothing does. They ask that objects,
 * arrays and single values stand where they read such. Whether the case can be flown the service says.
 */
export function whyNoCase(value: unknown): string | null {
  if (!isObject(value)) return 'it is not a JSON object';
  const missing = ['vehicle', 'initial_state'].filter((name) => !isObject(get(value, [name])));
  if (missing.length > 0) return `${missing.join(' and ')} ${missing.length > 1 ? 'are' : 'is'} missing`;
  if (isDeeper(value, DEEPEST)) return `it is nested more than ${DEEPEST} levels deep`;
  if (new TextEncoder().encode(JSON.stringify(value)).length > LONGEST) return TOO_LONG;
  const faults = ofObject(withList(value), ASKED, []);
  const others = faults.length > TOLD ? `, and ${faults.length - TOLD} more` : '';
  return faults.length > 0 ? faults.slice(0, TOLD).join(', ') + others : null;
}

/** Said of a case that has more bytes than it may have. */
export const TOO_LONG = 'it exceeds 1 MiB';

const SINGLE: Field = { kind: 'text', label: '' };
const ROW: Field = { kind: 'column', label: '', table: '' };
const OBJECT: Field = { kind: 'group', label: '', schema: '', fields: {} };
const COUPLED: Field = { kind: 'group', label: '', schema: '', fields: { pointer: SINGLE, factor: SINGLE } };
const FREE: Fields = { pointer: SINGLE, between: ROW, scale: SINGLE, also: listOf(COUPLED) };
const ASKED: Fields = {
  ...SECTIONS,
  solution: SINGLE,
  vary: listOf({ kind: 'group', label: '', schema: '', fields: FREE }),
  achieve: listOf(OBJECT),
  limits: listOf(OBJECT),
  sliders: ROW,
  footprint: { kind: 'flag', label: '', orObject: true },
};
const INERTIAL: Fields = { direction: ROW };

function listOf(item: Field): Field {
  return { kind: 'list', label: '', one: '', empty: {}, item };
}

function isObject(value: unknown): boolean {
  return typeof value === 'object' && value !== null && !Array.isArray(value);
}

function isDeeper(value: unknown, levels: number): boolean {
  if (typeof value !== 'object' || value === null) return false;
  return levels === 0 || Object.values(value).some((inner) => isDeeper(inner, levels - 1));
}

/** What is wrong with the shape of a value for a field; nothing where there is none. */
function faultsOf(value: unknown, field: Field, path: Path): string[] {
  if (value === undefined) return [];
  const isSingle = typeof value !== 'object' || value === null;
  // The forms do not look inside.
  if (field.kind === 'json' || (field.kind === 'flag' && field.orObject && isObject(value))) return [];
  switch (field.kind) {
    case 'group':
      return ofObject(value, field.fields, path);
    case 'variant':
      return ofObject(value, { type: SINGLE, ...kindOf(field.kinds, get(value, ['type']))?.fields }, path);
    case 'list':
    case 'parts':
      return ofArray(value, field.item, path);
    case 'matrix':
      return ofArray(value, ROW, path);
    case 'vector':
    case 'column':
    case 'several':
    case 'names':
      return ofArray(value, SINGLE, path);
    case 'numbers':
      return isSingle ? ofSingle(value, path) : ofArray(value, SINGLE, path);
    case 'command':
      return isSingle ? ofSingle(value, path) : ofObject(value, SCHEDULE.fields, path);
    case 'convective':
      return isSingle ? ofSingle(value, path) : ofObject(value, SUTTON_GRAVES, path);
    case 'thrust':
      return isSingle ? ofSingle(value, path) : ofObject(value, THRUST, path);
    case 'variable':
      return isSingle ? ofSingle(value, path) : ofObject(value, SINCE, path);
    case 'along':
      return isSingle ? ofSingle(value, path) : ofObject(value, INERTIAL, path);
    default:
      return ofSingle(value, path);
  }
}

function ofObject(value: unknown, fields: Fields, path: Path): string[] {
  if (!isObject(value)) return [fault(path, 'an object', value)];
  return Object.entries(fields).flatMap(([name, field]) => faultsOf(get(value, [name]), field, [...path, name]));
}

function ofArray(value: unknown, item: Field, path: Path): string[] {
  if (!Array.isArray(value)) return [fault(path, 'an array', value)];
  return value.flatMap((inner, index) => faultsOf(inner, item, [...path, index]));
}

function ofSingle(value: unknown, path: Path): string[] {
  if (typeof value === 'number' && !Number.isFinite(value)) return [`${pointer(path)} must be a finite number in double precision`];
  return typeof value === 'object' && value !== null ? [fault(path, 'a single value', value)] : [];
}

function fault(path: Path, wanted: string, value: unknown): string {
  const kind = Array.isArray(value) ? 'an array' : typeof value === 'object' ? 'an object' : `a ${typeof value}`;
  return `${pointer(path)} must be ${wanted}, got ${value === null ? 'null' : kind}`;
}
