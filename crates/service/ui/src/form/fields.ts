import schema from 'virtual:schema';
import type { Case } from '../api';
import { nameOf, type Property, type Schema } from './schema';

/** A field of a form, or a group of them, as the OpenAPI document describes it. */
export type Field =
  /** A number; an angle has the unit of the case. Of fields with the same `choice`, exactly one is given. */
  | { kind: 'number'; label: string; unit?: string; isAngle?: true; choice?: string }
  | { kind: 'text'; label: string; hint?: string; choice?: string }
  /** True or false; with `orObject`, an object that is written as JSON counts as true. */
  | { kind: 'flag'; label: string; orObject?: true }
  /** Written as JSON alone. */
  | { kind: 'json'; label: string }
  /** The slug of a site, where the launch is not at a place. */
  | { kind: 'site'; label: string }
  /** The parts of a vehicle, in a table. */
  | { kind: 'parts'; label: string; item: Field; choice?: string }
  /** One of several words. */
  | { kind: 'words'; label: string; words: Record<string, string>; choice?: string }
  /** Three numbers. */
  | { kind: 'vector'; label: string; unit: string }
  /** Numbers, of which several fields of the same `table` have as many: edited side by side. */
  | { kind: 'column'; label: string; unit?: string; isAngle?: true; table: string; choice?: string }
  /** A list of numbers in a line; with `orOne`, a single one is a number. */
  | { kind: 'numbers'; label: string; unit?: string; isAngle?: true; choice?: string; orOne?: true }
  /** Rows of numbers. */
  | { kind: 'matrix'; label: string }
  /** Words of a list, each at most once. */
  | { kind: 'several'; label: string; words: readonly string[] }
  /** A number, or a schedule. */
  | { kind: 'command'; label: string }
  /** A direction: a word, or one in inertial space. */
  | { kind: 'along'; label: string; words: Record<string, string> }
  /** What a schedule runs along: a word, or the time since an event. */
  | { kind: 'variable'; label: string; words: Record<string, string> }
  /** Names in a line, apart by commas. */
  | { kind: 'names'; label: string; hint?: string }
  /** A correlation of the convective heat flux by its name, or with the constant of a gas. */
  | { kind: 'convective'; label: string }
  /** A thrust, or `"off"`. */
  | { kind: 'thrust'; label: string }
  | { kind: 'group'; label: string; schema: string; fields: Fields; isOptional?: string }
  /** One of several kinds, told by `type`; `none` is what it is called that there is none, where there may be none. */
  | { kind: 'variant'; label: string; kinds: Record<string, Kind>; none?: string }
  | { kind: 'list'; label: string; item: Field; one: string; empty: object; choice?: string };

export type Fields = Record<string, Field>;

export interface Kind {
  label: string;
  schema: string;
  fields: Fields;
}

/** The kind of a variant that a `type` tells; undefined where it is none, whatever a case has there. */
export function kindOf(kinds: Record<string, Kind>, type: unknown): Kind | undefined {
  return typeof type === 'string' && Object.hasOwn(kinds, type) ? kinds[type] : undefined;
}

/** The fields, kinds or words that come first in the form of a schema; the others follow in the order of the document. */
const FIRST: Record<string, string[]> = {
  Vehicle: ['mass', 'reference_area', 'nose_radius'],
  ConstantAerodynamics: ['drag_coefficient'],
  MachTable: ['mach', 'drag_coefficient'],
  AlphaMachTable: ['angle_of_attack', 'mach', 'drag_coefficient'],
  State: ['planet_relative', 'geodetic', 'inertial_flight_path'],
  PlanetRelative: ['altitude'],
  InertialFlightPath: [
    'altitude',
    'radius',
    'longitude',
    'geocentric_latitude',
    'inertial_speed',
    'inertial_flight_path_angle',
    'inertial_azimuth',
  ],
  LayeredAtmosphere: ['preset'],
  Shape: ['ellipsoid'],
  Axis: ['velocity', 'horizontal'],
};

