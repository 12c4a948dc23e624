import { type GeoProjection, geoCircle, geoDistance, geoPath } from 'd3-geo';
import { colour } from '../colours';
import { capital } from '../figures';
import { isFlying, type Run } from '../flight';
import { bodyIn, isEarth } from '../planets';
import type { ListedSite } from '../sites';
import type { TargetPlace } from '../target/place';
import { type DrawnFootprint, drawExtremes, drawFootprint } from './footprint';
import { belowSun, graticule, LAND, placeAt, ramp, stretches } from './geography';
import { drawSites } from './sites';

/** What a map shows. */
export interface Scene {
  /** The flights on the planet, the current one first, then the bodies that left it. */
  runs: Run[];
  /** What may be named as the place of a launch; on the Earth alone. */
  sites: ListedSite[];
  /** The flights that a search has found. */
  found: Run[];
  /** The place that is to be reached. */
  target: TargetPlace | null;
  /** The ground that flights reach. */
  footprint: DrawnFootprint | null;
  /** The model of the planet. */
  planet: string;
  /** The instant that is looked at, s. */
  time: number | null;
  /** When the flight begins, where the case says it. */
  epoch: Date | null;
}

/** Draws a scene by a projection: the Earth and the night, or the meridians and parallels of another planet; the tracks, the marks. */
export function drawScene(ctx: CanvasRenderingContext2D, projection: GeoProjection, scene: Scene, step: number): void {
  const path = geoPath(projection, ctx);
  const fill = (shape: Parameters<typeof path>[0], style: string) => {
    ctx.beginPath();
    path(shape);
    ctx.fillStyle = style;
    ctx.fill();
  };
  const stroke = (shape: Parameters<typeof path>[0], style: string, width: number) => {
    ctx.beginPath();
    path(shape);
    ctx.strokeStyle = style;
    ctx.lineWidth = width;
    ctx.stroke();
  };
  ctx.lineJoin = 'round';
  ctx.lineCap = 'round';
  // Of other planets neither a coast is known, nor where the sun is.
  const onEarth = isEarth(scene.planet);
  fill({ type: 'Sphere' }, colour(onEarth ? 'sea' : 'raised'));
  if (onEarth) fill(LAND, colour('land'));
  const [lambda, phi] = projection.rotate();
  stroke(graticule(step, [-lambda, -phi]), colour(onEarth ? 'line' : 'line-strong'), onEarth ? 0.6 : 0.4);
  if (onEarth) drawNight(fill, scene);
  stroke({ type: 'Sphere' }, colour('line-strong'), 1);
  if (scene.footprint) drawFootprint(ctx, path, scene.footprint);
  drawSites(ctx, projection, scene.sites);
  // Beside bodies, whose colours tell them apart, the vehicle has a colour of its own too.
  const isAlone = !scene.runs.some(({ id }) => id < 0);
  for (const run of [...scene.runs].reverse()) {
    const track = stretches(run.flight);
    if (run.id !== 0 || !isAlone) {
      const width = run.id > 0 ? 1.6 : 2.4;
      stroke({ type: 'MultiLineString', coordinates: track.map(({ places }) => places) }, colour(`run-${run.colour}`), width);
      continue;
    }
    stroke({ type: 'MultiLineString', coordinates: track.map(({ places }) => places) }, colour('surface'), 5);
    for (const { places, level } of track) stroke({ type: 'LineString', coordinates: places }, ramp(level), 3);
  }
  ctx.setLineDash([7, 4]);
  for (const run of [...scene.found].reverse()) {
    const track = stretches(run.flight);
    stroke({ type: 'MultiLineString', coordinates: track.map(({ places }) => places) }, colour(`run-${run.colour}`), 2);
  }
  ctx.setLineDash([]);
  drawMarks(ctx, projection, scene);
  for (const { flight, colour: of } of scene.found) {
    const point = seen(projection, placeAt(flight, flight.final.time ?? 0));
    if (point) dot(ctx, point, 3.5, colour(`run-${of}`), colour('surface'));
  }
  if (scene.footprint) drawExtremes(ctx, projection, scene.footprint);
  if (scene.target?.within) {
    const circle = geoCircle()
      .center(scene.target.place)
      .radius((scene.target.within / METRES) * DEGREES);
    stroke(circle(), colour('text'), 1);
  }
  if (scene.target) drawTarget(ctx, seen(projection, scene.target.place));
  if (!onEarth) drawName(ctx, bodyIn(scene.planet));
}

/** A radius of the Earth, m, by which distances are drawn, and degrees of a radian. */
const METRES = 6.371e6;
const DEGREES = 180 / Math.PI;

