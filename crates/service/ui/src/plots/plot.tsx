import { effect, type Signal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { colour, onTheme } from '../colours';
import { number } from '../figures';
import { isFlying, type Mark, type Run } from '../flight';
import type { AngleUnit, Name } from '../quantities';
import { angleUnit, current, cursor, theory, tracks } from '../store';
import { corridorFlights } from '../target/solve';
import { type Axes, bandsOf, type Curve, curveOf, isJoined, nearest, predictedOf, rangeOf, titleOf, valueAt } from './curves';

/** A curve and how it is drawn. */
interface Line extends Curve {
  colour: string;
  width: number;
  isDashed: boolean;
}

/** A plot of one quantity against another, of all flights that are shown. */
export function Plot({ axes, height, unzoom }: { axes: Axes; height: number; unzoom: Signal<number> }) {
  const host = useRef<HTMLDivElement>(null);
  const summary = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const [around, box] = [summary.current, host.current];
    if (!around || !box) return;
    const view = new View(box, axes, height);
    const ends = [
      effect(() => {
        view.show(tracks.value, angleUnit.value);
        around.setAttribute('aria-label', summaryOf(axes, angleUnit.value));
      }),
      effect(() => view.point(cursor.value)),
      effect(() => {
        void unzoom.value;
        view.unzoom();
      }),
      onTheme(() => view.redraw()),
      () => view.end(),
    ];
    return () => {
      for (const end of ends) end();
    };
  }, [axes.x, axes.y, height]);
  return (
    <div class="plot" role="img" ref={summary}>
      <div ref={host} />
    </div>
  );
}

/** The plot in words, for those who do not see it. */
function summaryOf({ x, y }: Axes, unit: AngleUnit): string {
  const run = current.value;
  if (!run) return '';
  const { time } = run.flight.columns;
  const told = (name: Name, instant: number) => number(valueAt(run, name, instant, unit), 4);
  const [first, last] = [time[0] ?? 0, time.at(-1) ?? 0];
  return `${titleOf(y, unit)} against ${titleOf(x, unit)}: from ${told(y, first)} at ${told(x, first)} to ${told(y, last)} at ${told(x, last)}`;
}

/** The canvas of a plot. It is drawn anew only where it can be seen. */
class View {
  private readonly plot: uPlot;
  private readonly dots: HTMLElement[] = [];
  private readonly sizes: ResizeObserver;
  private readonly sight: IntersectionObserver;
  private lines: Line[] = [];
  /** Of a corridor, by the curves of flights across; what is in sight does not depend on them. */
  private bands: Curve[][] = [];
  private shown: Run[] = [];
  private unit: AngleUnit = 'deg';
  private isSeen = false;
  private isStale = true;
  private isZoomed = false;

  constructor(
    box: HTMLElement,
    private readonly axes: Axes,
    height: number,
  ) {
    const axis = (scale: 'x' | 'y', size: number): uPlot.Axis => ({
      scale,
      size,
      stroke: () => colour('muted'),
      grid: { stroke: () => colour('line'), width: 1 },
      ticks: { stroke: () => colour('line'), width: 1, size: 4 },
      font: '12px system-ui, sans-serif',
      space: scale === 'x' ? 60 : 34,
      values: (_, splits) => splits.map((value) => number(value, 5)),
    });
    this.plot = new uPlot(
      {
        mode: 2,
        width: box.clientWidth || 320,
        height,
        padding: [10, 14, 0, 0],
        legend: { show: false },
        scales: { x: { time: false, auto: false }, y: { auto: false } },
        axes: [axis('x', 30), axis('y', 56)],
        series: [{}, { paths: () => null, points: { show: false }, facets: [{ scale: 'x' }, { scale: 'y' }] }],
        cursor: {
          x: false,
          y: false,
          points: { show: false },
          drag: { x: true, y: true, setScale: true, uni: 12, dist: 6 },
          bind: {
            dblclick: () => () => {
              this.unzoom();
              return null;
            },
          },
        },
        hooks: {
          draw: [() => this.draw()],
          setSelect: [
            ({ select }) => {
              if (select.width > 0 || select.height > 0) this.isZoomed = true;
            },
          ],
        },
      },
      [
        null,
        [
          [0, 1],
          [0, 1],
        ],
      ] as unknown as uPlot.AlignedData,
      box,
    );
    this.plot.over.addEventListener('pointermove', (event) => this.look(event));
    this.sizes = new ResizeObserver(() => {
      if (box.clientWidth > 0 && box.clientWidth !== this.plot.width) {
        this.plot.setSize({ width: box.clientWidth, height });
      }
    });
    this.sizes.observe(box);
    this.sight = new IntersectionObserver(
      ([entry]) => {
        this.isSeen = entry?.isIntersecting ?? true;
        if (this.isSeen && this.isStale) this.update();
      },
      { rootMargin: '200px' },
    );
    this.sight.observe(box);
    addEventListener('beforeprint', this.print);
  }

