import { describe, expect, it } from 'vitest';
import type { Answer } from '../../src/api';
import {
  columnOf,
  difference,
  endsApart,
  figuresOf,
  kilometres,
  modelsInWords,
  number,
  placeOf,
  reading,
  withPlanetsInWords,
} from '../../src/figures';
import { at, flightOf, indexBefore } from '../../src/flight';

const peak = (value: number) => ({ value, time: 50, altitude: 40_000 });

/** A flight of three rows in radians, across the antimeridian. */
const ANSWER = {
  angle_unit: 'rad',
  version: '0',
  models: { planet: 'earth_wgs84' },
  termination: 'surface_impact',
  initial_state: {
    time: 0,
    altitude: 1e5,
    longitude: 3.1,
    geocentric_latitude: 0,
    geodetic_latitude: 0,
    speed: 7000,
    flight_path_angle: -0.1,
    radius: 6.4e6,
  },
  final_state: {
    time: 100,
    altitude: 0,
    longitude: -3.1,
    geocentric_latitude: 0.5,
    geodetic_latitude: 0.5,
    speed: 200,
    flight_path_angle: -Math.PI / 2,
    radius: 6.4e6,
  },
  peaks: {
    deceleration: peak(98),
    load_factor: peak(10),
    dynamic_pressure: peak(20_000),
    altitude: { value: 1e5, time: 0, altitude: 1e5 },
    heat_flux: peak(1.5e6),
  },
  events: [{ index: 1, time: 60 }],
  trajectory: { time: [0, 50, 100], altitude: [1e5, 4e4, 0], longitude: [3.1, 3.14, -3.1] },
  solver: {},
  warnings: [],
} as unknown as Answer;

describe('a flight', () => {
  const flight = flightOf(ANSWER);

  it('has its angles in degrees', () => {
    expect(flight.columns.longitude?.[0]).toBeCloseTo(177.6169, 4);
    expect(flight.final.flight_path_angle).toBeCloseTo(-90, 12);
    expect(flight.columns.altitude).toEqual([1e5, 4e4, 0]);
  });

  it('goes the shorter way between two angles', () => {
    // 3.14 to 2π - 3.1, halfway.
    expect(at(flight, 'longitude', 75)).toBeCloseTo(((3.14 + 2 * Math.PI - 3.1) / 2) * (180 / Math.PI), 9);
  });

  it('holds at its ends', () => {
    expect(at(flight, 'altitude', -5)).toBe(1e5);
    expect(at(flight, 'altitude', 500)).toBe(0);
    expect(at(flight, 'altitude', 25)).toBe(7e4);
    expect(at(flight, 'mach', 25)).toBeNaN();
  });

  it('marks its events, the peaks on the way, and its end', () => {
    expect(flight.marks.map(({ kind, label, time }) => [kind, label, time])).toEqual([
      ['start', 'start', 0],
      ['event', 'event 2', 60],
      ['peak', 'peak load factor', 50],
      ['peak', 'peak dynamic pressure', 50],
      ['peak', 'peak heat flux', 50],
      ['end', 'impact', 100],
    ]);
  });

  it('tells the peak loads of its parts, but for those that do not matter', () => {
    const phase = (from: object | null, value: number) => ({
      from,
      since: 0,
      until: 1,
      peaks: { load_factor: { value, time: 0, altitude: 0 } },
    });
    const parts = (phases: object[]) => {
      const peaks = { ...ANSWER.peaks, load_factor: { value: 6.9, time: 50, altitude: 4e4 } };
      const flown = flightOf({ ...ANSWER, peaks, phases } as unknown as Answer);
      return figuresOf(flown, 'deg').find(({ label }) => label === 'Peak load factor')?.parts;
    };
    expect(
      parts([
        phase(null, 4.04),
        phase({ index: 0, name: 'burn', burnout: true }, 0.1),
        phase({ index: 1, name: 'main parachute' }, 6.8756),
      ]),
    ).toBe('4.04 g before the first event · 6.88 g after main parachute');
    expect(parts([phase({ index: 2, burnout: true }, 4), phase({ index: 2 }, 6.9)])).toBe(
      '4 g after burnout of event 3 · 6.9 g after event 3',
    );
    expect(parts([phase(null, 6.9), phase({ index: 0 }, 1)])).toBeUndefined();
  });

  it('that stops above the ground has no impact', () => {
    const stopped = {
      ...ANSWER,
      termination: 'stop_altitude',
      final_state: { ...ANSWER.final_state, altitude: 8000.0004 },
    } as unknown as Answer;
    expect(flightOf(stopped).marks.at(-1)).toMatchObject({ kind: 'end', label: 'stopped at 8 km' });
    expect(figuresOf(flightOf(stopped), 'deg')[0]).toMatchObject({ label: 'Time', note: 'Stopped at 8 km' });
  });

  it('ends at an instant in UTC where its case has an epoch', () => {
    const final_state = { ...ANSWER.final_state, utc: '2006-01-15T10:10:33.123456Z' };
    expect(figuresOf(flightOf({ ...ANSWER, final_state }), 'deg')[0]).toMatchObject({ note: 'Impact, 2006-01-15 10:10:33 UTC' });
    expect(figuresOf(flight, 'deg')[0]).toMatchObject({ note: 'Impact' });
  });

  it('that only descends is highest at the start', () => {
    expect(figuresOf(flight, 'deg').find(({ label }) => label === 'Maximum altitude')).toMatchObject({ value: 100, note: 'at the start' });
  });

  it('has figures in the unit of angles', () => {
    const figure = (unit: 'rad' | 'deg', label: string) => figuresOf(flight, unit).find((candidate) => candidate.label === label);
    expect(figure('deg', 'Final flight-path angle')).toMatchObject({ unit: '°', value: expect.closeTo(-90, 10) });
    expect(figure('rad', 'Final flight-path angle')).toMatchObject({ unit: 'rad', value: expect.closeTo(-Math.PI / 2, 12) });
    expect(figure('rad', 'Peak heat flux')).toMatchObject({ unit: 'kW/m²', value: 1500, note: '40 km, 50 s' });
    expect(figure('rad', 'Peak Mach number')).toBeUndefined();
    expect(placeOf(flight.final, 'deg')).toBe('28.64789°, -177.61692°');
    expect(placeOf(flight.final, 'rad')).toBe('0.5000000 rad, -3.1000000 rad');
  });

  it('ends as far from another as the arc between them', () => {
    const other = flightOf({ ...ANSWER, final_state: { ...ANSWER.final_state, geocentric_latitude: 0.6 } });
    expect(endsApart(flight, other)).toBeCloseTo(640, 9);
    expect(endsApart(flight, flight)).toBe(0);
  });
});

