import schema from 'virtual:schema';
import { expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { airOfEarth, bodyIn, hasGlobe, isBody, isEarth, isSameGround, modelOf, whyNoOem } from '../../src/planets';

const MODELS = schema.PlanetModel?.enum ?? [];

it('every model is an Earth, a body, or custom', () => {
  expect(MODELS.length).toBeGreaterThan(4);
  for (const model of MODELS) expect([isEarth(model), isBody(model), model === 'custom'].filter(Boolean)).toHaveLength(1);
  expect(isBody('toString')).toBe(false);
  expect(modelOf({} as Case)).toBe('earth_wgs84');
  expect(modelOf({ planet: { model: 'mars' } } as Case)).toBe('mars');
});

it('planets have names in sentences', () => {
  expect(['earth_jameson_text', 'mars', 'moon', 'custom'].map(bodyIn)).toEqual(['the Earth', 'Mars', 'the Moon', 'a custom planet']);
});

it('all Earths have one ground, other planets their own', () => {
  expect(isSameGround('earth_wgs84', 'earth_jameson_text')).toBe(true);
  expect(isSameGround('mars', 'mars')).toBe(true);
  expect(isSameGround('mars', 'earth_wgs84')).toBe(false);
  expect(isSameGround('custom', 'earth_wgs84')).toBe(false);
});

it.each<[Case['atmosphere'], boolean]>([
  [undefined, false],
  [{ type: 'us76' }, true],
  [{ type: 'exponential' }, true],
  [{ type: 'exponential', scale_height: 11000 }, true],
  [{ type: 'exponential', surface_density: 0.02, scale_height: 11000 }, false],
  [{ type: 'layered_exponential', preset: 'earth_seven_layer' }, true],
  [{ type: 'layered_exponential', layers: [] }, false],
  [{ type: 'standard' }, false],
  [{ type: 'vacuum' }, false],
])('the air of %j is that of the Earth: %s', (atmosphere, isOfEarth) => {
  expect(airOfEarth(atmosphere) !== null).toBe(isOfEarth);
});

it.each([
  [{ epoch: '2026-11-22T12:00:00Z' }, null],
  [{ epoch: '2026-11-22T12:00:00Z', planet: { model: 'mars' } }, null],
  [{}, 'OEM: requires an epoch.'],
  [{ epoch: '2026-11-22T12:00:00Z', planet: { model: 'moon' } }, 'OEM: the standard names no frame of the Moon.'],
  [{ planet: { model: 'custom' } }, 'OEM: the standard names no frame of a custom planet.'],
])('of %j there is no OEM because: %s', (flight, why) => {
  expect(whyNoOem(flight as Case)).toBe(why);
});

it('a map is offered where viewers have a globe', () => {
  const offered = (model: string) => ['csv', 'json', 'geojson', 'kml', 'czml'].filter((format) => hasGlobe(format, model)).length;
  expect(['earth_wgs84', 'custom', 'mars', 'moon', 'titan'].map(offered)).toEqual([5, 5, 4, 4, 3]);
});