  /** On paper everything is seen. */
  private readonly print = (): void => {
    if (this.isStale) this.update();
  };

  /** Shows flights, angles in a unit. */
  show(flights: Run[], unit: AngleUnit): void {
    if (unit !== this.unit) this.isZoomed = false;
    this.shown = flights;
    this.unit = unit;
    // Read here, so that the effect around follows it.
    void theory.value;
    void corridorFlights.value;
    this.isStale = true;
    if (this.isSeen) this.update();
  }

  /** Everything in sight again. */
  unzoom(): void {
    this.isZoomed = false;
    if (this.lines.length > 0) this.fit();
  }

  redraw(): void {
    if (this.shown.length > 0) this.update();
  }

  end(): void {
    this.sizes.disconnect();
    this.sight.disconnect();
    removeEventListener('beforeprint', this.print);
    this.plot.destroy();
  }

  private update(): void {
    this.isStale = false;
    const { axes, unit } = this;
    // The current flight last, on top.
    this.lines = [...this.shown].reverse().map((run) => ({
      ...curveOf(run.flight, axes, unit),
      colour: colour(`run-${run.colour}`),
      width: run.id === 0 ? 2 : 1.4,
      isDashed: false,
    }));
    const beside = theory.peek();
    const predicted = beside && predictedOf(beside, axes, unit);
    if (predicted) this.lines.push({ ...predicted, colour: colour('text'), width: 1.6, isDashed: true });
    this.bands = bandsOf(corridorFlights.peek(), axes, unit);
    if (this.isZoomed) this.plot.redraw();
    else this.fit();
  }

  private fit(): void {
    const [x0, x1] = rangeOf(this.lines.map(({ x }) => x));
    const flown = this.lines.filter(({ isDashed }) => !isDashed);
    const [y0, y1] = rangeOf(flown.map(({ y }) => y));
    this.plot.batch(() => {
      this.plot.setScale('x', { min: x0, max: x1 });
      this.plot.setScale('y', { min: y0, max: y1 });
    });
    this.plot.redraw();
  }

  private position(x: number, y: number, isCanvas: boolean): [number, number] {
    return [this.plot.valToPos(x, 'x', isCanvas), this.plot.valToPos(y, 'y', isCanvas)];
  }

  private draw(): void {
    const { ctx, bbox } = this.plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    for (const band of this.bands) this.drawBand(ctx, band);
    for (const line of this.lines) this.drawLine(ctx, line);
    const run = this.shown.find(({ id }) => id === 0);
    if (run) for (const mark of run.flight.marks) this.drawMark(ctx, run, mark);
    for (const body of this.shown.filter(({ id }) => id < 0))
      for (const mark of body.flight.marks.filter(({ kind }) => kind === 'end')) this.drawMark(ctx, body, mark);
    ctx.restore();
    // Where the curves went, by a zoom or another width, the dots go too.
    this.point(cursor.peek());
  }

  /** Fills a band strip by strip, along one curve and back along the next, and dashes its ends. */
  private drawBand(ctx: CanvasRenderingContext2D, band: Curve[]): void {
    ctx.beginPath();
    for (const [index, from] of band.slice(0, -1).entries()) {
      const to = band[index + 1] as Curve;
      from.x.forEach((x, place) => {
        const [px, py] = this.position(x, from.y[place] as number, true);
        if (place === 0) ctx.moveTo(px, py);
        else ctx.lineTo(px, py);
      });
      for (let place = to.x.length - 1; place >= 0; place -= 1)
        ctx.lineTo(...this.position(to.x[place] as number, to.y[place] as number, true));
      ctx.closePath();
    }
    // As one: what strips have in common is no darker.
    ctx.fillStyle = colour('run-2');
    ctx.globalAlpha = 0.15;
    ctx.fill();
    ctx.globalAlpha = 1;
    for (const end of [band[0], band.at(-1)]) if (end) this.drawLine(ctx, { ...end, colour: colour('run-2'), width: 1.6, isDashed: true });
  }

