import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';

const ROOT = new URL('../../../../', import.meta.url);
const OWN = ['lifting_capsule', 'deorbit'];
const THESIS = ['target_1', 'target_2', 'impulse', 'shallow_glide', 'steep_glide', 'steep_ballistic', 'medium_glide_supercircular'];

type Json = null | boolean | number | string | Json[] | { [name: string]: Json };
type Tree = { [name: string]: Json };

/** An example of the page. */
interface Example {
  group: string;
  title: string;
  case: Json;
}

/**
 * The examples of the page, as `virtual:examples`: the cases of the repository, of which some are written with what they have in common
 * told once.
 */
export function examples(): Plugin {
  return {
    name: 'examples',
    resolveId: (id) => (id === 'virtual:examples' ? '\0virtual:examples' : undefined),
    load: (id) =>
      id === '\0virtual:examples' ? `export default ${JSON.stringify([...own(), ...flown(), ...thesis(), ...checks()])}` : undefined,
  };
}

// biome-ignore lint/suspicious/noExplicitAny: the files are the repository's own, and a wrong one fails the build
function read(path: string): any {
  return JSON.parse(readFileSync(new URL(path, ROOT), 'utf8'));
}

function own(): Example[] {
  return OWN.map((file) => read(`openapi/examples/${file}.json`)).map((request) => ({
    group: 'Missions',
    title: request.name,
    case: request,
  }));
}

/** The seven tables of the thesis, with the constants of its listing. */
function thesis(): Example[] {
  return THESIS.map((file) => read(`tests/cases/thesis/${file}.json`)).map(({ title, shape, request }) => ({
    group: 'Thesis (Jameson 2006)',
    title: title.replace('Jameson 2006, ', ''),
    case: { ...request, name: title.replace(/^Jameson 2006, Table \d: /, ''), planet: { model: 'earth_jameson_listing', shape } },
  }));
}

/** Entries that were flown. */
function flown(): Example[] {
  const { defaults, flights } = read('tests/cases/flights/flights.json');
  return flights.map((flight: Tree) => {
    const like = flights.find((other: Tree) => other.name === flight.like);
    const { output: _, ...request } = [like, flight].reduce((merged, part) => merge(merged, part?.request ?? {}), defaults) as Tree;
    return { group: 'Flown', title: flight.name as string, case: { name: flight.name, ...request } };
  });
}

/** A sphere that is dropped and thrown. */
function checks(): Example[] {
  const file = read('tests/cases/nesc/cases.json');
  const { source: _, ...constants } = file.constants.nasa;
  // By number: an object has `10` before `01`.
  const cases = Object.entries(file.cases as Record<string, Tree>).sort();
  return cases.map(([number, check]) => {
    const title = `Check case ${Number(number)}: a sphere ${check.title}`;
    const wind = check.wind === undefined ? {} : { wind: check.wind };
    return {
      group: 'NASA check cases (TM-2015-218675)',
      title,
      case: {
        name: title,
        angle_unit: 'deg',
        planet: { ...file.planet, ...constants },
        atmosphere: { type: 'us76' },
        ...wind,
        vehicle: { ...file.vehicle, aerodynamics: { type: 'constant', drag_coefficient: check.drag_coefficient as Json } },
        initial_state: {
          type: 'geodetic',
          geodetic_altitude: check.geodetic_altitude as Json,
          longitude: 0,
          geodetic_latitude: 0,
          speed: check.speed as Json,
          flight_path_angle: check.flight_path_angle as Json,
          azimuth: check.azimuth as Json,
        },
      },
    };
  });
}

/** A merge patch (RFC 7396): null takes a field away. */
function merge(target: Json, patch: Json): Json {
  if (typeof patch !== 'object' || patch === null || Array.isArray(patch)) return patch;
  const merged: Tree = typeof target === 'object' && target !== null && !Array.isArray(target) ? { ...target } : {};
  for (const [name, value] of Object.entries(patch)) {
    if (value === null) delete merged[name];
    else merged[name] = merge(merged[name] ?? null, value);
  }
  return merged;
}
