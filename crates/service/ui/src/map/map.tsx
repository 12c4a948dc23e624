import { computed, effect, useComputed, useSignal } from '@preact/signals';
import { type GeoProjection, geoAzimuthalEquidistant, geoCentroid, geoDistance, geoEquirectangular, geoOrthographic } from 'd3-geo';
import { useEffect, useRef } from 'preact/hooks';
import { copied } from '../clipboard';
import { onTheme } from '../colours';
import { kilometres, number } from '../figures';
import { at, endOf, type Flight, type Run, withBodies } from '../flight';
import { within } from '../footprint/ground';
import { reached, sitesWithin } from '../footprint/live';
import { isLaunch, launchAt, launchFrom } from '../form/launch';
import { bodyIn, isEarth, isSameGround, modelOf, planetOf } from '../planets';
import { type ListedSite, loadSites, sites, titleOfSite } from '../sites';
import { current, cursor, draft, runs, tracks } from '../store';
import { aimAt, isAiming, targetPlace } from '../target/place';
import { found } from '../target/solve';
import { drawnOf, extremeAt, type Fit, fitFootprint } from './footprint';
import { extent, middleOf, type Place, placeAt, ramp, written } from './geography';
import { siteAt } from './sites';
import { drawScene, isPlaced, type Scene, seen } from './view';
import './map.css';

const footprint = computed(() => reached.value && drawnOf(reached.value));

effect(() => {
  const shown = reached.value;
  const landing = shown && isEarth(modelOf(shown.asked)) ? sites.value.filter(({ kind }) => kind !== 'launch') : [];
  sitesWithin.value = shown ? within(shown.answer.boundary, landing) : [];
});

const scene = computed<Scene>(() => {
  const instant = Date.parse(draft.value.epoch ?? '');
  const planet = current.value ? planetOf(current.value) : '';
  const here = tracks.value.filter((run) => isSameGround(planetOf(run), planet));
  return {
    runs: here,
    sites: isEarth(planet) ? sites.value : [],
    found: found.value?.runs ?? [],
    target: targetPlace(draft.value),
    footprint: footprint.value && isSameGround(footprint.value.planet, planet) ? footprint.value : null,
    planet,
    time: cursor.value,
    epoch: Number.isNaN(instant) ? null : new Date(instant),
  };
});

/** The ground track, on a map of the planet and on a globe. */
export default function Maps() {
  const view = useSignal<View>('world');
  const isPicking = useSignal(false);
  const hasTarget = useComputed(() => targetPlace(draft.value) !== null).value;
  const hasFootprint = useComputed(() => (scene.value.footprint?.points.length ?? 0) > 0).value;
  useEffect(loadSites, []);
  // On a map of the world a footprint is hardly seen.
  useEffect(() => {
    if (hasFootprint && view.peek() === 'world') view.value = 'footprint';
    if (!hasFootprint && view.peek() === 'footprint') view.value = 'world';
  }, [hasFootprint]);
  const run = current.value;
  if (!run) return null;
  const views: View[] = [
    'track',
    ...(run.flight.bodies.length > 0 ? ['bodies' as const] : []),
    ...(hasTarget ? ['target' as const] : []),
    ...(hasFootprint ? ['footprint' as const] : []),
  ];
  return (
    <section class="panel" aria-label="Ground track">
      <div class="panel-head">
        <h2>{`Ground track on ${bodyIn(planetOf(run))}`}</h2>
        {views.map((which) => (
          <button
            key={which}
            type="button"
            aria-pressed={view.value === which}
            onClick={() => {
              view.value = view.value === which ? 'world' : which;
            }}
          >
            Zoom to {which}
          </button>
        ))}
        {isLaunch() && (
          <button
            type="button"
            aria-pressed={isPicking.value}
            onClick={() => {
              isPicking.value = !isPicking.value;
            }}
          >
            Pick launch place
          </button>
        )}
        <Legend run={run} />
      </div>
      <div class="maps">
        <World
          view={view.value === 'world' || views.includes(view.value) ? view.value : 'track'}
          isPicking={isPicking.value && isLaunch()}
        />
        <Globe />
      </div>
      <Ground planet={planetOf(run)} />
      <Places run={run} />
    </section>
  );
}

