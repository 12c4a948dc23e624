import { readFileSync } from 'node:fs';
import createClient, { type Client } from 'openapi-fetch';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import type { Answer, Case, Problem, Row, State } from '../../src/api';
import type { paths } from '../../src/generated/api';
import { ROOT, type Service, serve } from './browser';

/** What is asked for: JSON, or the problem document in its place. */
type Media = 'application/json' | 'application/problem+json';

let service: Service;
let client: Client<paths, Media>;

beforeAll(async () => {
  service = await serve();
  client = createClient<paths, Media>({ baseUrl: service.address });
});

afterAll(() => service?.stop());

/** The air of the thesis. */
const atmosphere = { type: 'exponential', surface_density: 1.54793, scale_height: 6935 } as const;

/** The cases, by the names of their files: a change of the contract does not compile. */
const CASES = {
  target_1: {
    name: 'target_1',
    angle_unit: 'rad',
    atmosphere,
    vehicle: {
      mass: 13,
      reference_area: 0.036609615,
      aerodynamics: { type: 'constant', lift_coefficient: 0, drag_coefficient: 0.08575 },
    },
    control: { bank_angle: 0 },
    initial_state: {
      type: 'orbital_elements',
      semi_major_axis: -1840738,
      eccentricity: 1.889431,
      inclination: 1.178101,
      raan: 4.213107,
      argument_of_periapsis: 2.377746,
      true_anomaly: 4.552029,
      sidereal_time: 0,
    },
    stop: { altitude: 0, time: 10_000 },
  },
  target_2: {
    name: 'target_2',
    angle_unit: 'rad',
    atmosphere,
    vehicle: { mass: 700, reference_area: 0.216419, aerodynamics: { type: 'constant', lift_coefficient: 0.2, drag_coefficient: 0.2 } },
    control: { bank_angle: 0.8 },
    initial_state: {
      type: 'planet_relative',
      radius: 6500140,
      longitude: -1.34732,
      geocentric_latitude: 0.65176,
      speed: 3007.2,
      flight_path_angle: -0.523599,
      heading: 1.195427,
    },
    stop: { altitude: 0, time: 10_000 },
  },
  impulse: {
    name: 'impulse',
    angle_unit: 'rad',
    atmosphere,
    vehicle: { mass: 1088.64, reference_area: 1.880022, aerodynamics: { type: 'constant', lift_coefficient: 0, drag_coefficient: 0.11 } },
    control: { bank_angle: 0 },
    initial_state: {
      type: 'eci',
      position: [1044303.78549, -4866124.54174, 4845298.63761],
      velocity: [-1094.1974, -4187.85837, 2588.77299],
      sidereal_time: 200.6,
    },
    stop: { altitude: 0, time: 10_000 },
  },
} satisfies Record<string, Case>;

type Planet = NonNullable<Case['planet']>;
type Model = NonNullable<Planet['model']>;
type Place = Pick<Row, 'radius' | 'longitude' | 'geocentric_latitude'>;

/** A file of `tests/cases/thesis`: a case, and its solutions by an independent program under three sets of constants. */
interface Reference {
  request: Case;
  shape: NonNullable<Planet['shape']>;
  expected: Record<Model, Pick<Answer, 'termination' | 'initial_state' | 'final_state' | 'peaks'>>;
}

function reference(name: string): Reference {
  return JSON.parse(readFileSync(new URL(`tests/cases/thesis/${name}.json`, ROOT), 'utf8'));
}

/** How far two places are apart, m. */
function apart(a: Place, b: Place): number {
  const [there, here] = [a, b].map(({ radius, longitude, geocentric_latitude: latitude }) => [
    radius * Math.cos(latitude) * Math.cos(longitude),
    radius * Math.cos(latitude) * Math.sin(longitude),
    radius * Math.sin(latitude),
  ]);
  return Math.hypot(...(there ?? []).map((component, axis) => component - (here?.[axis] ?? Number.NaN)));
}

/** The state in planet-relative coordinates, and all that it is answered in. */
async function converted(state: State, planet: Planet) {
  const { data } = await client.POST('/convert', { body: { state, planet } });
  if (!data) throw new Error('no answer');
  return data;
}

describe.each(Object.entries(CASES))('%s', (name, typed) => {
  const { request, shape, expected } = reference(name);

  it('is the case of the file', () => {
    expect(typed).toEqual(request);
  });

  it.each(Object.keys(expected) as Model[])('flies as its reference on %s', async (model) => {
    const { data, error } = await client.POST('/simulate', { body: { ...typed, planet: { model, shape } } });
    expect(error).toBeUndefined();
    if (!data) throw new Error('no answer');
    const { termination, final_state: impact, peaks } = expected[model];
    // A metre is what the API promises, and the rest follows of it; peaks as in `tests/http/reference.rs`.
    expect(data.termination).toBe(termination);
    expect(apart(data.final_state, impact)).toBeLessThan(1);
    expect(Math.abs(data.final_state.time - impact.time)).toBeLessThan(1 / impact.speed);
    expect(Math.abs(data.peaks.deceleration.value / peaks.deceleration.value - 1)).toBeLessThan(1e-8);
    expect(Math.abs(data.peaks.deceleration.time - peaks.deceleration.time)).toBeLessThan(2e-4);
    expect(data.trajectory?.time?.at(-1)).toBe(data.final_state.time);
  });

  it.each(Object.keys(expected) as Model[])('is converted as its reference on %s', async (model) => {
    const planet = { model, shape };
    const { planet_relative: found, orbital_elements: elements } = await converted(typed.initial_state as State, planet);
    const start = expected[model].initial_state;
    expect(apart({ ...found, radius: found.radius ?? Number.NaN }, start)).toBeLessThan(1e-3);
    expect(Math.abs(found.speed / start.speed - 1)).toBeLessThan(1e-6);
    expect(Math.abs(found.flight_path_angle - start.flight_path_angle)).toBeLessThan(1e-9);
    // What is answered can be asked with.
    if (!elements) throw new Error('no elements');
    const again = await converted(elements, planet);
    expect(again.planet_relative.speed).toBeCloseTo(start.speed, 5);
  });
});

it('a bad case comes back as a problem with every fault', async () => {
  const bad: Case = { ...CASES.target_2, density_factor: -1, solver: { relative_tolerance: 1 } };
  const { data, error, response } = await client.POST('/simulate', { body: bad });
  expect(data).toBeUndefined();
  const problem: Problem | undefined = error;
  expect(problem?.status).toBe(422);
  expect(problem?.type).toBe('/problems/invalid-case');
  expect(problem?.errors?.map((fault) => fault.pointer)).toEqual(['/density_factor', '/solver/relative_tolerance']);
  expect(response.headers.get('x-request-id')).toBeTruthy();
});

it('a batch has a line a case', async () => {
  const cases = [CASES.target_1, { ...CASES.impulse, density_factor: -1 }];
  const { data } = await createClient<paths>({ baseUrl: service.address }).POST('/simulate/batch', { body: cases, parseAs: 'text' });
  const [flight, problem] = (data ?? '')
    .trimEnd()
    .split('\n')
    .map((line) => JSON.parse(line)) as [Answer, Problem];
  expect(flight.termination).toBe('surface_impact');
  expect(problem.errors?.[0]?.pointer).toBe('/density_factor');
});
