import type { Schemas } from '../api';
import { turned } from '../case';
import { isEarth, modelOf } from '../planets';
import type { ListedSite } from '../sites';
import { caseUnit, draft } from '../store';

export type Launch = Schemas['Launch'];

/** Whether the case begins with a launch. */
export function isLaunch(): boolean {
  return draft.value.initial_state?.type === 'launch';
}

/** Puts the launch at a site. */
export function launchFrom(slug: string): void {
  replace({ site: slug as NonNullable<Launch['site']> });
}

/** Puts the launch at a place, in degrees; at the surface, unless an altitude, m, is given. */
export function launchAt(latitude: number, longitude: number, altitude = 0): void {
  const place = { geodetic_latitude: inCase(latitude), longitude: inCase(longitude) };
  replace(altitude === 0 ? place : { ...place, geodetic_altitude: altitude });
}

/** What a launch begins with: a site where there are some, or a place. */
export function firstLaunch(): Launch {
  const place = isEarth(modelOf(draft.peek())) ? { site: 'ksc_lc39a' as const } : { geodetic_latitude: 0, longitude: 0 };
  return { type: 'launch', ...place, azimuth: inCase(90) };
}

/** The state at rest where a launch begins, at the place of its site. */
export function atRest({ geodetic_latitude, longitude, geodetic_altitude, azimuth = 0 }: Launch, site: ListedSite | undefined) {
  return {
    type: 'geodetic' as const,
    geodetic_altitude: geodetic_altitude ?? site?.geodetic_altitude ?? 0,
    longitude: longitude ?? inCase(site?.longitude ?? 0),
    geodetic_latitude: geodetic_latitude ?? inCase(site?.geodetic_latitude ?? 0),
    speed: 0,
    flight_path_angle: 0,
    azimuth,
  };
}

const inCase = (degrees: number) => turned(degrees, 'deg', caseUnit.peek()) as number;

/** Another place; all else of the launch stays. */
function replace(place: Partial<Launch>): void {
  const { site: _, geodetic_latitude: __, longitude: ___, geodetic_altitude: ____, type, ...others } = draft.peek().initial_state as Launch;
  draft.value = { ...draft.peek(), initial_state: { type, ...place, ...others } };
}
