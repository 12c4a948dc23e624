import { expect, it } from 'vitest';
import type { Flight } from '../../src/flight';
import { belowSun, extent, middleOf, placeAt, ramp, stretches, written } from '../../src/map/geography';

/** A track along the equator, across the antimeridian, downwards. */
const FLIGHT = {
  columns: { time: [0, 10, 20, 30], longitude: [170, 178, -176, -170], geodetic_latitude: [0, 0, 0, 0], altitude: [90e3, 60e3, 30e3, 0] },
} as unknown as Flight;

it('a track is in stretches that follow each other, coloured from the highest to the lowest', () => {
  const found = stretches(FLIGHT);
  expect(found.map(({ places }) => places[0])).toEqual([
    [170, 0],
    [178, 0],
    [-176, 0],
  ]);
  expect(found.map(({ places }) => places.at(-1))).toEqual([
    [178, 0],
    [-176, 0],
    [-170, 0],
  ]);
  expect(found.map(({ level }) => level)).toEqual([expect.closeTo(2 / 3, 1), expect.closeTo(1 / 3, 1), 0]);
});

it('rows of like altitude are one stretch', () => {
  const level = { columns: { ...FLIGHT.columns, altitude: [5, 5, 5, 5] } } as unknown as Flight;
  expect(stretches(level)).toHaveLength(1);
});

it('a place between two rows goes over the antimeridian', () => {
  expect(placeAt(FLIGHT, 15)[0]).toBeCloseTo(-179, 9);
  expect(Math.abs(middleOf(FLIGHT)[0])).toBeCloseTo(180, 9);
});

it('colours go from dark to light', () => {
  const brightness = (level: number) =>
    (ramp(level).match(/\d+/g) ?? []).reduce((sum, value, index) => sum + Number(value) * ([0.21, 0.72, 0.07][index] ?? 0), 0);
  for (let step = 0; step < 10; step += 1) expect(brightness((step + 1) / 10)).toBeGreaterThan(brightness(step / 10));
  expect(ramp(-1)).toBe(ramp(0));
  expect(ramp(2)).toBe(ramp(1));
});

it('a place is written as other tools take it', () => {
  expect(written([-190.000004, 34.955116])).toBe('34.95512, 170.00000');
});

it('the extent of nothing is nothing', () => {
  expect(extent([])).toEqual([0, 0]);
  expect(extent([3, -1, 2])).toEqual([-1, 3]);
});

// Astronomical facts: the declination at equinoxes and solstices, and the equation of time, which is published to the second.
it.each([
  ['2026-03-20T14:46:00Z', 0],
  ['2026-06-21T08:24:00Z', 23.436],
  ['2026-09-23T00:05:00Z', 0],
  ['2026-12-21T20:50:00Z', -23.436],
])('at %s the sun is over latitude %d', (instant, latitude) => {
  expect(belowSun(new Date(instant))[1]).toBeCloseTo(latitude, 1);
});

it('around the third of November the sun is 16.4 minutes ahead of the clock, around the eleventh of February 14.2 behind', () => {
  // 4 minutes a degree: at noon of Greenwich it is over 4.1° W, or 3.55° E.
  expect(belowSun(new Date('2026-11-03T12:00:00Z'))[0]).toBeCloseTo(-16.4 / 4, 1);
  expect(belowSun(new Date('2026-02-11T12:00:00Z'))[0]).toBeCloseTo(14.2 / 4, 1);
});