/** The place that is to be reached: a ring with a cross. */
function drawTarget(ctx: CanvasRenderingContext2D, point: [number, number] | null): void {
  if (!point) return;
  const [x, y] = point;
  for (const [style, width] of [
    [colour('surface'), 5],
    [colour('text'), 2],
  ] as const) {
    ctx.beginPath();
    ctx.arc(x, y, 7, 0, 2 * Math.PI);
    for (const [dx, dy] of [
      [1, 0],
      [-1, 0],
      [0, 1],
      [0, -1],
    ] as const) {
      ctx.moveTo(x + 4 * dx, y + 4 * dy);
      ctx.lineTo(x + 12 * dx, y + 12 * dy);
    }
    ctx.strokeStyle = style;
    ctx.lineWidth = width;
    ctx.stroke();
  }
}

/** The planet's name, in the corner. */
function drawName(ctx: CanvasRenderingContext2D, name: string): void {
  ctx.font = '600 13px system-ui, sans-serif';
  ctx.textAlign = 'left';
  ctx.textBaseline = 'alphabetic';
  ctx.fillStyle = colour('muted');
  ctx.fillText(capital(name), 8, ctx.canvas.clientHeight - 8);
}

/** The half of the Earth on which the sun does not shine. */
function drawNight(fill: (shape: ReturnType<ReturnType<typeof geoCircle>>, style: string) => void, { epoch, time, runs }: Scene): void {
  if (!epoch) return;
  const seconds = time ?? runs[0]?.flight.final.time ?? 0;
  const [longitude, latitude] = belowSun(new Date(epoch.getTime() + seconds * 1e3));
  fill(
    geoCircle()
      .center([longitude + 180, -latitude])
      .radius(90)(),
    'rgb(10 20 50 / 22%)',
  );
}

/** So many labels stand below each other; further ones are left to the list. */
const MOST_LABELS = 2;

function drawMarks(ctx: CanvasRenderingContext2D, projection: GeoProjection, { runs, time }: Scene): void {
  const taken: [number, number][] = [];
  const nearTo = (point: [number, number]) => taken.filter(([x, y]) => Math.abs(x - point[0]) < 110 && Math.abs(y - point[1]) < 18).length;
  // The ends of bodies have their labels before the marks of the vehicle.
  for (const run of [...runs].sort((a, b) => Number(a.id >= 0) - Number(b.id >= 0))) {
    if (run.id === 0) {
      const places = run.flight.marks.filter(isPlaced).map((mark) => ({ mark, point: seen(projection, placeAt(run.flight, mark.time)) }));
      // Of labels in each other's way the end has its own, a second goes below its mark, a third is left to the list.
      for (const { mark, point } of [...places].reverse()) {
        if (!point) continue;
        const near = nearTo(point);
        if (near < MOST_LABELS) label(ctx, [point[0], point[1] + 18 * near], mark.label);
        taken.push(point);
      }
      for (const { mark, point } of places)
        if (point) dot(ctx, point, 4.5, mark.kind === 'end' ? colour('bad') : colour('surface'), colour('text'));
    } else {
      const point = seen(projection, placeAt(run.flight, run.flight.final.time ?? 0));
      if (point) dot(ctx, point, 3.5, colour(`run-${run.colour}`), colour('surface'));
      if (point && run.id < 0) {
        const near = nearTo(point);
        if (near < MOST_LABELS) label(ctx, [point[0], point[1] + 18 * near], run.label);
        taken.push(point);
      }
    }
    const isThere = time !== null && (run.id >= 0 || isFlying(run.flight, time));
    const now = isThere ? seen(projection, placeAt(run.flight, time)) : null;
    if (now) dot(ctx, now, 5.5, colour(`run-${run.colour}`), colour('surface'));
  }
}

/** Marks that have a place of their own: not the peaks, but the maximum altitude. */
export function isPlaced({ kind, label }: { kind: string; label: string }): boolean {
  return kind !== 'peak' || label === 'maximum altitude';
}

/** Where a place is on the screen; null where it is on the far side. */
export function seen(projection: GeoProjection, place: [number, number]): [number, number] | null {
  const clip = projection.clipAngle();
  if (clip) {
    const [lambda, phi] = projection.rotate();
    if (geoDistance(place, [-lambda, -phi]) > (clip * Math.PI) / 180) return null;
  }
  return projection(place);
}

function dot(ctx: CanvasRenderingContext2D, [x, y]: [number, number], radius: number, inside: string, outside: string): void {
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.fillStyle = inside;
  ctx.strokeStyle = outside;
  ctx.lineWidth = 1.5;
  ctx.fill();
  ctx.stroke();
}

function label(ctx: CanvasRenderingContext2D, [x, y]: [number, number], text: string): void {
  ctx.font = '12px system-ui, sans-serif';
  const width = ctx.measureText(text).width;
  const isRight = x + 10 + width < ctx.canvas.clientWidth;
  ctx.textAlign = isRight ? 'left' : 'right';
  ctx.textBaseline = 'middle';
  ctx.strokeStyle = colour('surface');
  ctx.lineWidth = 3;
  const at = isRight ? x + 9 : x - 9;
  ctx.strokeText(text, at, y);
  ctx.fillStyle = colour('text');
  ctx.fillText(text, at, y);
}
