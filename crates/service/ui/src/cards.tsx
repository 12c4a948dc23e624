import { useComputed } from '@preact/signals';
import type { Schemas } from './api';
import { turned } from './case';
import { capital, figuresOf, modelsInWords, number } from './figures';
import { chapterOf, Explained } from './guide';
import { type Name, QUANTITIES } from './quantities';
import { Scroll } from './scroll';
import { angleUnit, current, problem } from './store';

/** What is wrong with the case; the fields say it too. */
export function Problems() {
  const found = problem.value;
  if (!found) return null;
  return (
    <section class="notice bad" role="alert">
      <h2>{found.title}</h2>
      <p>
        {found.detail} <Explained at={found.type.slice(1)} name={found.title} />
      </p>
      {found.errors && (
        <ul>
          {found.errors.map(({ pointer, detail }) => (
            <li key={pointer + detail}>
              <button type="button" class="link" onClick={() => reveal(pointer)}>
                {pointer || 'Case'}
              </button>{' '}
              {detail} <Explained at={chapterOf(pointer)} name={pointer || 'the case'} />
            </li>
          ))}
        </ul>
      )}
      {current.value && <p class="quiet">Results below are from the last valid case.</p>}
    </section>
  );
}

/** Unfolds what hides a field, and goes there; to the nearest part around it where it has no input. */
function reveal(pointer: string): void {
  for (let at = pointer; at !== ''; at = at.slice(0, at.lastIndexOf('/'))) {
    const input = document.getElementById(`field${at}`);
    if (!input) continue;
    for (let fold = input.closest('details'); fold; fold = fold.parentElement?.closest('details') ?? null) fold.open = true;
    input.focus();
    input.scrollIntoView({ block: 'center' });
    return;
  }
}

/** What the user should know of the flight. */
export function Warnings() {
  const warnings = current.value?.flight.answer.warnings ?? [];
  if (warnings.length === 0) return null;
  return (
    <section class="notice warn" aria-label="Warnings">
      <ul>
        {warnings.map(({ code, detail, time }) => (
          <li key={`${code}${time}`}>
            {detail} <Explained at={`warnings/${code}`} name={code} />
          </li>
        ))}
      </ul>
    </section>
  );
}

/** The figures by which the flight is judged. */
export function Cards() {
  const figures = useComputed(() => (current.value ? figuresOf(current.value.flight, angleUnit.value) : [])).value;
  return (
    <dl class={problem.value ? 'cards stale' : 'cards'} aria-label="Key figures">
      {figures.map(({ label, unit, value, note, parts }) => (
        <div class={parts ? 'card wide' : 'card'} key={label}>
          <dt>{label}</dt>
          <dd>
            <span class="value" data-figure={label}>
              {typeof value === 'number' ? number(value) : value}
            </span>{' '}
            {unit}
          </dd>
          {note && <dd class="quiet">{note}</dd>}
          {parts && <dd class="quiet">{parts}</dd>}
        </div>
      ))}
    </dl>
  );
}

/** How the flight was computed, and how exact it is, where that was asked. */
export function Computing() {
  const answer = current.value?.flight.answer;
  if (!answer) return null;
  const { solver, models, verification, version } = answer;
  return (
    <p class="quiet">
      {modelsInWords(models)}; {solver.steps} steps, {solver.evaluations} function evaluations, {number(solver.elapsed * 1e3, 3)} ms.
      reentry {version}.
      {verification && (
        <>
          {' '}
          Accuracy check: at 1/100 of the tolerance, the end point differs by {number(verification.distance, 2)} m and{' '}
          {number(Math.abs(verification.time_difference), 2)} s.
        </>
      )}
    </p>
  );
}

const ENDS = { time: 's', longitude: '', geocentric_latitude: '', speed: 'm/s', flight_path_angle: '' } as const;
/** The units of the inputs; of angles that of the reader. */
const INPUTS: Partial<Record<keyof Schemas['Gradient'], string>> = {
  mass: 'kg',
  reference_area: 'm²',
  surface_density: 'kg/m³',
  radius: 'm',
  speed: 'm/s',
};

