import { useEffect, useRef } from 'preact/hooks';
import type { Case, Target } from '../api';
import { isAngleAt, legible, pathOf, pointer, set } from '../case';
import { capital, number } from '../figures';
import { footprintProblem, isSurveying } from '../footprint/live';
import { AskForFootprint, FootprintPart } from '../footprint/panel';
import { Explained } from '../guide';
import { numberAt } from '../numbers';
import { numbersWithSlider, rangeOf, withRole } from '../roles';
import { Scroll } from '../scroll';
import { angleUnit, caseUnit, current, draft } from '../store';
import { Goals, startOf } from './goals';
import { placeGoal, withPlace } from './place';
import { taken } from './request';
import { allowed, corridorProblem, type Found, found, isSolving, targetProblem } from './solve';
import { courseOf, limitInWords, outcomeInWords, valueInWords, variedNumbers } from './why';
import './target.css';

/** Whether something is asked of a case beside its flight. */
export function isAsked({ vary, achieve, limits, footprint }: Case): boolean {
  return Boolean(footprint) || [vary, achieve, limits].some((part) => (part?.length ?? 0) > 0);
}

/** Opens the panel with the place where the flight lands now as the target; closes it, and fixes every number. */
export function AskForTarget() {
  const isOpen = isAsked(draft.value);
  return (
    <button
      type="button"
      aria-pressed={isOpen}
      disabled={!current.value && !isOpen}
      title="Find numbers of the case with which the flight lands at a place, or achieves other goals"
      onClick={() => {
        if (!isOpen) land();
        else {
          const { vary: _, achieve: __, limits: ___, footprint: ____, ...rest } = draft.peek();
          draft.value = rest;
        }
      }}
    >
      Target
    </button>
  );
}

/** A goal to land where the flight lands now. */
function land(): void {
  const final = current.peek()?.flight.final;
  const rounded = (angle: number | undefined) => Number((angle ?? 0).toFixed(3));
  draft.value = withPlace(draft.peek(), [rounded(final?.longitude), rounded(final?.geodetic_latitude)]);
}

/** What is free, what is to be achieved, and what a search finds. */
export function TargetPanel() {
  const section = useRef<HTMLElement>(null);
  const isOpen = isAsked(draft.value);
  useEffect(() => {
    if (isOpen) section.current?.scrollIntoView({ block: 'nearest' });
  }, [isOpen]);
  if (!isOpen) return null;
  const goals = draft.value.achieve ?? [];
  return (
    <section class="panel target" aria-label="Target" ref={section}>
      <div class="panel-head">
        <h2>Target</h2>
        {placeGoal(draft.value) < 0 && (
          <button type="button" onClick={land}>
            Land at a place
          </button>
        )}
        <button
          type="button"
          onClick={() => {
            draft.value = { ...draft.peek(), achieve: [...goals, startOf('load_factor')] };
          }}
        >
          Add a goal
        </button>
        <AskForFootprint />
        <span class="quiet">{isSolving.value || isSurveying.value ? 'Searching …' : ''}</span>
      </div>
      <FreeNumbers />
      <Goals />
      <Limits />
      <Faults />
      <Outcome />
      <Band />
      <FootprintPart />
    </section>
  );
}

/** The numbers that are free, and those that may be. */
function FreeNumbers() {
  const tree = draft.value;
  const free = tree.vary ?? [];
  const others = numbersWithSlider(tree).filter(({ path }) => !free.some((one) => one.pointer === pointer(path)));
  return (
    <div class="free">
      <span>Free</span>
      {free.map((one) => {
        const path = pathOf(tree, one.pointer);
        const own = numberAt(tree, path);
        const range = rangeOf(tree, one);
        const shown = range?.map((end) => number(isAngleAt(tree, one.pointer) ? (legible(end, 'deg', angleUnit.value) as number) : end, 6));
        const unit = own.isAngle && angleUnit.value === 'rad' ? 'rad' : own.unit;
        return (
          <span class="chip" key={one.pointer}>
            {own.label} {shown ? `${shown.join(' to ')}${unit === '°' ? unit : ` ${unit}`}` : ''}
            <button
              type="button"
              class="small"
              aria-label={`Fix ${own.label}`}
              onClick={() => {
                draft.value = withRole(draft.peek(), path, 'slider');
              }}
            >
              ×
            </button>
          </span>
        );
      })}
      <select
        aria-label="Free a number"
        value=""
        onChange={(event) => {
          const chosen = others[Number(event.currentTarget.value)];
          if (chosen) draft.value = withRole(draft.peek(), chosen.path, 'free');
          event.currentTarget.value = '';
        }}
      >
        <option value="">Free a number …</option>
        {others.map(({ label }, index) => (
          <option key={label} value={index}>
            {label}
          </option>
        ))}
      </select>
      {free.length === 0 && <span class="quiet">Any number of the case can be free: use the mark beside its field.</span>}
    </div>
  );
}

