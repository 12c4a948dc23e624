import type { Solution } from './api';
import { difference, endsApart, type Figure, figuresOf, number } from './figures';
import { COLOURS, type Run } from './flight';
import { completed } from './fly';
import { isSameGround, planetOf } from './planets';
import { Scroll } from './scroll';
import { angleUnit, current, pins, runs, solution, theory, theoryProblem, tracks } from './store';

const MOST = 6;
let lastId = 0;

/** Keeps the current flight to compare with. */
function pin(): void {
  if (!current.value) return;
  lastId += 1;
  const used = (of: Run[]) => new Set(of.map((run) => run.colour));
  const [byAny, byPins] = [used(tracks.value), used(pins.value)];
  const colours = Array.from({ length: COLOURS }, (_, index) => index + 1);
  // The colours of bodies are shared where there are no others.
  const colour = colours.find((candidate) => !byAny.has(candidate)) ?? colours.find((candidate) => !byPins.has(candidate)) ?? 1;
  pins.value = [...pins.value, { ...current.value, id: lastId, label: `${current.value.case.name ?? 'Flight'} #${lastId}`, colour }];
  void completed(lastId);
}

/** Keeps the current flight. */
export function Pin() {
  return (
    <button
      type="button"
      onClick={pin}
      disabled={!current.value || pins.value.length >= MOST}
      title="Keep this flight in the plots and on the map while you change the case"
    >
      Pin this flight
    </button>
  );
}

/** The flights side by side, and what sets the pinned ones apart from the current one. */
export function Compare() {
  if (pins.value.length === 0) return null;
  return (
    <section class="panel" aria-label="Comparison">
      <div class="panel-head">
        <h2>Comparison</h2>
        <button
          type="button"
          onClick={() => {
            pins.value = [];
          }}
        >
          Unpin all
        </button>
      </div>
      <Differences />
      <p class="quiet">Small numbers: pinned minus current flight.</p>
    </section>
  );
}

function Differences() {
  const [first, ...others] = runs.value;
  if (!first) return null;
  const unit = angleUnit.value;
  const mine = figuresOf(first.flight, unit);
  const theirs = others.map((run) => new Map(figuresOf(run.flight, unit).map((figure) => [figure.label, figure])));
  return (
    <Scroll label="Differences">
      <table>
        <thead>
          <tr>
            <th scope="col">Figure</th>
            {runs.value.map((run) => (
              <th scope="col" key={run.id}>
                <Name run={run} />
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {mine.map((figure) => (
            <tr key={figure.label}>
              <th scope="row">
                {figure.label}
                {figure.unit && `, ${figure.unit}`}
              </th>
              <td>{shown(figure)}</td>
              {others.map((run, index) => (
                <td key={run.id}>
                  <Other figure={theirs[index]?.get(figure.label)} mine={figure} />
                </td>
              ))}
            </tr>
          ))}
          <tr>
            <th scope="row">Distance between end points, km</th>
            <td>–</td>
            {others.map((run) => (
              <td key={run.id}>
                {isSameGround(planetOf(first), planetOf(run)) ? number(endsApart(first.flight, run.flight), 5) : 'other planet'}
              </td>
            ))}
          </tr>
        </tbody>
      </table>
    </Scroll>
  );
}

function Name({ run }: { run: Run }) {
  return (
    <span class="run-name">
      <span class={`swatch run-${run.colour}`} />
      {run.id === 0 ? 'Current' : run.label}
      {run.id !== 0 && (
        <button
          type="button"
          class="small"
          aria-label={`Unpin ${run.label}`}
          onClick={() => {
            pins.value = pins.value.filter((other) => other.id !== run.id);
          }}
        >
          ×
        </button>
      )}
    </span>
  );
}

function Other({ figure, mine }: { figure: Figure | undefined; mine: Figure }) {
  if (!figure) return <>–</>;
  if (typeof figure.value !== 'number' || typeof mine.value !== 'number') return <>{shown(figure)}</>;
  return (
    <>
      {shown(figure)} <small>{difference(figure.value - mine.value)}</small>
    </>
  );
}

function shown({ value }: Figure): string {
  return typeof value === 'number' ? number(value) : value;
}

const SOLUTIONS: Record<Solution, string> = {
  shallow_glide: 'Shallow glide',
  loh: 'Loh, second order',
  steep_glide: 'Steep glide',
  steep_ballistic: 'Steep ballistic',
  medium_glide: 'Medium glide',
};

/** A closed-form theory to set beside the flight. */
export function Theories() {
  const answer = theory.value;
  return (
    <section class="panel" aria-label="Theory">
      <div class="panel-head">
        <h2>Theory</h2>
        <label for="theory">Overlay</label>
        <select
          id="theory"
          value={solution.value ?? ''}
          onChange={(event) => {
            solution.value = (event.currentTarget.value || null) as Solution | null;
          }}
        >
          <option value="">None</option>
          {Object.entries(SOLUTIONS).map(([name, label]) => (
            <option key={name} value={name}>
              {label}
            </option>
          ))}
        </select>
      </div>
      {answer && (
        <p>
          {SOLUTIONS[answer.solution]}{' '}
          {answer.valid.from_altitude === null || answer.valid.to_altitude === null
            ? 'is not valid for this flight: '
            : `(dashed) is valid from ${number(answer.valid.from_altitude / 1e3, 3)} down to ${number(answer.valid.to_altitude / 1e3, 3)} km, where `}
          {answer.valid.ends_because}.
        </p>
      )}
      {theoryProblem.value && (
        <p class="fault">
          {theoryProblem.value.errors?.map(({ pointer, detail }) => `${pointer} ${detail}`).join(' · ') ?? theoryProblem.value.detail}
        </p>
      )}
    </section>
  );
}
