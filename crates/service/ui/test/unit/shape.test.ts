import { readdirSync, readFileSync } from 'node:fs';
import examples from 'virtual:examples';
import { h } from 'preact';
import { renderToString } from 'preact-render-to-string';
import { describe, expect, it, vi } from 'vitest';
import type { Case } from '../../src/api';
import { inUnit, pointer, set, tidied } from '../../src/case';
import { Form } from '../../src/form/form';
import { whyNoCase } from '../../src/form/shape';
import { Sliders } from '../../src/sliders';
import { asJson, asPython, fileName } from '../../src/snippets';
import { draft } from '../../src/store';

vi.stubGlobal('document', { baseURI: 'http://localhost/' });

const FOLDER = new URL('../../../../../openapi/examples/', import.meta.url);
const OWN = readdirSync(FOLDER)
  .map((name) => JSON.parse(readFileSync(new URL(name, FOLDER), 'utf8')))
  .filter((tree) => tree.initial_state) as Case[];

/** A case in which every part of the form is used that the examples leave out. */
const FULL = {
  ...OWN[0],
  planet: { model: 'custom', gravity: { type: 'zonal', degree: 2, j2: 1e-3 }, equatorial_radius: 6.4e6 },
  atmosphere: { type: 'layered_exponential', layers: [{ base_altitude: 0, density: 1, scale_height: 7e3 }] },
  wind: { type: 'table', altitude: [0, 1e4], east: [1, 2], north: [3, 4] },
  heating: { convective: { type: 'sutton_graves', constant: 1e-4 }, radiative: 'none' },
  initial_state: { type: 'eci', frame: 'date', position: [7e6, 0, 0], velocity: [0, 7e3, 0] },
  control: {
    bank_angle: { type: 'schedule', against: 'energy', at: [0], value: [0] },
    angle_of_attack: { type: 'schedule', against: { since: 'first' }, at: [0], value: [0] },
  },
  vehicle: { mass: 1, aerodynamics: { type: 'alpha_mach_table', angle_of_attack: [0], mach: [1], drag_coefficient: [[1]] } },
  events: [
    {
      name: 'first',
      when: { quantity: 'altitude', falls_through: 1e4 },
      then: {
        aerodynamics: { type: 'mach_table', mach: [1, 2], drag_coefficient: [1, 2] },
        delta_v: { along: { frame: 'inertial', direction: [0, 0, 1] }, value: 1 },
        thrust: { along: 'velocity', value: 1 },
        deploy: { name: 'main', drag_area: 1 },
        release: ['main'],
      },
    },
  ],
  stop: { altitude: 0, when: [{ quantity: 'mach', falls_through: 1 }] },
  output: { times: [1, 2], columns: ['time'] },
} as unknown as Case;

const STRANGE = [
  null,
  true,
  5,
  'text',
  '',
  '__proto__',
  'constructor',
  [],
  [null],
  [[[]]],
  {},
  { type: '__proto__' },
  { type: 'toString', at: 5 },
  { type: {} },
  JSON.parse('{"__proto__": {"type": 5}, "toString": 5, "valueOf": 5, "constructor": 5}'),
];

/** Every path of a tree. */
function pathsOf(tree: unknown, path: (string | number)[] = []): (string | number)[][] {
  if (typeof tree !== 'object' || tree === null) return [path];
  const inner = Array.isArray(tree) ? tree.map((value, index) => [index, value] as const) : Object.entries(tree);
  // Of a table, two rows are as good as all.
  return [path, ...inner.slice(0, Array.isArray(tree) ? 2 : undefined).flatMap(([name, value]) => pathsOf(value, [...path, name]))];
}

/** Everything that the page makes of a case before it is flown. */
function show(tree: Case): void {
  draft.value = tree;
  renderToString(h(Form, {}));
  renderToString(h(Sliders, {}));
  for (const unit of ['deg', 'rad'] as const) inUnit(tree, unit);
  for (const made of [asJson, asPython, fileName]) made(tidied(tree));
}

const SOUND = { vehicle: {}, initial_state: {} };
const deep = (levels: number): unknown => JSON.parse('['.repeat(levels) + ']'.repeat(levels));

