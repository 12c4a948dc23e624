import schema from 'virtual:schema';
import type { Case } from './api';
import { get, type Path, pointer } from './case';
import { capital } from './figures';
import { type Field, kindOf, SCHEDULE, SECTIONS, THRUST } from './form/fields';
import type { Property } from './form/schema';

/** A number of the case, as sliders and searches show it. */
export interface CaseNumber {
  label: string;
  path: Path;
  /** Of an angle, degrees. */
  unit: string;
  isAngle?: true;
  /** A range around a value in its unit, of an angle in degrees: where its slider goes, and in which it is free. */
  range(value: number): [number, number];
  /** What holds where the case does not say. */
  without?: number;
}

const around = (share: number) => (value: number) => [value * (1 - share), value * (1 + share)] as [number, number];

/** The numbers that matter, of whichever the case has. */
const NUMBERS: CaseNumber[] = [
  ...['flight_path_angle', 'inertial_flight_path_angle'].map(
    (name): CaseNumber => ({
      label: 'Flight-path angle',
      path: ['initial_state', name],
      unit: '°',
      isAngle: true,
      range: (value) => [Math.max(value - 5, -90), Math.min(value + 5, 90)],
    }),
  ),
  ...['speed', 'inertial_speed'].map(
    (name): CaseNumber => ({ label: 'Speed', path: ['initial_state', name], unit: 'm/s', range: around(0.25) }),
  ),
  { label: 'Eccentricity', path: ['initial_state', 'eccentricity'], unit: '', range: (value) => [Math.max(value - 0.02, 0), value + 0.02] },
  { label: 'Bank angle', path: ['control', 'bank_angle'], unit: '°', isAngle: true, range: () => [-180, 180], without: 0 },
  { label: 'Mass', path: ['vehicle', 'mass'], unit: 'kg', range: (value) => [value / 2, value * 2] },
  { label: 'Air density', path: ['density_factor'], unit: '×', range: () => [0.5, 1.5], without: 1 },
];

const LAUNCH_AZIMUTH: CaseNumber = {
  label: 'Launch azimuth',
  path: ['initial_state', 'azimuth'],
  unit: '°',
  isAngle: true,
  range: (value) => [value - 45, value + 45],
  without: 0,
};

/** The numbers that matter in a case: of a launch its azimuth, and the angle of its first tilt, by which it begins to turn. */
export function numbersThatMatter(tree: Case): CaseNumber[] {
  return numbersOf(tree).filter(({ path, without }) => typeof (get(tree, path) ?? without) === 'number');
}

function numbersOf({ initial_state, events }: Case): CaseNumber[] {
  if (initial_state?.type !== 'launch') return NUMBERS;
  const tilt = Array.isArray(events) ? events.findIndex((event) => get(event, ['then', 'tilt', 'angle']) !== undefined) : -1;
  const tilts: CaseNumber = {
    label: 'Tilt',
    path: ['events', tilt, 'then', 'tilt', 'angle'],
    unit: '°',
    isAngle: true,
    range: (value) => [Math.max(value - 3, 0), value + 3],
  };
  return [LAUNCH_AZIMUTH, ...(tilt < 0 ? [] : [tilts]), ...NUMBERS];
}

/** The number at a path, whichever it is. */
export function numberAt(tree: Case, path: Path): CaseNumber {
  const known = numbersOf(tree).find((number) => pointer(number.path) === pointer(path));
  if (known) return known;
  const { field, property, within } = fieldAt(tree, path);
  const label = field?.label ?? pointer(path);
  const without = typeof property?.default === 'number' ? { without: property.default } : {};
  const called = within === undefined ? label : `${within}: ${label}`;
  if (field && 'isAngle' in field && field.isAngle)
    return {
      label: called,
      path,
      unit: '°',
      isAngle: true,
      range: angleRange(String(path.findLast((part) => typeof part === 'string'))),
      ...without,
    };
  const unit = field && 'unit' in field ? (field.unit ?? '') : '';
  return { label: called, path, unit, range: (value) => half(value, property), ...without };
}