/** The lists of a schema that are edited side by side. */
const TABLES: Record<string, string[]> = {
  TableAtmosphere: ['altitude', 'density', 'temperature', 'pressure'],
  TableWind: ['altitude', 'east', 'north', 'speed', 'from'],
  MachTable: ['mach', 'drag_coefficient', 'lift_coefficient'],
  Schedule: ['at', 'value'],
};

/** Fields that stand in lines of their own, though only one of them is given. */
const APART = [
  ['quantity', 'event'],
  ['site', 'geodetic_latitude'],
  ['east', 'speed'],
];

/** What an empty field shows. */
const HINTS: Record<string, string> = {
  'SimulateRequest.epoch': '2026-11-26T12:00:00Z',
  'Condition.event': 'event name',
  'Condition.burnout': 'part name',
  'Effect.release': 'parachute names',
  'Effect.ignite': 'part names',
  'Effect.shut_down': 'part names',
};

/** What the choice of a kind says where there is none. */
const NONE: Record<string, string> = {
  'SimulateRequest.atmosphere': 'Exponential (default)',
  'SimulateRequest.wind': 'No wind',
  'Planet.gravity': 'Inverse square (default)',
  'Control.steering': 'Along the velocity (default)',
  'Effect.aerodynamics': 'Unchanged',
  'Effect.steer': 'Unchanged',
};

/** What switches on a group that may be left out. */
const SWITCHES: Record<string, string> = {
  'SimulateRequest.heating': 'Compute heat fluxes (requires a nose radius)',
  'Effect.delta_v': 'Impulsive Δv',
  'Effect.deploy': 'Deploy a parachute',
  'Effect.tilt': 'Tilt the velocity',
};

/** What an element of a list is called, and what it begins with. */
const ELEMENTS: Record<string, { one: string; empty: object }> = {
  'LayeredAtmosphere.layers': { one: 'layer', empty: { base_altitude: 0, density: 1.225, scale_height: 7200 } },
  'SimulateRequest.events': { one: 'event', empty: { when: { quantity: 'altitude', falls_through: 10000 }, then: {} } },
  'Stop.when': { one: 'condition', empty: { quantity: 'load_factor', rises_through: 12 } },
};

/** What is written as JSON: it has a form of its own within, or names of the case. */
const AS_JSON = new Set(['SimulateRequest.dispersions', 'Effect.throttle', 'Effect.separate']);

/** A schema by its name. */
function named(name: string): Schema {
  return schema[name] ?? { alternatives: [] };
}

/** In the order of the page. */
function ordered(schemaName: string, names: string[]): string[] {
  const first = FIRST[schemaName] ?? [];
  return [...first, ...names.filter((name) => !first.includes(name))];
}

/** The words of a schema, each with its label. */
function wordsOf(name: string): Record<string, string> {
  const { enum: several, const: only, 'x-titles': titles = {} } = named(name);
  const words = several ?? (only === undefined ? [] : [only]);
  return Object.fromEntries(ordered(name, words).map((word) => [word, titles[word] ?? word]));
}

/** The fields of an object, but for its `type`. */
function fieldsOf(schemaName: string): Fields {
  const { properties = {}, alternatives } = named(schemaName);
  const choices = alternatives.filter((names) => !APART.some((apart) => apart.every((name) => names.includes(name))));
  const names = ordered(schemaName, Object.keys(properties)).filter((name) => name !== 'type');
  return Object.fromEntries(
    names.map((name) => {
      const choice = choices.find((names) => names.includes(name))?.join(' or ');
      const field = fieldOf(properties[name] as Property, schemaName, name);
      return [name, choice ? ({ ...field, choice } as Field) : field];
    }),
  );
}

