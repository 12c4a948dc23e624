import { type GeoPermissibleObjects, geoContains } from 'd3-geo';
import type { Footprint } from '../api';
import type { Place } from '../map/geography';

type Boundary = Footprint['boundary'];

/** The ground of a boundary, as d3 has polygons: the inside is to the right of a ring, and not to the left as in GeoJSON. */
export function groundOf({ coordinates }: Boundary): GeoPermissibleObjects {
  return { type: 'MultiPolygon', coordinates: coordinates.map((polygon) => polygon.map((ring) => [...ring].reverse())) };
}

/** The edges of a boundary, without those along which it is cut: the antimeridian, and the poles of a map. */
export function edgesOf({ coordinates }: Boundary): Place[][] {
  const edges: Place[][] = [];
  for (const ring of coordinates.flat() as Place[][]) {
    let edge: Place[] = [];
    ring.forEach((place, index) => {
      const before = ring[index - 1];
      if (before && isCut(before, place)) {
        edges.push(edge);
        edge = [];
      }
      edge.push(place);
    });
    edges.push(edge);
  }
  return edges.filter(({ length }) => length > 1);
}

/** How near, degrees, a place is to a line of a map that is on it. */
const ON = 1e-9;

/** Whether a piece of a ring runs along the antimeridian or a pole. */
function isCut([lon0, lat0]: Place, [lon1, lat1]: Place): boolean {
  const isAlong = (a: number, b: number, end: number) => Math.abs(a) > end - ON && Math.abs(b) > end - ON;
  return (isAlong(lon0, lon1, 180) && lon0 * lon1 > 0) || (isAlong(lat0, lat1, 90) && lat0 * lat1 > 0);
}

/** The points of a footprint between which a map shows it whole. */
export function pointsOf({ boundary, curve }: Footprint): Place[] {
  return [...boundary.coordinates.flat(2), ...(curve?.coordinates ?? []).flat()] as Place[];
}

/** Those of some sites that are on the ground of a boundary. */
export function within<T extends { longitude: number; geodetic_latitude: number }>(boundary: Boundary, sites: T[]): T[] {
  if (boundary.coordinates.length === 0) return [];
  const ground = groundOf(boundary);
  return sites.filter(({ longitude, geodetic_latitude }) => geoContains(ground, [longitude, geodetic_latitude]));
}
