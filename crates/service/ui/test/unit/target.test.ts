import { describe, expect, it, vi } from 'vitest';
import type { Case, Goal, Target } from '../../src/api';
import { alone, inUnit, pathOf } from '../../src/case';
import { whyNoCase } from '../../src/form/shape';
import { fromFragment, toFragment } from '../../src/link';
import { numberAt } from '../../src/numbers';
import { numbersWithSlider, rangeOf, roleOf, withRole } from '../../src/roles';
import { bodiesOf, goalOn, namesOf } from '../../src/target/bodies';
import { corridorRequest, taken, targetRequest } from '../../src/target/request';
import { limitInWords, outcomeInWords } from '../../src/target/why';

vi.stubGlobal('document', { baseURI: 'http://localhost/' });

const CASE = {
  angle_unit: 'deg',
  vehicle: { mass: 5500, reference_area: 12, aerodynamics: { type: 'constant', drag_coefficient: 1.3, lift_coefficient: 0.39 } },
  control: { bank_angle: 40 },
  events: [
    {
      name: 'deorbit burn',
      when: { quantity: 'time', rises_through: 900 },
      then: { delta_v: { along: 'velocity', value: -120 } },
    },
  ],
  initial_state: {
    type: 'planet_relative',
    altitude: 120000,
    longitude: 0,
    geocentric_latitude: 0,
    speed: 7400,
    flight_path_angle: -2,
    heading: 0,
  },
  output: { interval: 1 },
} as unknown as Case;
const SITE = { site: { longitude: 67, geodetic_latitude: 48 }, tolerance: 10 } as unknown as Goal;
const LOAD = { quantity: 'load_factor', at: 'peak', at_most: 6, tolerance: 0.01 } as unknown as Goal;
const BANK = { pointer: '/control/bank_angle', between: [-90, 90] };
const BURN = { pointer: '/events/0/when/rises_through', between: [0, 3000] };
const asked = (more: object) => ({ ...CASE, ...more }) as Case;

describe('the role of a number', () => {
  const bank = ['control', 'bank_angle'];
  const area = ['vehicle', 'reference_area'];

  it('is a slider where the number matters, and fixed else', () => {
    expect(roleOf(CASE, bank)).toBe('slider');
    expect(roleOf(CASE, area)).toBe('fixed');
  });

  it('changes, and its number has a slider or none', () => {
    const slid = withRole(CASE, area, 'slider');
    expect(roleOf(slid, area)).toBe('slider');
    expect(numbersWithSlider(slid).map(({ label }) => label)).toEqual([
      'Flight-path angle',
      'Speed',
      'Bank angle',
      'Mass',
      'Air density',
      'Reference area',
    ]);
    const fixed = withRole(slid, bank, 'fixed');
    expect(roleOf(fixed, bank)).toBe('fixed');
    expect(roleOf(fixed, area)).toBe('slider');
    expect(alone(fixed)).toEqual(CASE);
  });

  it('is free in a range around the value, and leaves none behind', () => {
    const free = withRole(withRole(CASE, bank, 'free'), ['events', 0, 'then', 'delta_v', 'value'], 'free');
    expect(free.vary).toEqual([
      { pointer: '/control/bank_angle', between: [-180, 180] },
      { pointer: '/events/0/then/delta_v/value', between: [-180, -60] },
    ]);
    expect(free.sliders).toBeUndefined();
    expect(numbersWithSlider(free).at(-1)?.label).toBe('deorbit burn: Δv');
    expect(withRole(withRole(free, bank, 'slider'), ['events', 0, 'then', 'delta_v', 'value'], 'fixed').vary).toBeUndefined();
  });

  it('has its bounds in the unit of the case', () => {
    const free = withRole(inUnit(CASE, 'rad'), ['initial_state', 'flight_path_angle'], 'free');
    expect(free.vary?.[0]?.between[0]).toBeCloseTo((-7 * Math.PI) / 180, 12);
    expect(rangeOf(free, free.vary?.[0] as never)).toEqual([-7, 3]);
    expect(inUnit(free, 'deg').vary?.[0]?.between).toEqual([-7, 3]);
  });

  it('is named by the number and where it stands', () => {
    const label = (at: string) => numberAt(CASE, pathOf(CASE, at)).label;
    expect(label('/events/0/when/rises_through')).toBe('deorbit burn: Time');
    expect(label('/vehicle/aerodynamics/drag_coefficient')).toBe('Drag coefficient');
    expect(label('/no/such/number')).toBe('/no/such/number');
  });
});