/** The sources of the sites, as their licence asks. */
const SOURCES = 'Sites: General Catalog of Artificial Space Objects (J. McDowell, planet4589.org, CC BY 4.0), OurAirports and others.';

/** What is on the map and from where; what is not: the surface of another planet, and flights elsewhere. */
function Ground({ planet }: { planet: string }) {
  const elsewhere = runs.value.filter((run) => !isSameGround(planetOf(run), planet)).length;
  const lines = [
    isEarth(planet)
      ? SOURCES
      : `There is no picture of ${bodyIn(planet)}: meridians and parallels only. Longitudes are positive to the east.`,
    elsewhere === 0 ? '' : `${elsewhere === 1 ? 'A pinned flight is' : `${elsewhere} pinned flights are`} on another planet and not shown.`,
  ].filter(Boolean);
  return lines.length === 0 ? null : <p class="quiet">{lines.join(' ')}</p>;
}

/** A canvas that is drawn anew where the scene, the theme or its size changes, at most once a frame. */
function useCanvas(draw: (ctx: CanvasRenderingContext2D, width: number, height: number, scene: Scene) => void, dependencies: unknown[]) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const redraw = useRef<() => void>(() => {});
  useEffect(() => {
    const element = canvas.current;
    const ctx = element?.getContext('2d');
    if (!element || !ctx) return;
    let frame = 0;
    const paint = () => {
      frame = 0;
      const { clientWidth: width, clientHeight: height } = element;
      if (width === 0) return;
      element.width = width * devicePixelRatio;
      element.height = height * devicePixelRatio;
      ctx.scale(devicePixelRatio, devicePixelRatio);
      draw(ctx, width, height, scene.peek());
    };
    const ask = () => {
      if (!frame) frame = requestAnimationFrame(paint);
    };
    redraw.current = ask;
    const sizes = new ResizeObserver(ask);
    sizes.observe(element);
    const ends = [
      effect(() => {
        void scene.value;
        ask();
      }),
      onTheme(ask),
    ];
    return () => {
      cancelAnimationFrame(frame);
      sizes.disconnect();
      for (const end of ends) end();
    };
  }, dependencies);
  return { canvas, redraw };
}

/** What the track is, for those who do not see it. */
function summaryOf(run: Run): string {
  const { final } = run.flight;
  const [from, to] = [placeAt(run.flight, 0), placeAt(run.flight, final.time ?? 0)];
  const range = final.downrange === undefined ? '' : `, ${number(final.downrange / 1e3, 5)} km`;
  return `from ${written(from)} to ${written(to)}${range}`;
}

