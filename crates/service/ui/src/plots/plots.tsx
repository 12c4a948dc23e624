import { useSignal } from '@preact/signals';
import { columnOf, number, reading, unitOfLoad } from '../figures';
import { COLOURS, type Flight, isFlying, isLaunched } from '../flight';
import { planetOf } from '../planets';
import { type Name, QUANTITIES, unitOf } from '../quantities';
import { Scroll } from '../scroll';
import { added, angleUnit, current, cursor, lastEnd, runs, tracks } from '../store';
import { corridorFlights } from '../target/solve';
import { type Axes, addable, axesOf, bandsOf, curveOf, type Layout, picked, plotted, titleOf, valueAt } from './curves';
import { Plot } from './plot';
import './plots.css';

const LAYOUTS: Record<Layout, string> = {
  thesis: 'Thesis layout',
  time: 'Against time',
  altitude: 'Against altitude',
  speed: 'Against speed',
  downrange: 'Against downrange',
};
const ROWS = 50;

/** The plots of all flights that are shown, linked by one instant. */
export function Plots() {
  const chosen = useSignal<Layout | null>(null);
  const unzoom = useSignal(0);
  const flight = current.value?.flight;
  if (!flight) return null;
  const byTime = current.value !== null && isLaunched(current.value);
  const layout = chosen.value ?? (byTime ? 'time' : 'thesis');
  const hasRange = flight.columns.downrange !== undefined;
  const names = plotted(flight.final, added.value);
  const more = addable(flight.final, added.value);
  return (
    <section aria-label="Plots" class="group">
      <div class="plots-bar">
        <h2>Plots</h2>
        <select
          aria-label="Plot layout"
          value={layout}
          onChange={(event) => {
            chosen.value = event.currentTarget.value as Layout;
          }}
        >
          {Object.entries(LAYOUTS).map(([name, label]) =>
            name === 'downrange' && !hasRange ? null : (
              <option key={name} value={name}>
                {label}
              </option>
            ),
          )}
        </select>
        <select
          aria-label="Add a plot"
          value=""
          onChange={(event) => {
            if (event.currentTarget.value) added.value = [...added.value, event.currentTarget.value as Name];
            event.currentTarget.value = '';
          }}
        >
          <option value="">Add a plot …</option>
          {more.map((name) => (
            <option key={name} value={name}>
              {QUANTITIES[name].label}
            </option>
          ))}
        </select>
        <button
          type="button"
          onClick={() => {
            unzoom.value += 1;
          }}
        >
          Reset zoom
        </button>
        <span class="quiet">△ peak · □ event · ● end</span>
      </div>
      <Instant flight={flight} />
      <div class="plot-grid">
        <Card axes={{ x: 'speed', y: 'altitude' }} isLarge unzoom={unzoom} />
        {byTime && hasRange && <Card axes={{ x: 'downrange', y: 'altitude' }} isLarge unzoom={unzoom} />}
        {names.map((name) => (
          <Card
            key={name}
            axes={axesOf(name, layout)}
            unzoom={unzoom}
            onRemove={
              added.value.includes(name)
                ? () => {
                    added.value = added.value.filter((other) => other !== name);
                  }
                : undefined
            }
          />
        ))}
      </div>
      <Table names={names} />
    </section>
  );
}

interface CardProps {
  axes: Axes;
  unzoom: { value: number } & Parameters<typeof Plot>[0]['unzoom'];
  isLarge?: boolean;
  onRemove?: (() => void) | undefined;
}

function Card({ axes, unzoom, isLarge = false, onRemove }: CardProps) {
  return (
    <div class={isLarge ? 'plot-card large' : 'plot-card'}>
      <div class="plot-head">
        <h3>{isLarge ? `${titleHere(axes.y)}, against ${QUANTITIES[axes.x].label.toLowerCase()}` : titleHere(axes.y)}</h3>
        <Readings axes={axes} />
        {onRemove && (
          <button type="button" class="small" onClick={onRemove} aria-label={`Remove plot: ${QUANTITIES[axes.y].label}`}>
            ×
          </button>
        )}
      </div>
      <Plot axes={axes} height={isLarge ? 300 : 210} unzoom={unzoom} />
      {hasBands(axes) && <p class="quiet plot-axis">Green: this case within the corridor; dashed: at its ends</p>}
      <p class="quiet plot-axis">{titleHere(axes.x)}</p>
    </div>
  );
}

