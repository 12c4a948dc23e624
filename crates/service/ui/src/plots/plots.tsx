import { useSignal } from '@preact/signals';
import { number } from '../figures';
import type { Flight } from '../flight';
import { type Name, QUANTITIES, unitOf } from '../quantities';
import { Scroll } from '../scroll';
import { angleUnit, current, cursor, runs } from '../store';
import { type Axes, addable, axesOf, curveOf, type Layout, picked, plotted, titleOf, valueAt } from './curves';
import { Plot } from './plot';
import './plots.css';

const LAYOUTS: Record<Layout, string> = {
  thesis: 'as in the thesis',
  time: 'against time',
  altitude: 'against altitude',
  speed: 'against speed',
};
const ROWS = 50;

/** The plots of all flights that are shown, linked by one instant. */
export function Plots() {
  const layout = useSignal<Layout>('thesis');
  const added = useSignal<Name[]>([]);
  const unzoom = useSignal(0);
  const flight = current.value?.flight;
  if (!flight) return null;
  const names = plotted(flight, added.value);
  const more = addable(flight, added.value);
  return (
    <section aria-label="Plots" class="group">
      <div class="plots-bar">
        <h2>Plots</h2>
        <select
          aria-label="Layout of the plots"
          value={layout.value}
          onChange={(event) => {
            layout.value = event.currentTarget.value as Layout;
          }}
        >
          {Object.entries(LAYOUTS).map(([name, label]) => (
            <option key={name} value={name}>
              {label}
            </option>
          ))}
        </select>
        <select
          aria-label="Add a plot"
          value=""
          onChange={(event) => {
            if (event.currentTarget.value) added.value = [...added.value, event.currentTarget.value as Name];
            event.currentTarget.value = '';
          }}
        >
          <option value="">add a plot …</option>
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
        {names.map((name) => (
          <Card
            key={name}
            axes={axesOf(name, layout.value)}
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
  const unit = angleUnit.value;
  return (
    <div class={isLarge ? 'plot-card large' : 'plot-card'}>
      <div class="plot-head">
        <h3>{isLarge ? `${titleOf(axes.y, unit)}, against speed` : titleOf(axes.y, unit)}</h3>
        {onRemove && (
          <button type="button" class="small" onClick={onRemove} aria-label={`Remove the plot of ${QUANTITIES[axes.y].label}`}>
            ×
          </button>
        )}
      </div>
      <Plot axes={axes} height={isLarge ? 300 : 210} unzoom={unzoom} />
      <p class="quiet plot-axis">{titleOf(axes.x, unit)}</p>
    </div>
  );
}

const READ: Name[] = ['altitude', 'speed', 'flight_path_angle', 'load_factor', 'mach', 'convective_heat_flux'];

/** The instant that is looked at, and what is there. */
function Instant({ flight }: { flight: Flight }) {
  const run = current.value;
  const unit = angleUnit.value;
  const end = flight.final.time ?? 0;
  const time = cursor.value === null ? null : Math.min(cursor.value, end);
  const read = READ.filter((name) => flight.columns[name]);
  return (
    <div class="instant">
      <label for="instant">Instant</label>
      <input
        id="instant"
        type="range"
        min={0}
        max={1000}
        step={1}
        value={time === null || end === 0 ? 0 : Math.round((time / end) * 1000)}
        aria-valuetext={time === null ? 'none' : `${number(time, 5)} s`}
        onInput={(event) => {
          cursor.value = (Number(event.currentTarget.value) / 1000) * end;
        }}
        onKeyDown={(event) => {
          if (event.key === 'Escape') cursor.value = null;
        }}
      />
      <span class="quiet">
        {time === null || !run
          ? 'point at a plot to read it; drag to zoom'
          : [
              `${number(time, 5)} s`,
              ...read.map((name) => `${QUANTITIES[name].label} ${number(valueAt(run, name, time, unit), 5)} ${unitOf(name, unit)}`),
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
      onToggle={(event) => {
        isOpen.value = event.currentTarget.open;
      }}
    >
      <summary>The same as a table</summary>
      {isOpen.value && run && (
        <Rows flight={run.flight} names={['time', ...names]} label={runs.value.length > 1 ? 'Current flight' : 'Flight'} />
      )}
    </details>
  );
}

function Rows({ flight, names, label }: { flight: Flight; names: Name[]; label: string }) {
  const unit = angleUnit.value;
  const columns = names.map((name) => curveOf(flight, { x: 'time', y: name }, unit).y);
  return (
    <Scroll label={label}>
      <table>
        <thead>
          <tr>
            {names.map((name) => (
              <th scope="col" key={name}>
                {titleOf(name, unit)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {picked(flight.columns.time.length, ROWS).map((row) => (
            <tr key={row}>
              {columns.map((column, index) => (
                <td key={names[index]}>{number(column[row] ?? Number.NaN)}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}
