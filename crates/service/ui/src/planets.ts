import schema from 'virtual:schema';
import type { Case } from './api';
import type { Run } from './flight';

const TITLES = schema.PlanetModel?.['x-titles'] ?? {};

/** The model of the planet of a case: the default where it says none. */
export function modelOf({ planet }: Case): string {
  return String(planet?.model ?? schema.Planet?.properties?.model?.default ?? '');
}

/** Whether a model is one of the Earth. */
export function isEarth(model: string): boolean {
  return model.startsWith('earth_');
}

/** Whether a model is a body with a standard atmosphere of its own, or with none, such as the Moon. */
export function isBody(model: string): boolean {
  return !isEarth(model) && model !== 'custom' && Object.hasOwn(TITLES, model);
}

/** What a planet is called in a sentence. */
export function bodyIn(model: string): string {
  if (isEarth(model)) return 'the Earth';
  if (model === 'custom') return 'a custom planet';
  return titleOfModel(model) === 'Moon' ? 'the Moon' : titleOfModel(model);
}

/** The label of a model. */
export function titleOfModel(model: string): string {
  return Object.hasOwn(TITLES, model) ? (TITLES[model] as string) : model;
}

/** The planet on which a flight is. */
export function planetOf(run: Run): string {
  return run.flight.answer.models.planet;
}

/** Whether the places of two models are on the same ground: all Earths have one. */
export function isSameGround(a: string, b: string): boolean {
  return a === b || (isEarth(a) && isEarth(b));
}

/** What an atmosphere is called that is that of the Earth, whatever the planet; null of others, whose numbers the case gives. */
export function airOfEarth(atmosphere: Case['atmosphere']): string | null {
  switch (atmosphere?.type) {
    case 'us76':
      return 'U.S. Standard Atmosphere 1976';
    case 'nrlmsise00':
      return 'NRLMSISE-00';
    case 'exponential':
      return atmosphere.surface_density === undefined || atmosphere.scale_height === undefined
        ? 'exponential atmosphere of the thesis'
        : null;
    case 'layered_exponential':
      return atmosphere.preset === undefined ? null : "layered atmosphere of the Earth's air";
    default:
      return null;
  }
}

/** Why a case has no Orbit Ephemeris Message, which the service then refuses; null where it has one. */
export function whyNoOem(flight: Case): string | null {
  const model = modelOf(flight);
  if (!isEarth(model) && model !== 'mars') return `OEM: the standard names no frame of ${bodyIn(model)}.`;
  return flight.epoch ? null : 'OEM: requires an epoch.';
}

/** The formats of maps that place a flight on the globe of its planet; the service refuses the others. */
export function hasGlobe(format: string, model: string): boolean {
  if (format === 'kml') return isEarth(model) || ['custom', 'mars', 'moon'].includes(model);
  if (format === 'czml') return isEarth(model) || model === 'custom';
  return true;
}