it.each([
  [[], 'it is not a JSON object'],
  [null, 'it is not a JSON object'],
  [{ type: 'FeatureCollection', features: [] }, 'vehicle and initial_state are missing'],
  [{ vehicle: {} }, 'initial_state is missing'],
  [{ vehicle: null, initial_state: 'x' }, 'vehicle and initial_state are missing'],
  [{ ...SOUND, events: 'x' }, '/events must be an array, got a string'],
  [{ ...SOUND, atmosphere: null, stop: [] }, '/atmosphere must be an object, got null, /stop must be an object, got an array'],
  [{ ...SOUND, events: [5, 5, 5, 5, 5] }, expect.stringMatching(/^\/events\/0 must be an object, got a number, .*, and 2 more$/)],
  [{ ...SOUND, name: {} }, '/name must be a single value, got an object'],
  [{ ...SOUND, control: { bank_angle: [1] } }, '/control/bank_angle must be an object, got an array'],
  [{ ...SOUND, solution: [] }, '/solution must be a single value, got an array'],
  [{ ...SOUND, vehicle: { mass: JSON.parse('1e999') } }, '/vehicle/mass must be a finite number in double precision'],
  [{ ...SOUND, atmosphere: { type: { toString: 5 } } }, '/atmosphere/type must be a single value, got an object'],
  [{ ...SOUND, more: deep(31) }, null],
  [{ ...SOUND, more: deep(32) }, 'it is nested more than 32 levels deep'],
  [{ ...SOUND, events: deep(10_000) }, 'it is nested more than 32 levels deep'],
  [{ ...SOUND, name: 'x'.repeat(1 << 20) }, 'it exceeds 1 MiB'],
])('%#: a value is no case, or is one', (value, why) => {
  expect(whyNoCase(value)).toEqual(why);
});

it('a case of which the service says what is wrong is one', () => {
  for (const type of ['venus', '__proto__', 'constructor', 'toString', 5, null]) {
    for (const name of ['initial_state', 'atmosphere', 'wind'] as const) {
      const tree = { ...SOUND, [name]: { type, speed: 'fast' }, density_factor: 'thin', verify: 5, unknown: {} } as unknown as Case;
      expect(whyNoCase(tree)).toBeNull();
      show(tree);
    }
  }
});

/** A case with all that a launch may have. */
const LAUNCH = JSON.parse(readFileSync(new URL('launcher.json', FOLDER), 'utf8')) as Case;

it('of a case with parts every field stays where another changes', () => {
  const full = {
    ...LAUNCH,
    control: { steering: { type: 'linear_tangent', a: 1, b: 0.01 } },
    events: [
      ...(LAUNCH.events ?? []),
      {
        when: { burnout: 'first', delay: 1 },
        then: {
          throttle: { second: 0.5 },
          load_limit: null,
          separate: [
            {
              name: 'x',
              parts: ['first'],
              push: { along: 'radial', value: 1 },
              events: [{ when: { quantity: 'time', rises_through: 9 } }],
            },
          ],
        },
      },
    ],
  } as unknown as Case;
  expect(whyNoCase(full)).toBeNull();
  show(full);
  expect(draft.value).toEqual(full);
  expect(
    set(set(full, ['vehicle', 'parts', 0, 'dry_mass'], 1), ['vehicle', 'parts', 0, 'dry_mass'], LAUNCH.vehicle.parts?.[0]?.dry_mass),
  ).toEqual(full);
});

describe('the cases of the repository', () => {
  it.each([...OWN, FULL, ...examples.map((example) => example.case)].map((tree) => [tree.name, tree] as const))('%s is one', (_, tree) => {
    expect(whyNoCase(tree)).toBeNull();
    show(tree);
  });
});

it.each([FULL, ...OWN].map((tree) => [tree.name, tree] as const))(
  'whatever stands in %s in place of something else, it is shown or refused',
  (_, tree) => {
    const failures: string[] = [];
    let refused = 0;
    for (const path of pathsOf(tree)) {
      for (const strange of STRANGE) {
        const mutant = set(tree, path, strange);
        if (whyNoCase(mutant) !== null) {
          refused += 1;
          continue;
        }
        try {
          show(mutant);
        } catch (error) {
          failures.push(`${pointer(path)} ${JSON.stringify(strange)}: ${error}`);
        }
      }
    }
    expect(failures).toEqual([]);
    expect(refused).toBeGreaterThan(50);
  },
  // A form is made for each of some thousand cases.
  60_000,
);