/** Whether a plot has a band of a corridor. */
function hasBands(axes: Axes): boolean {
  return bandsOf(corridorFlights.value, axes, angleUnit.value).length > 0;
}

/** The label of a quantity with its unit, on the planet of the current flight. */
function titleHere(name: Name): string {
  const planet = current.value ? planetOf(current.value) : '';
  return name === 'load_factor' && planet ? `${QUANTITIES[name].label}, ${unitOfLoad(planet)}` : titleOf(name, angleUnit.value);
}

/** The plotted quantity of every flight at the instant that is looked at. */
function Readings({ axes }: { axes: Axes }) {
  const time = cursor.value;
  // Of more bodies than there are colours the first.
  const told = tracks.value.filter(({ id }) => id >= -COLOURS);
  return (
    <span class="readings">
      {told.map((run) => {
        const isOver = time === null || !isFlying(run.flight, time);
        return (
          <span key={run.id} class="reading" title={run.id === 0 ? 'Current flight' : run.label}>
            {told.length > 1 && <span class={`swatch run-${run.colour}`} />}
            <span style={{ color: `var(--run-${run.colour})` }}>{isOver ? '–' : reading(valueAt(run, axes.y, time, angleUnit.value))}</span>
          </span>
        );
      })}
    </span>
  );
}

const READ: Name[] = ['altitude', 'speed'];

/** The instant that is looked at: it stays in sight as long as the plots are. */
function Instant({ flight }: { flight: Flight }) {
  const run = current.value;
  const unit = angleUnit.value;
  const end = lastEnd.value;
  const time = cursor.value === null ? null : Math.min(cursor.value, end);
  const isOver = time !== null && !isFlying(flight, time);
  return (
    <div class="instant">
      <label for="instant">Time</label>
      <input
        id="instant"
        type="range"
        min={0}
        max={1000}
        step={1}
        value={time === null || end === 0 ? 0 : Math.round((time / end) * 1000)}
        aria-valuetext={time === null ? 'None' : `${number(time, 5)} s`}
        onInput={(event) => {
          cursor.value = (Number(event.currentTarget.value) / 1000) * end;
        }}
        onKeyDown={(event) => {
          if (event.key === 'Escape') cursor.value = null;
        }}
      />
      <span class="quiet">
        {time === null || !run
          ? 'Point at a plot to read values; drag to zoom'
          : [
              `${reading(time)} s`,
              ...(isOver ? ['vehicle: ended'] : []),
              ...(isOver ? [] : READ).map(
                (name) => `${QUANTITIES[name].label} ${reading(valueAt(run, name, time, unit))} ${unitOf(name, unit)}`,
              ),
            ].join(' · ')}
      </span>
    </div>
  );
}

/** The curves as numbers, for those who do not see them. */
function Table({ names }: { names: Name[] }) {
  const isOpen = useSignal(false);
  const run = current.value;
  return (
    <details
      class="table"
      onToggle={(event) => {
        isOpen.value = event.currentTarget.open;
      }}
    >
      <summary>Show as table</summary>
      {isOpen.value && run && (
        <Rows flight={run.flight} names={['time', ...names]} label={runs.value.length > 1 ? 'Current flight' : 'Flight'} />
      )}
    </details>
  );
}

function Rows({ flight, names, label }: { flight: Flight; names: Name[]; label: string }) {
  const unit = angleUnit.value;
  const rows = picked(flight.columns.time.length, ROWS);
  const columns = names.map((name) => {
    const { y } = curveOf(flight, { x: 'time', y: name }, unit);
    return columnOf(rows.map((row) => y[row] ?? Number.NaN));
  });
  return (
    <Scroll label={label}>
      <table>
        <thead>
          <tr>
            {names.map((name) => (
              <th scope="col" key={name}>
                {titleHere(name)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {rows.map((row, place) => (
            <tr key={row}>
              {columns.map((column, index) => (
                <td key={names[index]}>{column[place]}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}
