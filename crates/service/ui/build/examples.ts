import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';

const ROOT = new URL('../../../../', import.meta.url);
/** Cases of the service's own, with notes. */
const OWN: Record<string, string> = {
  lifting_capsule:
    'Fictitious capsule with lift from its angle of attack. The bank angle follows a schedule: to one side, then back. The drogue parachute inflates at 8 km in 1 s, the main parachute at 3 km in 8 s. Touchdown speed is 9 m/s, including 5 m/s of wind.',
  deorbit:
    'Fictitious capsule of Soyuz size: deorbit burn half a revolution before landing, separation, parachutes. The parachutes open instantly in this case, so their opening loads are higher than those of a real capsule.',
  sample_return:
    'Vehicle and entry state of Stardust (AIAA 2008-1198), with a constant drag coefficient and parachutes of similar size. The entry point is assumed: the capsule lands in Utah. Compare the peak load with the published 32.9 g.',
  mars: 'Entry of the Mars Science Laboratory, 6 August 2012. Entry state: S. Dutta and R. D. Braun (2014). The bank angle is constant at 60°, as the flown one is not published in numbers; mass and coefficients are constant. The flight ends at 406 m/s, where the parachute opened after 254 s. The air is one Mars-GRAM column of another place and season. Altitudes are above the ellipsoid. Load factors are in g of the Earth.',
  titan:
    'Entry of Huygens, 14 January 2005. Interface at 1270 km at the given epoch (Kazeminejad et al., 2007); the drag coefficient, place and heading are assumed. The flight ends at 400 m/s, where the pilot parachute opened at 155 to 180 km, less than 3 minutes after the deceleration began. Load factors are in g of the Earth.',
  launcher:
    'Fictitious small launcher of two stages from Mahia. The load limit throttles the first stage at 5 g. The second stage follows a pitch program until the periapsis rises to 250 km; 50 kg of its propellant are left. First stage and fairing fly on to their impacts, without drag tables of their own: their coefficients are constant.',
  sounding_rocket:
    'Fictitious sounding rocket from Esrange: a solid motor with a thrust table and pressure loss at the nozzle, leaning by 4° at 400 m. The motor is separated 35 s after its burnout; the payload tumbles below 20 km and opens its parachute at 5.5 km. The flight ends at 330 m, the altitude of the range.',
  abort:
    'Fictitious capsule on a large launcher from Cape Canaveral: abort after 60 s. The launcher is left behind with its engines off, the escape tower burns for 6 s and is jettisoned 3 s later; the capsule descends under drogues and main parachutes.',
};
/** The cases of the thesis, with their titles. */
const THESIS: Record<string, string> = {
  target_1: 'TARGET reference case 1, steep and fast',
  target_2: 'TARGET reference case 2, banked lifting vehicle',
  impulse: 'IMPULSE reference case, inertial vectors',
  shallow_glide: 'Shallow gliding entry',
  steep_glide: 'Steep gliding entry',
  steep_ballistic: 'Steep ballistic entry',
  medium_glide_supercircular: 'Medium gliding entry at supercircular speed',
};
/** The check cases of NASA, with their titles. */
const CHECKS: Record<string, string> = {
  '01': 'dropped sphere, no drag',
  '06': 'dropped sphere with drag',
  '07': 'dropped sphere, steady west wind',
  '08': 'dropped sphere, wind shear',
  '09': 'sphere launched eastward',
  '10': 'sphere launched northward',
};

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
    const isEarth = (request.planet?.model ?? 'earth').startsWith('earth');
    const group = request.initial_state?.type === 'launch' ? 'Launches' : isEarth ? 'Missions' : 'Other planets';
    return { group, title: request.name, case: request, notes };
  });
}

/** The seven tables of the thesis, with the constants of its listing. */
function thesis(): Example[] {
  return Object.entries(THESIS).map(([file, name]) => {
    const { title, shape, request } = read(`tests/cases/thesis/${file}.json`);
    const table = /Table \d/.exec(title);
    return {
      group: 'Thesis (Jameson 2006)',
      title: `${table}: ${name}`,
      case: { ...request, name, planet: { model: 'earth_jameson_listing', shape } },
      notes: `${table} of R. E. Jameson's thesis (AFIT/GSS/ENY/06-M08, 2006). Planet constants of its program listing; exponential atmosphere with a surface density 26 % above that of the U.S. Standard Atmosphere 1976. Angles in radians.`,
    };
  });
}

/** Entries that were flown. */
function flown(): Example[] {
  const { defaults, flights } = read('tests/cases/flights/flights.json');
  return flights.map((flight: Tree) => {
    const like = flights.find((other: Tree) => other.name === flight.like);
    const { output: _, ...request } = [like, flight].reduce((merged, part) => merge(merged, part?.request ?? {}), defaults) as Tree;
    const notes = `${flight.note} Source: ${flight.source}.`;
    return { group: 'Real flights', title: flight.name as string, case: { name: flight.name, ...request }, notes };
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
    const title = `Check case ${Number(number)}: ${CHECKS[number] ?? check.title}`;
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
