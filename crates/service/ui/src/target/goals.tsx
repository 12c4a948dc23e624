import type { Goal } from '../api';
import { get, legible, type Path, set, turned } from '../case';
import { number } from '../figures';
import { NumberInput, type Reading } from '../form/inputs';
import { angles, put } from '../form/line';
import { type Name, QUANTITIES, scaleOf, unitOf } from '../quantities';
import { angleUnit, caseUnit, current, draft } from '../store';
import { bodiesOf, goalOn, namesOf } from './bodies';
import { isAiming } from './place';
import { missesOf } from './request';
import { found } from './solve';

/** What is to be achieved: a row each. */
export function Goals() {
  const goals = draft.value.achieve ?? [];
  return (
    <ul class="goals" aria-label="Goals">
      {goals.map((goal, index) => (
        <li key={`${goals.length}-${index}`}>
          {'site' in goal ? (
            <PlaceGoal index={index} />
          ) : 'quantity' in goal ? (
            <QuantityGoal index={index} goal={goal} />
          ) : (
            <Ends goal={goal} />
          )}
          <Whose index={index} goal={goal} />
          <button type="button" class="small" aria-label={`Remove goal ${index + 1}`} onClick={() => removed(index)}>
            ×
          </button>
        </li>
      ))}
    </ul>
  );
}

/** Of whose flight a goal is, where bodies leave the vehicle. */
function Whose({ index, goal }: { index: number; goal: Goal }) {
  const bodies = bodiesOf(draft.value.events);
  const { body } = goal as { body?: string };
  if (bodies.length === 0 && body === undefined) return null;
  const names = bodies.map(({ name }) => name);
  return (
    <select
      aria-label={`Body of goal ${index + 1}`}
      value={body ?? ''}
      onChange={(event) => put(['achieve', index], goalOn(event.currentTarget.value, goal))}
    >
      <option value="">of the vehicle</option>
      {(body === undefined || names.includes(body) ? names : [...names, body]).map((name) => (
        <option key={name} value={name}>
          of {name}
        </option>
      ))}
    </select>
  );
}

function removed(index: number): void {
  const rest = (draft.peek().achieve ?? []).filter((_, other) => other !== index);
  put(['achieve'], rest.length > 0 ? rest : undefined);
}

/** An input of a goal, which shows no faults of its own: the panel has them. */
function Value({ label, path, reading }: { label: string; path: Path; reading?: Reading | undefined }) {
  return (
    <NumberInput
      id={`goal-${path.join('-')}`}
      isBad={false}
      label={label}
      value={get(draft.value, path) as number | undefined}
      reading={reading}
      onValue={(next) => put(path, next)}
    />
  );
}

/** A place to end at: by its coordinates, or on the map. */
function PlaceGoal({ index }: { index: number }) {
  const path = ['achieve', index];
  const site = get(draft.value, [...path, 'site']);
  const isWithin = get(draft.value, [...path, 'within']) !== undefined;
  const [given, other] = isWithin ? ['within', 'tolerance'] : ['tolerance', 'within'];
  const unit = angleUnit.value === 'deg' ? '°' : 'rad';
  return (
    <>
      <span>Land at</span>
      {typeof site === 'string' ? (
        <code>{site}</code>
      ) : (
        <>
          <Value label="Target latitude" path={[...path, 'site', 'geodetic_latitude']} reading={angles.value} />
          <Value label="Target longitude" path={[...path, 'site', 'longitude']} reading={angles.value} />
          <span class="unit">{unit}</span>
        </>
      )}
      <button
        type="button"
        class="small"
        aria-pressed={isAiming.value}
        onClick={() => {
          isAiming.value = !isAiming.value;
        }}
      >
        Pick on map
      </button>
      <select
        aria-label="Kind of goal"
        value={given}
        onChange={() => {
          const value = get(draft.peek(), [...path, given as string]);
          put(path, set(set(get(draft.peek(), path), [given as string], undefined), [other as string], value));
        }}
      >
        <option value="tolerance">exactly, tolerance</option>
        <option value="within">anywhere within</option>
      </select>
      <Value label={isWithin ? 'Greatest distance' : 'Tolerance'} path={[...path, given as string]} />
      <span class="unit">m</span>
    </>
  );
}

const RELATIONS = { equals: '=', at_least: 'at least', at_most: 'at most', between: 'between' } as const;
type Relation = keyof typeof RELATIONS;

/** How numbers of a quantity are read and typed: in the unit of the plots. */
function readingOf(name: Name): Reading {
  const [own, reader] = [caseUnit.value, angleUnit.value];
  if (QUANTITIES[name].angle) return { shown: (value) => legible(value, own, reader), stored: (value) => turned(value, reader, own) };
  const scale = scaleOf(name, reader);
  const by = (factor: number) => (value: unknown) => (typeof value === 'number' ? Number((value * factor).toPrecision(14)) : value);
  return { shown: by(scale), stored: by(1 / scale) };
}