/** Why the goals cannot be searched for. */
function Faults() {
  const problem = targetProblem.value ?? corridorProblem.value ?? footprintProblem.value;
  if (!problem) return null;
  return (
    <div class="fault" role="alert">
      <p>
        {problem.detail} <Explained at={problem.type.slice(1)} name={problem.title} />
      </p>
      <ul>
        {problem.errors?.map((error) => (
          <li key={error.pointer + error.detail}>
            <code>{error.pointer}</code> {error.detail}
          </li>
        ))}
      </ul>
    </div>
  );
}

/** What was found, or why nothing was. */
function Outcome() {
  const shown = found.value;
  if (!shown) return null;
  const { asked, answer, runs } = shown;
  const [run] = runs;
  const course = run && answer.nearest ? courseOf(run.flight) : null;
  const sentence = capital(outcomeInWords({ asked, answer, reader: angleUnit.value, course }));
  return (
    <>
      <p class={answer.solutions.length > 0 ? 'outcome' : 'outcome missed'} role="status">
        {sentence}. <span class="quiet">{`${answer.search.flights} flights, ${number(answer.search.elapsed * 1e3, 3)} ms`}</span>
      </p>
      <Solutions shown={shown} />
    </>
  );
}

type Solution = Target['solutions'][number];

/** The solutions, or what comes nearest, a line each. */
function Solutions({ shown }: { shown: Found }) {
  const { asked, answer } = shown;
  const rows: Solution[] = answer.solutions.length > 0 ? answer.solutions : answer.nearest ? [answer.nearest] : [];
  if (rows.length === 0) return null;
  const numbers = variedNumbers(asked);
  const isHot = rows.some(({ peaks }) => peaks.heat_flux);
  return (
    <Scroll label="Solutions">
      <table>
        <thead>
          <tr>
            <th scope="col">{answer.solutions.length > 0 ? 'Solution' : 'Nearest'}</th>
            {numbers.map(({ label }) => (
              <th scope="col" key={label}>
                {label}
              </th>
            ))}
            <th scope="col">Time, s</th>
            <th scope="col">Peak load factor, g</th>
            {isHot && <th scope="col">Peak heat flux, kW/m²</th>}
            <th scope="col">
              <span class="hidden">Take</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {rows.map((row, index) => (
            <tr key={row.values.join(' ')}>
              <th scope="row">
                <span class={`swatch run-${index < shown.runs.length ? index + 1 : 0}`} />
                {index + 1}
              </th>
              {numbers.map((one, place) => (
                <td key={one.label}>{valueInWords(one, row.values[place] ?? Number.NaN, answer.angle_unit, angleUnit.value)}</td>
              ))}
              <td>{number(row.final_state.time, 6)}</td>
              <td>{number(row.peaks.load_factor.value, 4)}</td>
              {isHot && <td>{number((row.peaks.heat_flux?.value ?? Number.NaN) / 1e3, 4)}</td>}
              <td>
                <button
                  type="button"
                  class="small"
                  aria-label={`Take ${answer.solutions.length > 0 ? `solution ${index + 1}` : 'the nearest'} into the case`}
                  onClick={() => {
                    draft.value = taken(draft.peek(), row);
                  }}
                >
                  Take
                </button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}

/** The limits of a corridor or a footprint that are not goals, in words. */
function Limits() {
  const limits = draft.value.limits ?? [];
  if (limits.length === 0) return null;
  return (
    <div class="free">
      <span>Limits</span>
      {limits.map((limit, index) => (
        <span class="chip" key={`${limits.length}-${index}`}>
          {limitInWords(draft.value, limit, angleUnit.value)}
          <button
            type="button"
            class="small"
            aria-label={`Remove limit ${index + 1}`}
            onClick={() => {
              const rest = limits.filter((_, other) => other !== index);
              draft.value = set(draft.peek(), ['limits'], rest.length > 0 ? rest : undefined);
            }}
          >
            ×
          </button>
        </span>
      ))}
    </div>
  );
}

/** The corridor, in words. */
function Band() {
  const corridor = allowed.value;
  if (!corridor) return null;
  const own = numberAt(draft.value, pathOf(draft.value, corridor.pointer));
  const written = (value: number) => valueInWords(own, value, caseUnit.value, angleUnit.value);
  const bands = corridor.bands.map(({ from, to }) => `${written(from)} to ${written(to)}`);
  return (
    <p>
      {bands.length === 0
        ? `No ${own.label.toLowerCase()} within its bounds keeps the limits.`
        : `${own.label} that keeps the limits: ${bands.join(', ')}.`}
    </p>
  );
}
