import { type GeoPath, type GeoPermissibleObjects, type GeoProjection, geoCentroid } from 'd3-geo';
import { turned } from '../case';
import { colour } from '../colours';
import { kilometres } from '../figures';
import { edgesOf, groundOf, pointsOf } from '../footprint/ground';
import type { Reached } from '../footprint/live';
import { extremesOf } from '../footprint/words';
import { modelOf } from '../planets';
import { extent, type Place } from './geography';
import { seen } from './view';

/** A footprint as maps draw it. */
export interface DrawnFootprint {
  /** The model of its planet. */
  planet: string;
  ground: GeoPermissibleObjects;
  edge: GeoPermissibleObjects;
  /** The edge of what is reached without limits. */
  wide: GeoPermissibleObjects | null;
  /** Where flights land with one free number. */
  curve: GeoPermissibleObjects | null;
  extremes: Extreme[];
  /** Between which all of it is seen. */
  points: Place[];
}

/** An extreme landing. */
interface Extreme {
  text: string;
  place: Place;
}

/** A footprint as maps draw it. */
export function drawnOf({ asked, answer, wide }: Reached): DrawnFootprint {
  const { angle_unit: unit, curve } = answer;
  return {
    planet: modelOf(asked),
    ground: groundOf(answer.boundary),
    edge: linesOf(edgesOf(answer.boundary)),
    wide: wide && linesOf(wide.curve ? (wide.curve.coordinates as Place[][]) : edgesOf(wide.boundary)),
    curve: curve && linesOf(curve.coordinates as Place[][]),
    extremes: extremesOf(answer).map(({ label, value, site }) => ({
      text: `${label}: ${kilometres(value, 4)} km`,
      place: [site.longitude, site.geodetic_latitude].map((angle) => turned(angle, unit, 'deg')) as Place,
    })),
    points: [...pointsOf(answer), ...(wide ? pointsOf(wide) : [])],
  };
}

const linesOf = (lines: Place[][]): GeoPermissibleObjects => ({ type: 'MultiLineString', coordinates: lines });

/** Draws the ground that is reached: filled lightly, with its edge, and that without limits as a dashed edge. */
export function drawFootprint(ctx: CanvasRenderingContext2D, path: GeoPath, { ground, edge, wide, curve }: DrawnFootprint): void {
  const stroke = (shape: GeoPermissibleObjects, style: string, width: number) => {
    ctx.beginPath();
    path(shape);
    ctx.strokeStyle = style;
    ctx.lineWidth = width;
    ctx.stroke();
  };
  ctx.beginPath();
  path(ground);
  ctx.globalAlpha = 0.22;
  ctx.fillStyle = colour('footprint');
  ctx.fill();
  ctx.globalAlpha = 1;
  if (wide) {
    ctx.setLineDash([5, 5]);
    stroke(wide, colour('footprint'), 1.2);
    ctx.setLineDash([]);
  }
  for (const shape of [edge, curve]) {
    if (!shape) continue;
    stroke(shape, colour('surface'), 3.5);
    stroke(shape, colour('footprint'), 1.8);
  }
}

/** Draws the extreme landings as diamonds. */
export function drawExtremes(ctx: CanvasRenderingContext2D, projection: GeoProjection, { extremes }: DrawnFootprint): void {
  const size = 5.5;
  for (const { place } of extremes) {
    const point = seen(projection, place);
    if (!point) continue;
    const [x, y] = point;
    ctx.beginPath();
    ctx.moveTo(x, y - size);
    ctx.lineTo(x + size, y);
    ctx.lineTo(x, y + size);
    ctx.lineTo(x - size, y);
    ctx.closePath();
    ctx.fillStyle = colour('surface');
    ctx.strokeStyle = colour('footprint');
    ctx.lineWidth = 2;
    ctx.fill();
    ctx.stroke();
  }
}

/** How near, in pixels, a pointer is to an extreme landing that it means. */
const NEAR = 9;

/** What a point of the screen says of an extreme landing; several where they are in one place. */
export function extremeAt(projection: GeoProjection, footprint: DrawnFootprint | null, [x, y]: [number, number]): string[] {
  return (footprint?.extremes ?? []).flatMap(({ text, place }) => {
    const point = seen(projection, place);
    return point && Math.hypot(point[0] - x, point[1] - y) < NEAR ? [text] : [];
  });
}

/** Between the footprint and the ends of the map, pixels, and the share of its width or height below which it is too small. */
const FIT = { margin: 44, least: 0.55 };

/**
 * Fits a projection to a footprint. As long as that fills what `before` shows well, it stands still: so it does not jump while the
 * footprint changes. The projection's rotation, scale and translation are returned, to be the next one's `before`.
 */
export function fitFootprint(
  projection: GeoProjection,
  points: Place[],
  { width, height, before }: { width: number; height: number; before: Fit | null },
): Fit {
  if (before?.width === width && before.height === height) {
    projection.rotate(before.rotate).scale(before.scale).translate(before.translate);
    if (isWellSeen(projection, points, before)) return before;
  }
  const middle = geoCentroid({ type: 'MultiPoint', coordinates: points });
  projection.rotate([-middle[0], -middle[1]]);
  projection.fitExtent(
    [
      [FIT.margin, FIT.margin],
      [width - FIT.margin, height - FIT.margin],
    ],
    { type: 'MultiPoint', coordinates: points },
  );
  // A footprint of one place is not blown up to nothing but itself.
  projection.scale(Math.min(projection.scale(), MOST_PER_RADIAN));
  const [rotate, scale, translate] = [projection.rotate(), projection.scale(), projection.translate()];
  return { rotate, scale, translate, width, height };
}

/** Pixels of a radian at most: some 20 km are seen. */
const MOST_PER_RADIAN = 2e5;

export interface Fit {
  rotate: [number, number, number];
  scale: number;
  translate: [number, number];
  width: number;
  height: number;
}

function isWellSeen(projection: GeoProjection, points: Place[], { width, height }: Fit): boolean {
  const places = points.map((place): Place => projection(place) ?? [Number.NaN, Number.NaN]);
  const [[x0, x1], [y0, y1]] = [extent(places.map(([x]) => x)), extent(places.map(([, y]) => y))];
  const isInside = x0 > 8 && y0 > 8 && x1 < width - 8 && y1 < height - 8;
  return isInside && ((x1 - x0) / width > FIT.least || (y1 - y0) / height > FIT.least);
}