function World({ view, isPicking }: { view: View; isPicking: boolean }) {
  const pointed = useSignal<Pointed | null>(null);
  const isDragged = useRef(false);
  const wasDragged = useRef(false);
  const sight = useRef<Sight | null>(null);
  const fit = useRef<Fit | null>(null);
  const projection = useRef<GeoProjection>(geoEquirectangular());
  const { canvas, redraw } = useCanvas(
    (ctx, width, height, shown) => {
      const flight = shown.runs[0]?.flight;
      // Around the middle of the track, where a pole is a place like others.
      const near = view !== 'world' ? geoAzimuthalEquidistant() : geoEquirectangular();
      if (view === 'target' && shown.target) {
        // It stands still while the target is dragged.
        if (!isDragged.current || !sight.current) sight.current = sightOf(shown.target.place, shown);
        const { middle, radius } = sight.current;
        near
          .rotate([-middle[0], -middle[1]])
          .translate([width / 2, height / 2])
          .scale(Math.min(width, height) / 2 / ((radius * Math.PI) / 180));
      } else if (view === 'footprint' && shown.footprint) {
        fit.current = fitFootprint(near, shown.footprint.points, { width, height, before: fit.current });
      } else if (view !== 'world' && flight) {
        const places = placesOf(shown.runs, view);
        const middle = view === 'bodies' ? geoCentroid({ type: 'MultiPoint', coordinates: places }) : middleOf(flight);
        const [longitude, latitude] = middle;
        near.rotate([-longitude, -latitude]);
        const margin = 40;
        near.fitExtent(
          [
            [margin, margin],
            [width - margin, height - margin],
          ],
          { type: 'MultiPoint', coordinates: [...places, ...around(middle)] },
        );
      } else near.fitSize([width, height], { type: 'Sphere' });
      if (view !== 'world') clipToSight(near, width, height);
      projection.current = near;
      const degrees = width / ((near.scale() * Math.PI) / 180);
      drawScene(ctx, near, shown, degrees > 150 ? 30 : degrees > 40 ? 10 : degrees > 10 ? 2 : degrees > 2 ? 0.5 : 0.1);
    },
    [view],
  );
  const run = current.value;
  return (
    <div class="world-frame">
      <canvas
        ref={canvas}
        class={isPicking || isAiming.value ? 'world picking' : 'world'}
        role="img"
        aria-label={
          run ? `${isEarth(planetOf(run)) ? 'World map' : `Map of ${bodyIn(planetOf(run))}`} with the track ${summaryOf(run)}` : 'World map'
        }
        onTouchStart={(event) => {
          // A finger on the target drags it, and not the page.
          const { left, top } = event.currentTarget.getBoundingClientRect();
          const touch = event.touches[0];
          if (touch && isOnTarget(projection.current, [touch.clientX - left, touch.clientY - top])) event.preventDefault();
        }}
        onPointerDown={(event) => {
          if (event.button !== 0 || !isOnTarget(projection.current, [event.offsetX, event.offsetY])) return;
          event.currentTarget.setPointerCapture(event.pointerId);
          isDragged.current = true;
          wasDragged.current = true;
        }}
        onPointerUp={() => {
          if (!isDragged.current) return;
          isDragged.current = false;
          redraw.current();
        }}
        onPointerMove={(event) => {
          if (isDragged.current) {
            aim(projection.current, event, []);
            return;
          }
          event.currentTarget.style.cursor = isOnTarget(projection.current, [event.offsetX, event.offsetY]) ? 'move' : '';
          look(projection.current, event);
          pointed.value = pointedAt(projection.current, event);
        }}
        onPointerLeave={() => {
          pointed.value = null;
        }}
        onClick={(event) => {
          // The end of a drag is no click.
          if (wasDragged.current) {
            wasDragged.current = false;
            return;
          }
          if (!isAiming.value) {
            pick(projection.current, event, isPicking);
            return;
          }
          aim(projection.current, event, scene.value.sites);
          isAiming.value = false;
        }}
      />
      {pointed.value && (
        <span
          class={pointed.value.isRight ? 'site-name left' : 'site-name'}
          style={{ left: `${pointed.value.x}px`, top: `${pointed.value.y}px` }}
        >
          {pointed.value.text}
        </span>
      )}
    </div>
  );
}

/** Leaves out what is far out of sight, of which a coast on a great scale has very many points. */
function clipToSight(near: GeoProjection, width: number, height: number): void {
  const [x, y] = near.translate();
  const farthest = Math.hypot(Math.max(x, width - x), Math.max(y, height - y)) / near.scale();
  const degrees = (1.1 * farthest * 180) / Math.PI;
  if (degrees < 150) near.clipAngle(degrees);
}

/** What is seen around a target: a place, and so many degrees around it. */
interface Sight {
  middle: Place;
  radius: number;
}

/** Around a target, so wide that the ends of the flights are seen, as far as they are not too far away. */
function sightOf(middle: Place, { runs, found }: Scene): Sight {
  const ends = [...runs.slice(0, 1), ...found].map(({ flight }) => placeAt(flight, flight.final.time ?? 0));
  const farthest = Math.max(...ends.map((end) => (geoDistance(middle, end) * 180) / Math.PI), 0);
  return { middle, radius: Math.min(Math.max(1.3 * farthest, SIGHT.least), SIGHT.most) };
}

/** Degrees, some 50 and 3300 km. */
const SIGHT = { least: 0.5, most: 30 };

/** How near, in pixels, a pointer is to the target that it means. */
const NEAR = 14;

function isOnTarget(projection: GeoProjection, [x, y]: [number, number]): boolean {
  const point = scene.peek().target && seen(projection, scene.peek().target?.place as Place);
  return point ? Math.hypot(point[0] - x, point[1] - y) < NEAR : false;
}