  private drawLine(ctx: CanvasRenderingContext2D, { x, y, colour: stroke, width, isDashed }: Line): void {
    ctx.beginPath();
    let isDown = false;
    for (let index = 0; index < x.length; index += 1) {
      const [a, b] = [x[index] as number, y[index] as number];
      if (Number.isNaN(a) || Number.isNaN(b)) {
        isDown = false;
        continue;
      }
      const goesOn =
        isDown &&
        isJoined(x[index - 1] as number, a, this.axes.x, this.unit) &&
        isJoined(y[index - 1] as number, b, this.axes.y, this.unit);
      const [px, py] = this.position(a, b, true);
      if (goesOn) ctx.lineTo(px, py);
      else ctx.moveTo(px, py);
      isDown = true;
    }
    ctx.strokeStyle = stroke;
    ctx.lineWidth = width * devicePixelRatio;
    ctx.lineJoin = 'round';
    ctx.setLineDash(isDashed ? [6 * devicePixelRatio, 4 * devicePixelRatio] : []);
    ctx.stroke();
    ctx.setLineDash([]);
  }

  /** Events are squares, peaks triangles, the end a disc. */
  private drawMark(ctx: CanvasRenderingContext2D, run: Run, { kind, time }: Mark): void {
    if (kind === 'start') return;
    const [x, y] = this.position(valueAt(run, this.axes.x, time, this.unit), valueAt(run, this.axes.y, time, this.unit), true);
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    const size = 4 * devicePixelRatio;
    ctx.beginPath();
    if (kind === 'event') ctx.rect(x - size, y - size, 2 * size, 2 * size);
    else if (kind === 'end') ctx.arc(x, y, size, 0, 2 * Math.PI);
    else {
      ctx.moveTo(x, y - size * 1.2);
      ctx.lineTo(x + size * 1.1, y + size * 0.9);
      ctx.lineTo(x - size * 1.1, y + size * 0.9);
      ctx.closePath();
    }
    ctx.fillStyle = colour(kind === 'end' ? `run-${run.colour}` : 'surface');
    ctx.strokeStyle = colour(`run-${run.colour}`);
    ctx.lineWidth = 1.5 * devicePixelRatio;
    ctx.fill();
    ctx.stroke();
  }

  /** Looks at the instant of the current flight, or of a body that left it, that is nearest to the pointer. */
  private look(event: PointerEvent): void {
    const own = this.shown.filter(({ id }) => id <= 0);
    // A mouse that is pressed draws the box to zoom into.
    if (own.length === 0 || (event.buttons !== 0 && event.pointerType === 'mouse')) return;
    if (this.isStale) this.update();
    const box = this.plot.over.getBoundingClientRect();
    const curves = own.map((run) => ({ ...curveOf(run.flight, this.axes, this.unit), time: run.flight.columns.time }));
    const [x, y, time] = [curves.flatMap((curve) => curve.x), curves.flatMap((curve) => curve.y), curves.flatMap((curve) => curve.time)];
    const points = { length: x.length, at: (index: number) => this.position(x[index] as number, y[index] as number, false) };
    const index = nearest(points, event.clientX - box.left, event.clientY - box.top);
    if (index >= 0) cursor.value = time[index] ?? null;
  }

  /** A dot on every flight at an instant. */
  point(time: number | null): void {
    const flights = time === null || !this.isSeen ? [] : this.shown;
    for (const dot of this.dots.splice(flights.length)) dot.remove();
    flights.forEach((run, index) => {
      let dot = this.dots[index];
      if (!dot) {
        dot = document.createElement('span');
        dot.className = 'plot-dot';
        this.plot.over.append(dot);
        this.dots[index] = dot;
      }
      const [x, y] = this.position(valueAt(run, this.axes.x, time ?? 0, this.unit), valueAt(run, this.axes.y, time ?? 0, this.unit), false);
      const { width, height } = this.plot.over.getBoundingClientRect();
      const isThere = run.id >= 0 || isFlying(run.flight, time ?? 0);
      dot.hidden = !(isThere && x >= 0 && y >= 0 && x <= width && y <= height);
      dot.style.transform = `translate(${x}px, ${y}px)`;
      dot.style.background = colour(`run-${run.colour}`);
    });
  }
}