/** A value or a range of a quantity at a moment. */
function QuantityGoal({ index, goal }: { index: number; goal: Goal }) {
  const path = ['achieve', index];
  const name = goal.quantity as Name;
  const relation = (Object.keys(RELATIONS) as Relation[]).find((key) => key in goal) ?? 'equals';
  const reading = readingOf(name);
  const unit = unitOf(name, angleUnit.value);
  const label = QUANTITIES[name]?.label ?? name;
  const { at = 'end', body } = goal as { at?: unknown; body?: string };
  const ofBody = bodiesOf(draft.value.events).find(({ name }) => name === body);
  const events = namesOf(body === undefined ? draft.value.events : ofBody?.events);
  const moments: [string, unknown][] = [
    ['at the end', 'end'],
    ['at the start', 'start'],
    ['greatest', 'peak'],
    ['least', 'lowest'],
    ...events.flatMap((event): [string, unknown][] => [
      [`before ${event}`, { event, side: 'before' }],
      [`after ${event}`, { event, side: 'after' }],
    ]),
  ];
  const ends = relation === 'between' ? [0, 1].map((end) => ['between', end]) : [[relation]];
  return (
    <>
      <select
        aria-label="Quantity"
        value={name}
        onChange={(event) => put(path, { ...startOf(event.currentTarget.value as Name), ...(body === undefined ? {} : { body }) })}
      >
        {(Object.keys(QUANTITIES) as Name[]).map((other) => (
          <option key={other} value={other}>
            {QUANTITIES[other].label}
          </option>
        ))}
      </select>
      <select
        aria-label={`Moment of ${label}`}
        value={JSON.stringify(at)}
        onChange={(event) => put([...path, 'at'], JSON.parse(event.currentTarget.value))}
      >
        {moments.map(([title, moment]) => (
          <option key={title} value={JSON.stringify(moment)}>
            {title}
          </option>
        ))}
      </select>
      <select
        aria-label={`Relation of ${label}`}
        value={relation}
        onChange={(event) => put(path, related(goal, relation, event.currentTarget.value as Relation))}
      >
        {Object.entries(RELATIONS).map(([key, title]) => (
          <option key={key} value={key}>
            {title}
          </option>
        ))}
      </select>
      {ends.map((end, place) => (
        <Value
          key={end.join('-')}
          label={['Value of', 'Greatest'][place] === 'Greatest' ? `Greatest ${label}` : `Value of ${label}`}
          path={[...path, ...end]}
          reading={reading}
        />
      ))}
      <span class="unit">{unit}</span>
      {relation === 'equals' && (
        <>
          <span class="quiet">±</span>
          <Value label={`Tolerance of ${label}`} path={[...path, 'tolerance']} reading={reading} />
        </>
      )}
      <Reach index={index} name={name} />
    </>
  );
}

/** What flights of the search give of a quantity. */
function Reach({ index, name }: { index: number; name: Name }) {
  const shown = found.value;
  const before = shown?.asked.achieve?.slice(0, index).reduce((sum, goal) => sum + missesOf(goal), 0) ?? 0;
  const reach = shown && shown.asked.achieve?.[index] === draft.value.achieve?.[index] ? shown.answer.reach[before] : null;
  if (!reach) return null;
  const { shown: read } = readingOf(name);
  const [least, greatest] = [reach.least, reach.greatest].map((value) => number(Number(read(value)), 4));
  return <span class="quiet">{`flights give ${least} to ${greatest}`}</span>;
}

/** The same goal in another relation. */
function related(goal: Goal, from: Relation, to: Relation): unknown {
  const { [from]: old, tolerance, ...rest } = goal as Record<string, unknown>;
  const value = Number(Array.isArray(old) ? old[from === 'between' ? 1 : 0] : old) || 0;
  const width = Math.abs(value) / 10 || 1;
  const wanted = to === 'between' ? [value - width, value + width] : value;
  return { ...rest, [to]: wanted, ...(to === 'equals' && tolerance !== undefined ? { tolerance } : {}) };
}

/** What a goal on a quantity begins with: what the flight has now. */
export function startOf(name: Name): Goal {
  const flight = current.peek()?.flight;
  const peaks = flight?.answer.peaks as Partial<Record<string, { value: number } | null>> | undefined;
  const peak = ['load_factor', 'deceleration', 'dynamic_pressure', 'wall_temperature', 'heat_load'].includes(name)
    ? peaks?.[name]
    : undefined;
  if (peak) return { quantity: name, at: 'peak', at_most: Number(peak.value.toPrecision(3)) } as unknown as Goal;
  const final = flight?.final[name] ?? 0;
  const own = QUANTITIES[name].angle ? (turned(final, 'deg', caseUnit.peek()) as number) : final;
  return { quantity: name, equals: Number(own.toPrecision(4)) } as unknown as Goal;
}

function Ends({ goal }: { goal: Goal }) {
  const ends = (goal as { termination?: unknown[] }).termination;
  return <span>Ends with {Array.isArray(ends) ? ends.join(' or ').replaceAll('_', ' ') : '?'}</span>;
}