/** Puts the target where the pointer is, to a tenth of a pixel, or at the site there. */
function aim(projection: GeoProjection, { offsetX, offsetY }: MouseEvent, sites: ListedSite[]): void {
  const site = siteAt(projection, sites, [offsetX, offsetY]);
  const place = site ? ([site.longitude, site.geodetic_latitude] as Place) : projection.invert?.([offsetX, offsetY]);
  if (!place) return;
  const perPixel = 180 / Math.PI / projection.scale();
  aimAt(place, site ? 5 : Math.min(Math.max(Math.ceil(-Math.log10(perPixel)) + 1, 2), 5));
}

/** What a mark of the map says at which the pointer is, and where that is. */
interface Pointed {
  text: string;
  x: number;
  y: number;
  /** In the right half of the map, where a name has its room to the left. */
  isRight: boolean;
}

function pointedAt(projection: GeoProjection, { offsetX, offsetY, currentTarget }: PointerEvent): Pointed | null {
  const site = siteAt(projection, scene.value.sites, [offsetX, offsetY]);
  const extremes = extremeAt(projection, scene.value.footprint, [offsetX, offsetY]);
  const text = [...extremes, ...(site ? [titleOfSite(site)] : [])].join('; ');
  return text === '' ? null : { text, x: offsetX, y: offsetY, isRight: offsetX > (currentTarget as HTMLElement).clientWidth / 2 };
}

/** Puts a launch where the map was clicked: at a site or, where the reader is to pick a place, at any other. */
function pick(projection: GeoProjection, { offsetX, offsetY }: MouseEvent, isPicking: boolean): void {
  if (!isLaunch()) return;
  const site = siteAt(projection, scene.value.sites, [offsetX, offsetY]);
  const place = projection.invert?.([offsetX, offsetY]);
  if (site) launchFrom(site.slug);
  else if (isPicking && place) launchAt(rounded(place[1]), rounded(place[0]));
}

/** Degrees to some 100 m, which is finer than a pixel. */
const rounded = (degrees: number) => Number(degrees.toFixed(3));

/** What is in sight: the planet, the tracks, those of the bodies with the vehicle until the last of them has left it, the place that is to be reached, the ground that flights reach. */
type View = 'world' | 'track' | 'bodies' | 'target' | 'footprint';

function placesOf(runs: Run[], view: View): Place[] {
  const own = runs.filter(({ id }) => id <= 0);
  const last = view === 'bodies' ? Math.max(...own.filter(({ id }) => id < 0).map(({ flight }) => flight.initial.time ?? 0)) : Infinity;
  return own.flatMap(({ id, flight }) => flight.columns.time.filter((time) => id < 0 || time <= last).map((time) => placeAt(flight, time)));
}

/** Places half a degree around another, so that the shortest track is not blown up to nothing but itself. */
function around([longitude, latitude]: [number, number]): [number, number][] {
  return [
    [longitude - 0.5, Math.max(latitude - 0.5, -90)],
    [longitude + 0.5, Math.min(latitude + 0.5, 90)],
  ];
}

/** Looks at the instant whose place is nearest to the pointer, where one is near. */
function look(projection: GeoProjection, event: PointerEvent): void {
  const flight = current.value?.flight;
  if (!flight || event.buttons !== 0) return;
  const times = flight.columns.time;
  let [best, least] = [-1, 20 ** 2];
  for (let index = 0; index < times.length; index += 1) {
    const point = projection(placeAt(flight, times[index] as number));
    if (!point) continue;
    const distance = (point[0] - event.offsetX) ** 2 + (point[1] - event.offsetY) ** 2;
    if (distance < least) [best, least] = [index, distance];
  }
  if (best >= 0) cursor.value = times[best] as number;
}

const TURN: Record<string, [number, number]> = { ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, 8], ArrowDown: [0, -8] };

