import { describe, expect, it } from 'vitest';
import type { Theory } from '../../src/api';
import type { Flight } from '../../src/flight';
import {
  addable,
  axesOf,
  bandsOf,
  curveOf,
  isJoined,
  nearest,
  picked,
  plotted,
  predictedOf,
  rangeOf,
  titleOf,
} from '../../src/plots/curves';

const FLIGHT = {
  columns: { time: [0, 1], altitude: [1000, 0], speed: [10, 20], heading: [179, -179], downrange: [0, 5] },
} as unknown as Flight;

describe('the plots', () => {
  it('are those of the thesis first, as far as the flight has them', () => {
    expect(plotted(FLIGHT.columns, ['downrange', 'speed'])).toEqual(['altitude', 'speed', 'heading', 'downrange']);
    expect(addable(FLIGHT.columns, [])).toEqual(['downrange']);
  });

  it('are against altitude as in the thesis, and altitude against time', () => {
    expect(axesOf('speed', 'thesis')).toEqual({ x: 'altitude', y: 'speed' });
    expect(axesOf('altitude', 'thesis')).toEqual({ x: 'time', y: 'altitude' });
    expect(axesOf('speed', 'speed')).toEqual({ x: 'time', y: 'speed' });
    expect(axesOf('speed', 'time')).toEqual({ x: 'time', y: 'speed' });
  });
});

describe('a curve', () => {
  it('is in the units in which it is shown', () => {
    expect(curveOf(FLIGHT, { x: 'altitude', y: 'heading' }, 'deg')).toEqual({ x: [1, 0], y: [179, -179] });
    expect(curveOf(FLIGHT, { x: 'altitude', y: 'heading' }, 'rad').y[0]).toBeCloseTo(3.1241, 4);
    expect(titleOf('heading', 'rad')).toBe('Heading, rad');
    expect(titleOf('mach', 'rad')).toBe('Mach number');
  });

  it('of the end of a corridor is of altitude and speed', () => {
    const curve = { x: [10, 20], y: [1, 0] };
    expect(bandsOf([[FLIGHT, FLIGHT]], { x: 'speed', y: 'altitude' }, 'deg')).toEqual([[curve, curve]]);
    expect(bandsOf([[FLIGHT, FLIGHT]], { x: 'time', y: 'altitude' }, 'deg')).toEqual([]);
  });

  it('of a theory has gaps where that gives no number', () => {
    const theory = {
      angle_unit: 'rad',
      predicted: {
        time: [0, 1],
        altitude: [1000, 500],
        speed: [5, null],
        flight_path_angle: [-Math.PI / 2, null],
        drag_deceleration: [1, 2],
      },
    } as unknown as Theory;
    expect(predictedOf(theory, { x: 'altitude', y: 'flight_path_angle' }, 'deg')).toEqual({ x: [1, 0.5], y: [-90, Number.NaN] });
    expect(predictedOf(theory, { x: 'altitude', y: 'deceleration' }, 'deg')?.y).toEqual([1, 2]);
    expect(predictedOf(theory, { x: 'altitude', y: 'mach' }, 'deg')).toBeNull();
  });

  it('breaks where an angle begins anew, and over nothing else', () => {
    expect(isJoined(179, -179, 'heading', 'deg')).toBe(false);
    expect(isJoined(3.1, -3.1, 'heading', 'rad')).toBe(false);
    expect(isJoined(10, 100, 'heading', 'deg')).toBe(true);
    expect(isJoined(0, 5000, 'speed', 'deg')).toBe(true);
  });
});

it('a range has every number in it and a margin, and an extent', () => {
  expect(
    rangeOf([
      [0, 50],
      [100, Number.NaN],
    ]),
  ).toEqual([-4, 104]);
  const [low, high] = rangeOf([[7, 7]]);
  expect(low).toBeLessThan(7);
  expect(high).toBeGreaterThan(7);
  expect(rangeOf([[]])).toEqual([0, 1]);
});

it('the nearest point is the nearest', () => {
  const points = [
    [0, 0],
    [10, 0],
    [Number.NaN, 0],
    [10, 10],
  ] as [number, number][];
  const find = (x: number, y: number) => nearest({ length: points.length, at: (index) => points[index] as [number, number] }, x, y);
  expect(find(9, 8)).toBe(3);
  expect(find(-5, -5)).toBe(0);
  expect(nearest({ length: 0, at: () => [0, 0] }, 0, 0)).toBe(-1);
});

it.each([
  [3, 50, [0, 1, 2]],
  [101, 3, [0, 50, 100]],
  [1, 50, [0]],
])('of %d rows at most %d are picked, the ends among them', (rows, wanted, expected) => {
  expect(picked(rows, wanted)).toEqual(expected);
});