/** A quantity as people call it, with its unit where it has one. */
function titled(name: string, unit: string | undefined): string {
  const label = name in QUANTITIES ? QUANTITIES[name as Name].label : capital(name.replaceAll('_', ' '));
  return unit ? `${label}, ${unit}` : label;
}

/** The derivatives, where they were asked. */
export function Sensitivities() {
  const answer = current.value?.flight.answer;
  const sensitivities = answer?.sensitivities;
  if (!sensitivities) return null;
  if ('matrix' in sensitivities) return <Matrix of={sensitivities} unit={answer.angle_unit} />;
  const ends = Object.keys(ENDS) as (keyof typeof ENDS)[];
  const isAngle = (name: string) => name in QUANTITIES && QUANTITIES[name as Name].angle;
  // Without those that the case does not have.
  const inputs = (Object.keys(sensitivities.time) as (keyof Schemas['Gradient'])[]).filter((input) =>
    ends.some((end) => sensitivities[end][input] !== null),
  );
  const turn = (name: string) => (isAngle(name) ? (turned(1, answer.angle_unit, angleUnit.value) as number) : 1);
  return (
    <section aria-label="Sensitivities">
      <h2>Sensitivity of the landing point</h2>
      <Scroll label="Table of sensitivities">
        <table>
          <thead>
            <tr>
              <th scope="col">Input</th>
              {ends.map((end) => (
                <th scope="col" key={end}>
                  {titled(end, ENDS[end] || angleUnit.value)}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {inputs.map((input) => (
              <tr key={input}>
                <th scope="row">{titled(input, isAngle(input) ? angleUnit.value : INPUTS[input])}</th>
                {ends.map((end) => (
                  <td key={end}>{number((sensitivities[end][input] ?? Number.NaN) * (turn(end) / turn(input)), 5)}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </Scroll>
    </section>
  );
}

/** Derivatives of outputs by numbers of the case, in the units of the case. */
function Matrix({ of, unit }: { of: Schemas['Matrix']; unit: string }) {
  return (
    <section aria-label="Sensitivities">
      <h2>Sensitivities</h2>
      <Scroll label="Table of sensitivities">
        <table>
          <thead>
            <tr>
              <th scope="col">Input</th>
              {of.of.map(({ quantity, time }, row) => (
                <th scope="col" key={`${quantity}${row}`}>
                  {titled(quantity, undefined)}
                  {time === null ? '' : ` at ${number(time)} s`}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {of.to.map(({ pointer }, column) => (
              <tr key={pointer}>
                <th scope="row">{pointer}</th>
                {of.matrix.map((slopes, row) => (
                  <td key={`${pointer}${row}`}>{number(slopes[column] ?? Number.NaN, 5)}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </Scroll>
      <p class="quiet">Units are those of the case; angles in {unit}.</p>
    </section>
  );
}

/** How far the landing scatters, where dispersions were given. */
export function Dispersions() {
  const answer = current.value?.flight.answer;
  if (!answer?.covariance) return null;
  const { landing, dispersions } = answer.covariance;
  const azimuth = landing.azimuth === null ? Number.NaN : (turned(landing.azimuth, answer.angle_unit, angleUnit.value) as number);
  return (
    <section aria-label="Dispersions">
      <h2>Landing dispersion</h2>
      <p>
        1σ ellipse: semi-axes {number(landing.semi_major_axis ?? Number.NaN, 4)} m and {number(landing.semi_minor_axis ?? Number.NaN, 4)} m;
        azimuth of the major axis {number(azimuth, 4)} {angleUnit.value}.
      </p>
      <Scroll label="Table of dispersions">
        <table>
          <thead>
            <tr>
              <th scope="col">Input</th>
              <th scope="col">Share of variance</th>
            </tr>
          </thead>
          <tbody>
            {dispersions.map(({ pointers, share }) => (
              <tr key={pointers.join()}>
                <th scope="row">{pointers.join(', ')}</th>
                <td>{number((share ?? Number.NaN) * 100, 3)} %</td>
              </tr>
            ))}
          </tbody>
        </table>
      </Scroll>
    </section>
  );
}