function Globe() {
  const turned = useRef<[number, number] | null>(null);
  const zoom = useRef(1);
  const { canvas, redraw } = useCanvas((ctx, width, height, shown) => {
    const flight = shown.runs[0]?.flight;
    const [lambda, phi] = turned.current ?? (flight ? middleOf(flight).map((angle) => -angle) : [0, 0]);
    const globe = geoOrthographic()
      .clipAngle(90)
      .translate([width / 2, height / 2])
      .scale((Math.min(width, height) / 2 - 6) * zoom.current)
      .rotate([lambda as number, phi as number]);
    drawScene(ctx, globe, shown, 30);
    angles.current = [lambda as number, phi as number];
    radius.current = globe.scale();
  }, []);
  const angles = useRef<[number, number]>([0, 0]);
  const radius = useRef(1);
  const turn = (east: number, north: number) => {
    const [lambda, phi] = angles.current;
    turned.current = [lambda + east, Math.min(Math.max(phi - north, -90), 90)];
    angles.current = turned.current;
    redraw.current();
  };
  const scale = (factor: number) => {
    zoom.current = Math.min(Math.max(zoom.current * factor, 1), 12);
    redraw.current();
  };
  const run = current.value;
  return (
    <div class="globe">
      <canvas
        ref={canvas}
        role="img"
        tabIndex={0}
        aria-label={
          run
            ? `Globe${isEarth(planetOf(run)) ? '' : ` of ${bodyIn(planetOf(run))}`} with the track ${summaryOf(run)}; arrow keys rotate it`
            : 'Globe'
        }
        onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
        onPointerMove={(event) => {
          if (event.buttons === 0) return;
          const perPixel = 180 / Math.PI / radius.current;
          turn(event.movementX * perPixel, event.movementY * perPixel);
        }}
        onKeyDown={(event) => {
          const step = TURN[event.key];
          if (!step) return;
          event.preventDefault();
          turn(...step);
        }}
      />
      <div class="globe-buttons">
        <button type="button" aria-label="Zoom in" onClick={() => scale(1.5)}>
          +
        </button>
        <button type="button" aria-label="Zoom out" onClick={() => scale(1 / 1.5)}>
          −
        </button>
        <button
          type="button"
          onClick={() => {
            turned.current = null;
            zoom.current = 1;
            redraw.current();
          }}
        >
          Reset view
        </button>
      </div>
    </div>
  );
}

/** What the colours of the track mean. */
function Legend({ run }: { run: Run }) {
  if (run.flight.bodies.length > 0) return <BodyLegend run={run} />;
  const [low, high] = extent(run.flight.columns.altitude ?? []);
  return (
    <span class="legend quiet">
      {kilometres(low, 3)} km
      <span class="ramp">
        {Array.from({ length: 16 }, (_, index) => (
          <span key={index} style={{ background: ramp(index / 15) }} />
        ))}
      </span>
      {kilometres(high, 3)} km
    </span>
  );
}

/** Which track is whose. */
function BodyLegend({ run }: { run: Run }) {
  return (
    <ul class="legend bodies quiet" aria-label="Tracks">
      {withBodies(run).map(({ id, label, colour }) => (
        <li key={id}>
          <span class={`swatch run-${colour}`} />
          {id === 0 ? 'Vehicle' : label}
        </li>
      ))}
    </ul>
  );
}

/** The marked places, and where bodies came down, to copy. */
function Places({ run }: { run: Run }) {
  const said = useSignal('');
  const { flight } = run;
  const ends = ({ final }: Flight): Place => [final.longitude ?? 0, final.geodetic_latitude ?? 0];
  const marks = flight.marks.filter(isPlaced).map(({ kind, label, time }) => ({
    label,
    time,
    altitude: at(flight, 'altitude', time),
    place: kind === 'end' ? ends(flight) : placeAt(flight, time),
  }));
  const bodies = flight.bodies.map(({ name, flight: body }) => ({
    label: `${name}: ${endOf(body.answer)}`,
    time: body.final.time ?? 0,
    altitude: body.final.altitude ?? 0,
    place: ends(body),
  }));
  return (
    <div class="places">
      <ul>
        {[...marks, ...bodies].map(({ label, time, altitude, place }, index) => (
          <li key={`${index}${label}`}>
            <strong>{label}</strong> <code>{written(place)}</code>{' '}
            <span class="quiet">
              {kilometres(altitude, 4)} km, {number(time, 5)} s
            </span>{' '}
            <button
              type="button"
              class="small"
              aria-label={`Copy position of ${label}`}
              onClick={() => {
                void copied(written(place)).then(() => {
                  said.value = `Copied: ${written(place)}`;
                });
              }}
            >
              Copy
            </button>
          </li>
        ))}
      </ul>
      <output class="quiet" aria-live="polite">
        {said.value}
      </output>
    </div>
  );
}
