import { useComputed } from '@preact/signals';
import type { Schemas } from './api';
import { turned } from './case';
import { figuresOf, number } from './figures';
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
                {pointer || 'the case'}
              </button>{' '}
              {detail} <Explained at={chapterOf(pointer)} name={pointer || 'the case'} />
            </li>
          ))}
        </ul>
      )}
      {current.value && <p class="quiet">Shown below is the last flight that could be flown.</p>}
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
    <dl class={problem.value ? 'cards stale' : 'cards'} aria-label="Figures of the flight">
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
      {models.planet}, {models.shape}, {models.atmosphere}, {models.gravity}. {solver.steps} steps, {solver.evaluations} right-hand sides,{' '}
      {number(solver.elapsed * 1e6, 3)} µs. reentry {version}.
      {verification && (
        <>
          {' '}
          At a hundredth of the tolerance the flight ends {number(verification.distance, 2)} m and{' '}
          {number(Math.abs(verification.time_difference), 2)} s from here.
        </>
      )}
    </p>
  );
}

const ENDS = { time: 's', longitude: '', geocentric_latitude: '', speed: 'm/s', flight_path_angle: '' } as const;

/** The derivatives, where they were asked. */
export function Sensitivities() {
  const answer = current.value?.flight.answer;
  const sensitivities = answer?.sensitivities;
  if (!sensitivities) return null;
  if ('matrix' in sensitivities) return <Matrix of={sensitivities} unit={answer.angle_unit} />;
  const ends = Object.keys(ENDS) as (keyof typeof ENDS)[];
  const causes = Object.keys(sensitivities.time) as (keyof typeof sensitivities.time)[];
  const isAngle = (name: string) => name in QUANTITIES && QUANTITIES[name as Name].angle;
  const turn = (name: string) => (isAngle(name) ? (turned(1, answer.angle_unit, angleUnit.value) as number) : 1);
  return (
    <section aria-label="Sensitivities">
      <h2>Sensitivities of the end</h2>
      <Scroll label="Table of sensitivities">
        <table>
          <thead>
            <tr>
              <th scope="col">by</th>
              {ends.map((end) => (
                <th scope="col" key={end}>
                  {end.replaceAll('_', ' ')}
                  {`, ${ENDS[end] || angleUnit.value}`}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {causes.map((cause) => (
              <tr key={cause}>
                <th scope="row">{cause.replaceAll('_', ' ')}</th>
                {ends.map((end) => (
                  <td key={end}>{number((sensitivities[end][cause] ?? Number.NaN) * (turn(end) / turn(cause)), 5)}</td>
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
              <th scope="col">by</th>
              {of.of.map(({ quantity, time }, row) => (
                <th scope="col" key={`${quantity}${row}`}>
                  {quantity.replaceAll('_', ' ')}
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
      <p class="quiet">In the units of the case; its angles are in {unit}.</p>
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
      <h2>Dispersions of the landing</h2>
      <p>
        The ellipse of one standard deviation: {number(landing.semi_major_axis ?? Number.NaN, 4)} m by{' '}
        {number(landing.semi_minor_axis ?? Number.NaN, 4)} m, its major axis at {number(azimuth, 4)} {angleUnit.value} from north.
      </p>
      <Scroll label="Table of dispersions">
        <table>
          <thead>
            <tr>
              <th scope="col">by</th>
              <th scope="col">share of the variance</th>
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