function fieldOf(property: Property, schemaName: string, name: string): Field {
  const place = `${schemaName}.${name}`;
  const label = property.title ?? name;
  const unit = property['x-unit'];
  const measured = unit === 'angle' ? { isAngle: true as const } : unit ? { unit } : {};
  if (AS_JSON.has(place)) return { kind: 'json', label };
  if (place === 'Launch.site') return { kind: 'site', label };
  if (place === 'Vehicle.parts') return { kind: 'parts', label, item: referred('VehiclePart', label, {}, place) };
  const hint = HINTS[place] ? { hint: HINTS[place] } : {};
  if (property.$ref) return referred(nameOf(property.$ref), label, measured, place);
  switch (property.type) {
    case 'boolean':
      return property.const === false ? { kind: 'words', label, words: {} } : { kind: 'flag', label };
    case 'string':
      return { kind: 'text', label, ...hint };
    case 'array': {
      const items = property.items ?? {};
      if (items.$ref) {
        const { one, empty } = ELEMENTS[place] ?? { one: label, empty: {} };
        return { kind: 'list', label, one, empty, item: referred(nameOf(items.$ref), label, {}, place) };
      }
      // Columns: those of the list, or of a part of the vehicle, which the case names.
      const words = items.enum ?? items.anyOf?.find((one) => one.enum)?.enum;
      if (words) return { kind: 'several', label, words };
      if (items.type === 'string') return { kind: 'names', label, ...hint };
      if (items.type === 'array') return { kind: 'matrix', label };
      if (property.minItems === 3 && property.maxItems === 3) return { kind: 'vector', label, unit: unit ?? '' };
      if (TABLES[schemaName]?.includes(name)) return { kind: 'column', label, table: schemaName, ...measured };
      return { kind: 'numbers', label, ...measured };
    }
    default:
      return { kind: 'number', label, ...measured };
  }
}

/** The field of a schema with a name. */
function referred(name: string, label: string, measured: { unit?: string; isAngle?: true }, place: string): Field {
  switch (name) {
    case 'RequestedSensitivities':
      return { kind: 'flag', label, orObject: true };
    case 'Command':
      return { kind: 'command', label };
    case 'Along':
      return { kind: 'along', label, words: wordsOf('Axis') };
    case 'ScheduleVariable':
      return { kind: 'variable', label, words: wordsOf('Against') };
    case 'ConvectiveFlux':
      return { kind: 'convective', label };
    case 'ThrustCommand':
      return { kind: 'thrust', label };
    case 'SiderealTime':
      return { kind: 'text', label, hint: 's or HH:MM:SS' };
    case 'NumberOrList':
      return { kind: 'numbers', label, orOne: true, ...measured };
  }
  const { variants, properties } = named(name);
  const none = NONE[place] ? { none: NONE[place] } : {};
  if (variants) return { kind: 'variant', label, kinds: kindsOf(name), ...none };
  const isOptional = SWITCHES[place] ? { isOptional: SWITCHES[place] } : {};
  if (properties) return { kind: 'group', label, schema: name, fields: fieldsOf(name), ...isOptional };
  return { kind: 'words', label, words: wordsOf(name) };
}

/** The kinds of a union, by their `type`. */
function kindsOf(name: string): Record<string, Kind> {
  const { variants = [], discriminator } = named(name);
  const mapping = discriminator?.mapping ?? {};
  return Object.fromEntries(
    ordered(name, Object.keys(mapping)).map((type) => {
      const variant = variants.find(({ $ref }) => $ref === mapping[type]);
      const of = nameOf(mapping[type] as string);
      return [type, { label: variant?.title ?? type, schema: of, fields: fieldsOf(of) }];
    }),
  );
}

/** The parts of a case. */
export const SECTIONS = fieldsOf('SimulateRequest') as Record<keyof Case, Field>;

/** A schedule of an angle. */
export const SCHEDULE: Kind = { label: 'Schedule', schema: 'Schedule', fields: fieldsOf('Schedule') };

/** Sutton and Graves's correlation in a gas. */
export const SUTTON_GRAVES = fieldsOf('SuttonGraves');

/** The correlations of the convective heat flux in air. */
export const CONVECTIVE = wordsOf('Convective');

/** The time since an event. */
export const SINCE = fieldsOf('SinceEvent');

/** A thrust that is switched on. */
export const THRUST = fieldsOf('Thrust');