describe('a request', () => {
  it('of a target has the case, what is free and what is to be achieved', () => {
    const { output: _, ...flight } = CASE;
    expect(targetRequest(asked({ vary: [BANK, BURN], achieve: [SITE, LOAD], sliders: [] }))).toEqual({
      ...flight,
      vary: [BANK, BURN],
      achieve: [SITE, LOAD],
    });
    expect(targetRequest(asked({ vary: [BANK] }))).toBeNull();
    expect(targetRequest(asked({ achieve: [SITE] }))).toBeNull();
  });

  it('of a corridor has the one free number and the goals that are limits', () => {
    const { tolerance: _, ...limit } = LOAD as { tolerance?: number };
    expect(corridorRequest(asked({ vary: [BANK], achieve: [SITE, LOAD] }))).toMatchObject({ vary: BANK, limits: [limit] });
    expect(corridorRequest(asked({ vary: [BANK], achieve: [SITE] }))).toBeNull();
    expect(corridorRequest(asked({ vary: [BANK, BURN], achieve: [LOAD] }))).toBeNull();
    const limits = [{ termination: ['surface_impact'], with: { '/control/bank_angle': 180 } }];
    expect(corridorRequest(asked({ vary: [BURN], limits }))).toMatchObject({ vary: BURN, limits });
  });

  it('is answered with numbers that are taken as the case writes them', () => {
    const tree = asked({ vary: [BURN, { ...BANK, also: [{ pointer: '/density_factor' }] }], achieve: [SITE] });
    const solution = {
      case: { ...CASE, events: [{ when: { rises_through: 2100 } }], control: { bank_angle: 75 }, density_factor: 1.1, echo: false },
    } as unknown as Target['solutions'][number];
    const next = taken(tree, solution);
    expect(next).toEqual({
      ...tree,
      control: { bank_angle: 75 },
      density_factor: 1.1,
      events: [{ ...CASE.events?.[0], when: { quantity: 'time', rises_through: 2100 } }],
    });
  });
});

it('a limit in words', () => {
  const words = (limit: object) => limitInWords(CASE, limit as never, 'deg');
  expect(words({ quantity: 'load_factor', at: 'peak', at_most: 10, with: { '/control/bank_angle': 0 } })).toBe(
    'peak load factor at most 10 g, with bank angle at 0°',
  );
  expect(words({ quantity: 'altitude', between: [1000, 2500] })).toBe('altitude at the end at least 1 and at most 2.5 km');
  expect(words({ termination: ['surface_impact', 'stop_altitude'] })).toBe('ends with surface impact or stop altitude');
  expect(words({ site: 'mahia', within: 5000 })).toBe('lands within 5 km of the place');
  expect(words({ site: 'mahia', within: 5000, body: 'stage' })).toBe('stage lands within 5 km of the place');
  expect(words({ termination: ['surface_impact'], body: 'stage' })).toBe('stage ends with surface impact');
  expect(words({ quantity: 'load_factor', at: 'peak', at_most: 10, body: 'stage' })).toBe('peak load factor of stage at most 10 g');
});

it('bodies of a case, with those that leave them, and their events', () => {
  const events = [
    { name: 'ignition' },
    { then: { separate: [{ name: 'stage', events: [{ name: 'apart', then: { separate: [{ name: 'adapter' }] } }] }, { name: '' }] } },
  ];
  const bodies = bodiesOf(events as never);
  expect(bodies.map(({ name }) => name)).toEqual(['stage', 'adapter']);
  expect(bodies.map((body) => namesOf(body.events))).toEqual([['apart'], []]);
  expect(bodiesOf([null, { then: { separate: [null] } }] as never)).toEqual([]);
});

it('a goal on another flight keeps all but the event of the former one', () => {
  const goal = { quantity: 'speed', equals: 300, at: { event: 'ignition', side: 'after' } };
  expect(goalOn('stage', goal as never)).toEqual({ quantity: 'speed', equals: 300, body: 'stage' });
  const timed = { quantity: 'speed', equals: 300, at: { time: 10 }, body: 'stage' };
  expect(goalOn('', timed as never)).toEqual({ quantity: 'speed', equals: 300, at: { time: 10 } });
});