it('models are told in words', () => {
  const models = {
    planet: 'earth_wgs84',
    shape: 'ellipsoid',
    atmosphere: 'us76',
    gravity: 'zonal',
    aerodynamics: 'constant',
    wind: 'still',
  };
  expect(modelsInWords(models as Answer['models'])).toBe('WGS 84 ellipsoid, U.S. Standard Atmosphere 1976, zonal gravity');
  const thesis = { ...models, planet: 'earth_jameson_listing', shape: 'sphere', atmosphere: 'exponential', gravity: 'inverse_square' };
  expect(modelsInWords(thesis as Answer['models'])).toBe('Earth sphere (thesis listing), exponential atmosphere, inverse-square gravity');
  const titan = { ...models, planet: 'titan', atmosphere: 'standard' };
  expect(modelsInWords(titan as Answer['models'])).toBe('Titan ellipsoid, standard atmosphere of Titan, zonal gravity');
  expect(withPlanetsInWords('place of impact, earth_jameson_text')).toBe('place of impact, thesis text');
});

it.each([
  [0, '0'],
  [157.41009, '157.41'],
  [-1.2025585, '−1.20256'],
  [4597.4716669, '4597.47'],
  [123456.789, '123,457'],
  [1.234e-7, '1.234e−7'],
  [-5e12, '−5e12'],
  [Number.NaN, '–'],
])('%d is shown as %s', (value, text) => {
  expect(number(value)).toBe(text);
});

it.each([
  [0, '0.000'],
  [3.7, '3.700'],
  [-41.234, '−41.23'],
  [6630.4, '6630'],
  [1_234_567, '1234567'],
  [2.5e-8, '2.500e−8'],
  [Number.NaN, '–'],
])('%d is read as %s', (value, text) => {
  expect(reading(value)).toBe(text);
});

it('the numbers of a column have the same decimals', () => {
  expect(columnOf([0, 12.5, 784.9041])).toEqual(['0.000', '12.500', '784.904']);
  expect(columnOf([-0.5, Number.NaN])).toEqual(['−0.500000', '–']);
  expect(columnOf([1.225, 2.2e-8])).toEqual(['1.2250e0', '2.2000e−8']);
  expect(columnOf([0, 0])).toEqual(['0.00000', '0.00000']);
});

it('a length in km is to the millimetre', () => {
  expect([-9.3e-10, 214.1234, 120_000.6].map((metres) => kilometres(metres))).toEqual(['0', '0.214123', '120.001']);
});

it('a difference has its sign', () => {
  expect([0.12345, -0.12345, 0].map(difference)).toEqual(['+0.1235', '−0.1235', '0']);
});

it.each([
  [-1, 0],
  [0, 0],
  [1.5, 1],
  [2, 2],
  [9, 3],
])('the index before %d is %d', (value, index) => {
  expect(indexBefore([0, 1, 2, 3], value)).toBe(index);
});