/** A range around an angle of this name, degrees. */
function angleRange(name: string): (value: number) => [number, number] {
  const clipped = (width: number, least: number, greatest: number) => (value: number) =>
    [Math.max(value - width, least), Math.min(value + width, greatest)] as [number, number];
  if (name.endsWith('flight_path_angle')) return clipped(5, -90, 90);
  if (name.endsWith('latitude') || name === 'declination') return clipped(10, -90, 90);
  if (name === 'inclination') return clipped(10, 0, 180);
  if (name === 'bank_angle') return () => [-180, 180];
  return clipped(30, -360, 360);
}

/** Half as much again to either side, within what the field may be. */
function half(value: number, property: Property | undefined): [number, number] {
  const width = Math.abs(value) / 2 || 1;
  return [Math.max(value - width, property?.minimum ?? -Infinity), Math.min(value + width, property?.maximum ?? Infinity)];
}

interface Found {
  field?: Field | undefined;
  property?: Property | undefined;
  /** The element of a list in which it is, such as an event by its name. */
  within?: string | undefined;
}

/** The field at a path, as the forms show it. */
function fieldAt(tree: Case, path: Path): Found {
  let found: Found = {};
  path.forEach((part, index) => {
    const own = path.slice(0, index);
    found = index === 0 ? first(String(part)) : inner(tree, found, own, part);
  });
  return found;
}

function first(name: string): Found {
  return { field: Object.hasOwn(SECTIONS, name) ? SECTIONS[name as keyof Case] : undefined, property: propertyOf('SimulateRequest', name) };
}

function inner(tree: Case, { field, within }: Found, own: Path, part: string | number): Found {
  const member = (fields: Record<string, Field>, of: string): Found => {
    const name = String(part);
    const quantity = get(tree, [...own, 'quantity']);
    const isOfQuantity = (name === 'falls_through' || name === 'rises_through') && typeof quantity === 'string';
    const next = Object.hasOwn(fields, name) ? fields[name] : undefined;
    return { field: isOfQuantity ? ofQuantity(quantity) : next, property: propertyOf(of, name), within };
  };
  switch (field?.kind) {
    case 'group':
      return member(field.fields, field.schema);
    case 'variant': {
      const kind = kindOf(field.kinds, get(tree, [...own, 'type']));
      return kind ? member(kind.fields, kind.schema) : {};
    }
    case 'list':
    case 'parts': {
      const name = get(tree, [...own, part, 'name']);
      const one = field.kind === 'list' ? field.one : 'part';
      return { field: field.item, within: typeof name === 'string' && name !== '' ? name : `${capital(one)} ${Number(part) + 1}` };
    }
    case 'command': {
      const { field: of } = member(SCHEDULE.fields, SCHEDULE.schema);
      const isAngle = part === 'value';
      return { field: of && { kind: 'numbers', label: field.label, ...(isAngle ? { isAngle } : {}) }, within };
    }
    case 'thrust':
      return member(THRUST, 'Thrust');
    case 'vector':
      return { field: { kind: 'number', label: `${field.label} ${'xyz'[Number(part)]}`, unit: field.unit }, within };
    case 'column':
    case 'numbers':
      return { field: { ...field, label: `${field.label} ${Number(part) + 1}` }, within };
    default:
      return {};
  }
}

/** The number through which a quantity rises or falls. */
function ofQuantity(quantity: string): Field {
  const { 'x-titles': titles = {}, 'x-units': units = {} } = schema.Quantity ?? { alternatives: [] };
  // The word may be any text; objects have some by nature.
  const of = (words: Record<string, string>) => (Object.hasOwn(words, quantity) ? words[quantity] : undefined);
  const unit = of(units) ?? '';
  // A title ends with the unit.
  const label = (of(titles) ?? quantity).replace(/, [^,]+$/, '');
  return { kind: 'number', label, ...(unit === 'angle' ? { isAngle: true } : { unit }) };
}

function propertyOf(of: string, name: string): Property | undefined {
  const properties = schema[of]?.properties ?? {};
  return Object.hasOwn(properties, name) ? properties[name] : undefined;
}