it('what is asked of a case is in its link', async () => {
  const tree = withRole(asked({ vary: [BURN], achieve: [SITE, LOAD] }), ['vehicle', 'reference_area'], 'slider');
  expect(await fromFragment(await toFragment(tree))).toEqual(tree);
  // As a corridor has it.
  expect(whyNoCase({ ...tree, vary: BURN })).toBeNull();
  expect(whyNoCase({ ...tree, vary: [BURN, 3] })).toBe('/vary/1 must be an object, got a number');
  expect(whyNoCase({ ...tree, achieve: [3] })).toBe('/achieve/0 must be an object, got a number');
});

describe('the sentence', () => {
  const NEAREST = { values: [900, 90], misses: [0, -212_000, 0], at_bounds: [], edge: null, insensitive: [], stationary: true };
  const answer = (more: object) =>
    ({
      angle_unit: 'deg',
      outcome: 'not_reached',
      solutions: [],
      complete: false,
      nearest: null,
      search: { classes: [] },
      ...more,
    }) as unknown as Target;
  const said = (more: object, nearest: object | null = null, course: number | null = 0, achieve = [SITE, LOAD]) =>
    outcomeInWords({
      asked: asked({ vary: [BURN, BANK], achieve }),
      answer: answer({ ...more, nearest: nearest && { ...NEAREST, ...nearest } }),
      reader: 'deg',
      course,
    });

  it('says how many solutions there are', () => {
    expect(said({ outcome: 'reached', solutions: [{}] })).toBe('1 solution');
    expect(said({ outcome: 'reached', solutions: [{}, {}], complete: true })).toBe('2 solutions, and no others within the bounds');
    expect(said({ outcome: 'out_of_budget', solutions: [{}] })).toBe('1 solution before the search ran out of time');
  });

  it('says how near it comes, and what keeps it from coming nearer', () => {
    const bound = { at_bounds: [{ vary: 1, bound: 'greatest' }] };
    expect(said({}, bound)).toBe('cannot reach: 212 km short, bound by bank angle at 90°');
    expect(said({}, bound, 180)).toBe('cannot reach: 212 km long, bound by bank angle at 90°');
    expect(said({}, bound, 90)).toBe('cannot reach: 212 km to the right, bound by bank angle at 90°');
    expect(said({}, bound, 315)).toBe('cannot reach: 150 km short and 150 km to the left, bound by bank angle at 90°');
    expect(said({}, {}, null)).toBe('cannot reach: 212 km off, no small change of the free numbers comes nearer');
    expect(said({ outcome: 'out_of_budget' }, { stationary: false })).toBe('not found in time: nearest so far 212 km short');
    const ofStage = [{ ...SITE, body: 'stage' }, LOAD] as never;
    expect(said({}, bound, 0, ofStage)).toBe('cannot reach: stage 212 km short, bound by bank angle at 90°');
    expect(said({}, { ...bound, misses: [null, null, 0] }, 0, ofStage)).toBe(
      'cannot reach: no landing of stage, bound by bank angle at 90°',
    );
  });

  it('names every goal that is missed, and what cannot change it', () => {
    const misses = [3, -4, 1.234];
    expect(said({}, { misses, insensitive: [1] })).toBe(
      'cannot reach: peak load factor 1.23 g too high, no free number changes the peak load factor',
    );
    const SPEED = { quantity: 'speed', equals: 100 } as unknown as Goal;
    expect(said({}, { misses: [-2.5], edge: { beyond: 'time_limit' } }, null, [SPEED])).toBe(
      'cannot reach: speed at the end 2.5 m/s too low, beyond it flights run into the time limit',
    );
  });

  it('says how flights end where none ends as it should', () => {
    expect(said({ outcome: 'out_of_budget', search: { classes: ['surface_impact'] } })).toBe('not found in time');
    expect(said({ search: { classes: ['time_limit', 'atmosphere_exit'] } })).toBe(
      'cannot reach: no flight ends as it should, they run into the time limit or leave the atmosphere',
    );
  });
});
