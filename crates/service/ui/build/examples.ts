import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';

const ROOT = new URL('../../../../', import.meta.url);
/** Cases of the service's own, with what to know of them. */
const OWN = {
  lifting_capsule:
    'A made-up capsule. Its angle of attack gives it lift, which the bank turns to the side and back by a schedule. A drogue opens at 8 km within 1 s, the main parachute at 3 km within 8 s; it lands at 9 m/s, of which the wind has 5.',
  deorbit:
    'A made-up capsule of the size of a Soyuz: a braking burn half a revolution before the landing, separation, parachutes. They open at once here, which makes their loads greater than those of real ones.',
  sample_return:
    'The vehicle and the entry state of Stardust (AIAA 2008-1198), with one drag coefficient and parachutes of about its sizes. The place of entry is assumed, so that it comes down in Utah. Its greatest load is to be compared with the 32.9 g that are published.',
};
const THESIS = ['target_1', 'target_2', 'impulse', 'shallow_glide', 'steep_glide', 'steep_ballistic', 'medium_glide_supercircular'];

type Json = null | boolean | number | string | Json[] | { [name: string]: Json };
type Tree = { [name: string]: Json };

/** An example of the page. */
interface Example {
  group: string;
  title: string;
  case: Json;
  /** Its source, what is assumed, what to look at. */
  notes: string;
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
  return Object.entries(OWN).map(([file, notes]) => {
    const request = read(`openapi/examples/${file}.json`);
    return { group: 'Missions', title: request.name, case: request, notes };
  });
}

/** The seven tables of the thesis, with the constants of its listing. */
function thesis(): Example[] {
  return THESIS.map((file) => read(`tests/cases/thesis/${file}.json`)).map(({ title, shape, request }) => ({
    group: 'Thesis (Jameson 2006)',
    title: title.replace('Jameson 2006, ', ''),
    case: { ...request, name: title.replace(/^Jameson 2006, Table \d: /, ''), planet: { model: 'earth_jameson_listing', shape } },
    notes: `${/Table \d/.exec(title)} of R. E. Jameson's thesis (AFIT/GSS/ENY/06-M08, 2006), with the planet of its listing and its exponential atmosphere, which is 26 % denser at the ground than standard air. Its angles are in radians.`,
  }));
}

/** Entries that were flown. */
function flown(): Example[] {
  const { defaults, flights } = read('tests/cases/flights/flights.json');
  return flights.map((flight: Tree) => {
    const like = flights.find((other: Tree) => other.name === flight.like);
    const { output: _, ...request } = [like, flight].reduce((merged, part) => merge(merged, part?.request ?? {}), defaults) as Tree;
    const notes = `${flight.note} Source: ${flight.source}.`;
    return { group: 'Flown', title: flight.name as string, case: { name: flight.name, ...request }, notes };
  });
}

/** A sphere that is dropped and thrown. */
function checks(): Example[] {
  const file = read('tests/cases/nesc/cases.json');
  const { source: _, ...constants } = file.constants.nasa;
  const notes = `Source: ${file.source}.`;
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
      notes,
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
