import { describe, expect, it, vi } from 'vitest';
import type { Answer } from '../../src/api';
import { flightOf, isFlying, type Run, withBodies } from '../../src/flight';
import { conditionInWords, effectInWords, eventInWords } from '../../src/form/effects';
import { beyond, withCell } from '../../src/form/parts';
import { found, type ListedSite, titleOfSite } from '../../src/sites';

vi.stubGlobal('document', { baseURI: 'http://localhost/' });

const DEGREES = { own: 'deg', readers: 'deg' } as const;

describe('an event in words', () => {
  it.each([
    [{ quantity: 'time', rises_through: 0 }, 'at 0 s'],
    [{ quantity: 'altitude', falls_through: 4700 }, 'altitude falls below 4700 m'],
    [{ quantity: 'flight_path_angle', rises_through: 1 }, 'flight-path angle rises above 1°'],
    [{ burnout: 'booster', delay: 1 }, '1 s after burnout of booster'],
    [{ burnout: 'booster' }, 'at burnout of booster'],
    [{ event: 'staging', delay: 2 }, '2 s after staging'],
    [{ event: 'staging' }, 'at event staging'],
    [undefined, 'at ?'],
  ])('%j', (when, words) => {
    expect(conditionInWords(when, DEGREES)).toBe(words);
  });

  it.each([
    [{ ignite: ['first', 'booster'] }, 'ignites first, booster'],
    [{ shut_down: ['first'] }, 'shuts down first'],
    [
      {
        separate: [
          { name: 'first stage', parts: ['first'] },
          { name: 'ring', parts: ['ring'] },
        ],
      },
      'separates first stage, ring',
    ],
    [{ throttle: { core: 0.6 }, load_limit: 4 }, 'throttles core to 60 %, limits the load to 4 g'],
    [{ load_limit: null }, 'removes the load limit'],
    [{ tilt: { angle: 3 }, steer: { type: 'velocity' } }, 'tilts by 3°, steers: along the velocity'],
    [{ thrust: 'off', deploy: { name: 'main' } }, 'thrust off, deploys main'],
    [{}, ''],
  ])('%j', (then, words) => {
    expect(effectInWords(then, DEGREES)).toBe(words);
  });

  it('has angles in the unit of the reader, and says where nothing changes', () => {
    const event = { when: { quantity: 'flight_path_angle', falls_through: Math.PI / 6 } };
    expect(eventInWords(event, { own: 'rad', readers: 'deg' })).toBe('flight-path angle falls below 30°: no change');
  });
});

describe('a part', () => {
  const part = {
    name: 'first',
    dry_mass: 10,
    engine: { thrust: { vacuum: 1e3 }, specific_impulse: 300, exit_area: 0.1 },
    aerodynamics: {},
  };

  it('keeps what has no cell', () => {
    const changed = withCell(part, ['engine', 'thrust', 'vacuum'], 2e3);
    expect(changed).toEqual({ ...part, engine: { ...part.engine, thrust: { vacuum: 2e3 } } });
    expect(withCell(part, ['engine', 'thrust', 'vacuum'], undefined)).toEqual({
      ...part,
      engine: { specific_impulse: 300, exit_area: 0.1 },
    });
  });

  it('has an engine as long as a cell of it is filled', () => {
    const inert = { name: 'fairing', dry_mass: 5 };
    const lit = withCell(inert, ['engine', 'specific_impulse'], 300);
    expect(lit).toEqual({ ...inert, engine: { specific_impulse: 300 } });
    expect(withCell(lit, ['engine', 'specific_impulse'], undefined)).toEqual(inert);
  });

  it('tells what it has beyond the table', () => {
    expect(beyond(part)).toBe('exit area, aerodynamics');
    expect(beyond({ engine: { thrust: { type: 'table' } } })).toBe('thrust table');
    expect(beyond({ name: 'payload', dry_mass: 1 })).toBeUndefined();
  });
});

describe('bodies', () => {
  const state = (time: number, longitude: number) => ({ time, altitude: 0, longitude, geodetic_latitude: 0, speed: 1 });
  const flown = (from: number, to: number) => ({
    termination: 'surface_impact',
    initial_state: state(from, 0),
    final_state: state(to, 1),
    peaks: {},
    trajectory: { time: [from, to], longitude: [0, 1], altitude: [0, 0] },
    solver: { steps: 1 },
    warnings: [],
  });
  const body = (name: string, parent: string | null) => ({
    name,
    parent,
    separated_by: parent ? 2 : 'staging',
    separated_at: 10,
    ...flown(10, 50),
  });
  const answer = {
    angle_unit: 'rad',
    models: { planet: 'earth_wgs84' },
    condition: 0,
    events: [{ index: 0, time: 5 }],
    ...flown(0, 20),
    termination: 'condition',
    bodies: [body('stage', null), body('ring', 'stage')],
  } as unknown as Answer;
  const flight = flightOf(answer);

  it('are flights of their own, in degrees, on the clock of the case', () => {
    const [stage, ring] = flight.bodies;
    expect(stage).toMatchObject({ name: 'stage', parent: null, separatedBy: 'staging', separatedAt: 10 });
    expect(ring).toMatchObject({ parent: 'stage', separatedBy: 'event 3' });
    expect(stage?.flight.columns.longitude?.[1]).toBeCloseTo(57.2958, 4);
    expect(stage?.flight.answer).toMatchObject({ termination: 'surface_impact', models: { planet: 'earth_wgs84' } });
    expect(stage?.flight.marks.map(({ kind }) => kind)).toEqual(['start', 'end']);
    expect(stage?.flight.bodies).toEqual([]);
    expect([9, 10, 50, 51].map((time) => isFlying(stage?.flight ?? flight, time))).toEqual([false, true, true, false]);
  });

  it('have colours of their own, as long as there are some', () => {
    const many = { ...flight, bodies: Array.from({ length: 8 }, () => flight.bodies[0] as (typeof flight.bodies)[number]) };
    const tracks = withBodies({ id: 0, label: 'Current', colour: 0, case: {}, flight: many } as unknown as Run);
    expect(tracks.map(({ id }) => id)).toEqual([0, -1, -2, -3, -4, -5, -6, -7, -8]);
    expect(tracks.map(({ colour }) => colour)).toEqual([0, 1, 2, 3, 4, 5, 6, 1, 2]);
  });
});

it('sites are found by name, country and slug', () => {
  const site = (slug: string, name: string, country?: string) => ({ slug, name, country, kind: 'launch' }) as ListedSite;
  const all = [
    site('mahia', 'Rocket Lab Launch Complex 1', 'NZ'),
    site('kourou', 'Guiana Space Centre', 'GF'),
    site('sea_launch', 'Sea Launch'),
  ];
  expect(all.map(titleOfSite)).toEqual(['Rocket Lab Launch Complex 1, New Zealand', 'Guiana Space Centre, French Guiana', 'Sea Launch']);
  const slugs = (text: string) => found(all, text).map(({ slug }) => slug);
  expect(slugs('zealand')).toEqual(['mahia']);
  expect(slugs('launch')).toEqual(['mahia', 'sea_launch']);
  expect(slugs('  guiana  space')).toEqual(['kourou']);
  expect(slugs('')).toHaveLength(3);
});
