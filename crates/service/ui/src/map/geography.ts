import { type GeoPermissibleObjects, geoGraticule, geoInterpolate } from 'd3-geo';
import { feature } from 'topojson-client';
import type { GeometryCollection, Topology } from 'topojson-specification';
import land110 from 'world-atlas/land-110m.json';
import { at, type Flight, wrapped } from '../flight';

const topology = land110 as unknown as Topology<{ land: GeometryCollection }>;

/** The land of the Earth, of Natural Earth at 1:110 million. */
export const LAND: GeoPermissibleObjects = feature(topology, topology.objects.land);

/** So many steps of meridians and parallels are in sight, to either side of the middle of a map. */
const IN_SIGHT = 25;

/** Meridians and parallels so many degrees apart; of fine ones those around a place. */
export function graticule(step: number, [longitude, latitude]: Place): GeoPermissibleObjects {
  const lines = geoGraticule().step([step, step]);
  if (step >= 10) return lines();
  const [low, high] = [Math.max(latitude - IN_SIGHT * step, -90), Math.min(latitude + IN_SIGHT * step, 90)];
  const widest = Math.cos((Math.max(-low, high) * Math.PI) / 180);
  const half = Math.min((IN_SIGHT * step) / Math.max(widest, 1e-3), 180);
  return lines.extent([
    [longitude - half, low],
    [longitude + half, high],
  ])();
}

/** A place: longitude and latitude, degrees. */
export type Place = [number, number];

/** Where a flight is at an instant. */
export function placeAt(flight: Flight, time: number): Place {
  return [wrapped(at(flight, 'longitude', time)), at(flight, 'geodetic_latitude', time)];
}

/** A stretch of a track whose altitudes are alike. */
export interface Stretch {
  places: Place[];
  /** From 0, the lowest of the flight, to 1, the highest. */
  level: number;
}

const LEVELS = 32;

/** The ground track in stretches of like altitude, each beginning where the one before it ends. */
export function stretches(flight: Flight): Stretch[] {
  const { longitude = [], geodetic_latitude: latitude = [], altitude = [] } = flight.columns;
  const [low, high] = extent(altitude);
  const levelOf = (index: number) => Math.round((((altitude[index] ?? low) - low) / (high - low || 1)) * (LEVELS - 1)) / (LEVELS - 1);
  const found: Stretch[] = [];
  for (let index = 1; index < longitude.length; index += 1) {
    const from: Place = [longitude[index - 1] as number, latitude[index - 1] as number];
    const to: Place = [longitude[index] as number, latitude[index] as number];
    const level = levelOf(index);
    const last = found.at(-1);
    if (last?.level === level) last.places.push(to);
    else found.push({ places: [from, to], level });
  }
  return found;
}

/** The least and the greatest of a list; 0 and 0 of an empty one. */
export function extent(values: number[]): [number, number] {
  return values.length === 0
    ? [0, 0]
    : values.reduce(
        ([low, high], value) => [Math.min(low, value), Math.max(high, value)],
        [Number.POSITIVE_INFINITY, Number.NEGATIVE_INFINITY],
      );
}

/** The place in the middle of a track. */
export function middleOf(flight: Flight): Place {
  const [first, last] = [flight.columns.time[0] ?? 0, flight.columns.time.at(-1) ?? 0];
  return geoInterpolate(placeAt(flight, first), placeAt(flight, last))(0.5);
}

/** A colour of viridis' kind, dark and blue where it is low, light and yellow where it is high. */
export function ramp(level: number): string {
  const stops = [
    [68, 1, 84],
    [59, 82, 139],
    [33, 145, 140],
    [94, 201, 98],
    [234, 200, 40],
  ] as const;
  const place = Math.min(Math.max(level, 0), 1) * (stops.length - 1);
  const index = Math.min(Math.floor(place), stops.length - 2);
  const part = place - index;
  const mixed = [0, 1, 2].map((channel) =>
    Math.round((stops[index]?.[channel] ?? 0) * (1 - part) + (stops[index + 1]?.[channel] ?? 0) * part),
  );
  return `rgb(${mixed.join(' ')})`;
}

/** A place as other tools take it: latitude, longitude, in decimal degrees. */
export function written([longitude, latitude]: Place): string {
  return `${latitude.toFixed(5)}, ${wrapped(longitude).toFixed(5)}`;
}

/**
 * The place below the sun at an instant, within some 0.01° from 1950 to 2050: the low-precision formulas of the Astronomical Almanac,
 * page C5, and the Greenwich mean sidereal time.
 */
export function belowSun(instant: Date): Place {
  const days = instant.getTime() / 86_400_000 - 10_957.5;
  const radians = Math.PI / 180;
  const longitude = 280.46 + 0.985_647_4 * days;
  const anomaly = (357.528 + 0.985_600_3 * days) * radians;
  const ecliptic = (longitude + 1.915 * Math.sin(anomaly) + 0.02 * Math.sin(2 * anomaly)) * radians;
  const obliquity = (23.439 - 4e-7 * days) * radians;
  const ascension = Math.atan2(Math.cos(obliquity) * Math.sin(ecliptic), Math.cos(ecliptic)) / radians;
  const declination = Math.asin(Math.sin(obliquity) * Math.sin(ecliptic)) / radians;
  return [wrapped(ascension - (280.460_618_37 + 360.985_647_366_29 * days)), declination];
}
