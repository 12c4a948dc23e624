import schema from 'virtual:schema';
import { useState } from 'preact/hooks';
import { address, type Case, type InitialState } from '../api';
import { get, inUnit, type Path, pointer } from '../case';
import { capital } from '../figures';
import { chapterOf } from '../guide';
import { bodyIn, isBody, modelOf } from '../planets';
import type { AngleUnit } from '../quantities';
import { angleUnit, caseUnit, draft, problem } from '../store';
import { eventInWords } from './effects';
import { CONVECTIVE, type Field, type Fields, kindOf, SCHEDULE, SECTIONS, SINCE, SUTTON_GRAVES, THRUST } from './fields';
import { exchanged, forget, settled } from './held';
import { NumberInput, RowsInput, TextInput } from './inputs';
import { Json } from './json';
import { angles, Block, Faults, helpOf, idOf, inputOf, isAngle, isWithin, Line, put, select, unitOf } from './line';
import { Parts } from './parts';
import { LaunchPlace } from './place';
import { settle } from './planet';
import { Bounds, RoleChoice } from './role';
import type { Property } from './schema';
import { rename, retype } from './state';

/** The parts of a case, as they are folded. */
const FOLDS: [string, (keyof Case)[]][] = [
  ['Vehicle', ['vehicle']],
  ['Initial state', ['initial_state', 'epoch']],
  ['Control', ['control']],
  ['Atmosphere and wind', ['atmosphere', 'density_factor', 'wind']],
  ['Planet', ['planet']],
  ['Heating', ['heating']],
  ['Events', ['events']],
  ['Stop conditions', ['stop']],
  ['Solver and output', ['solver', 'sensitivities', 'verify', 'output', 'echo', 'angle_unit']],
];

/** The form of the whole case. */
export function Form() {
  return (
    <form class="form" aria-label="Case" onSubmit={(event) => event.preventDefault()}>
      {FOLDS.map(([title, names], index) => (
        <Fold key={title} title={title} names={names} isOpen={index < 3} />
      ))}
    </form>
  );
}

function Fold({ title, names, isOpen }: { title: string; names: (keyof Case)[]; isOpen: boolean }) {
  const faults = (problem.value?.errors ?? []).filter((error) => names.some((name) => isWithin(error.pointer, pointer([name]))));
  const isUsed = names.some((name) => draft.value[name] !== undefined);
  return (
    <details class="fold" open={isOpen}>
      <summary>
        <span>{title}</span>
        {faults.length > 0 ? (
          <span class="badge bad">{faults.length === 1 ? '1 problem' : `${faults.length} problems`}</span>
        ) : (
          !isUsed && <span class="badge">default</span>
        )}
      </summary>
      <div class="fold-body">
        <p class="quiet fold-guide">
          Guide:
          {names.map((name) => (
            <a key={name} href={address(chapterOf(pointer([name])))} target="_blank" rel="noopener">
              {name.replaceAll('_', ' ')}
            </a>
          ))}
        </p>
        {names.includes('atmosphere') && <p class="settled">{settlement()}</p>}
        {names.map((name) => (
          <Item
            key={name}
            field={SECTIONS[name]}
            path={[name]}
            property={schema.SimulateRequest?.properties?.[name]}
            isBare={names.length === 1}
          />
        ))}
        {names.includes('planet') && (
          <output class="settled" aria-live="polite">
            {settlement()}
          </output>
        )}
      </div>
    </details>
  );
}

/** What the choice of a planet changed beside itself, as long as the case has that planet. */
function settlement(): string {
  const now = settled.value;
  return now && now.model === modelOf(draft.value) ? now.changes.join(' ') : '';
}

interface ItemProps {
  field: Field;
  path: Path;
  property?: Property | undefined;
  /** Without its own heading: the fold has it. */
  isBare?: boolean;
  /** What an input is called that has no label of its own. */
  name?: string | undefined;
}

/** A field of a form. */
function Item({ field, path, property, isBare = false }: ItemProps) {
  const value = get(draft.value, path);
  switch (field.kind) {
    case 'number':
    case 'text':
    case 'words':
    case 'flag':
    case 'numbers':
      return (
        <Line
          label={field.kind === 'numbers' && unitOf(field) ? `${field.label}, ${unitOf(field)}` : field.label}
          path={path}
          property={property}
          unit={field.kind === 'numbers' ? undefined : unitOf(field, path)}
          role={field.kind === 'number' && <RoleChoice label={field.label} path={path} property={property} />}
          below={field.kind === 'number' && <Bounds label={field.label} path={path} isAngle={isAngle(field, path)} />}
        >
          <Control field={field} path={path} property={property} />
        </Line>
      );
    case 'json':
      return (
        <div>
          <Json label={`${field.label} (JSON)`} path={path} />
          <Faults path={path} isWhole />
        </div>
      );
    case 'site':
      return <LaunchPlace path={path} />;
    case 'parts':
      return <Parts path={path} />;
    case 'vector':
      return <Vector label={field.label} unit={field.unit} path={path} property={property} />;
    case 'matrix':
      return (
        <Block label={field.label} path={path} property={property}>
          <RowsInput
            {...inputOf(path, true, property)}
            value={(value as unknown[][] | undefined) ?? []}
            onValue={(rows) => put(path, rows)}
          />
        </Block>
      );
    case 'several':
      return <Several label={field.label} words={field.words} path={path} property={property} />;
    case 'group':
      return <Group field={field} path={path} property={property} isBare={isBare} />;
    case 'variant':
      return <Variant field={field} path={path} property={property} />;
    case 'command':
      return <Command label={field.label} path={path} property={property} />;
    case 'along':
      return <Along label={field.label} words={field.words} path={path} property={property} />;
    case 'variable':
      return <Variable label={field.label} words={field.words} path={path} property={property} />;
    case 'names':
      return (
        <Line label={field.label} path={path} property={property}>
          <TextInput
            {...inputOf(path, true, property)}
            value={(value as string[] | undefined)?.join(', ')}
            placeholder={field.hint}
            onValue={(names) =>
              put(
                path,
                names?.split(',').map((name) => name.trim()),
              )
            }
          />
        </Line>
      );
    case 'convective':
      return <Convective label={field.label} path={path} property={property} />;
    case 'thrust':
      return <Thrust label={field.label} path={path} property={property} />;
    case 'list':
      return <List field={field} path={path} property={property} isBare={isBare} />;
    case 'column':
      return null;
  }
}

/** The input of a field that fits a line. */
function Control({ field, path, property, name }: ItemProps) {
  const value = get(draft.value, path);
  const input = { ...inputOf(path, field.kind === 'numbers', property), label: name };
  const placeholder = property?.default === undefined ? ownOf(path) : String(property.default);
  switch (field.kind) {
    case 'number':
      return (
        <NumberInput
          {...input}
          value={value as number | string | undefined}
          placeholder={placeholder}
          reading={isAngle(field, path) ? angles.value : undefined}
          onValue={(next) => put(path, next)}
        />
      );
    case 'text':
      return (
        <TextInput
          {...input}
          value={value as string | undefined}
          placeholder={field.hint ?? placeholder}
          onValue={(next) => put(path, next)}
        />
      );
    case 'words':
      return <Words words={field.words} path={path} property={property} name={name} />;
    case 'flag':
      return (
        <input
          id={input.id}
          type="checkbox"
          checked={(value ?? property?.default) === true || (field.orObject === true && typeof value === 'object')}
          onChange={(event) => {
            const { checked } = event.currentTarget;
            put(path, checked === (property?.default === true) ? undefined : checked);
          }}
        />
      );
    case 'numbers':
      return (
        <RowsInput
          {...input}
          rows={1}
          value={listed(value).length > 0 ? [isAngle(field) ? listed(value).map(angles.value.shown) : listed(value)] : []}
          onValue={(rows) => put(path, unlisted(isAngle(field) ? rows.flat().map(angles.value.stored) : rows.flat(), field.orOne === true))}
        />
      );
    default:
      return null;
  }
}

/** What holds in place of a number without a default of its own: the coefficients of the planet, where they are known. */
function ownOf(path: Path): string | undefined {
  const model = modelOf(draft.value);
  return /^\/planet\/gravity\/j\d$/.test(pointer(path)) && model !== 'custom' ? `that of ${bodyIn(model)}` : undefined;
}

/** The numbers of a list, or one that stands alone. */
function listed(value: unknown): unknown[] {
  return Array.isArray(value) ? value : value === undefined ? [] : [value];
}

/** A list; where a single number may stand alone it does, and without a number there is nothing. */
function unlisted(numbers: unknown[], orOne: boolean): unknown {
  return orOne && numbers.length < 2 ? numbers[0] : numbers;
}

function Words({
  words,
  path,
  property,
  name,
}: {
  words: Record<string, string>;
  path: Path;
  property?: Property | undefined;
  name?: string | undefined;
}) {
  const value = get(draft.value, path);
  const isDefault = property?.default !== undefined;
  const names = Object.keys(words);
  if (names.length === 0) return <span class="unit">no rows</span>;
  return (
    <select
      {...select(path)}
      aria-label={name}
      value={String(value ?? property?.default ?? '')}
      onChange={(event) => {
        const next = event.currentTarget.value;
        // Another unit is another way to write the same case.
        if (path[0] === 'angle_unit') draft.value = inUnit(draft.peek(), next as AngleUnit);
        else if (pointer(path) === '/planet/model') settle(next);
        else put(path, next);
      }}
    >
      {value === undefined && !isDefault && <option value="">Choose …</option>}
      {names.map((name) => (
        <option key={name} value={name}>
          {words[name]}
        </option>
      ))}
    </select>
  );
}

function Vector({ label, unit, path, property }: { label: string; unit: string; path: Path; property?: Property | undefined }) {
  return (
    <fieldset class="vector" title={helpOf(property)}>
      <legend>
        {label}, {unit}
      </legend>
      {['x', 'y', 'z'].map((axis, index) => (
        <NumberInput
          key={axis}
          {...inputOf([...path, index], false)}
          label={`${label} ${axis}`}
          placeholder={axis}
          value={get(draft.value, [...path, index]) as number | undefined}
          onValue={(next) => put(path, replaced(get(draft.peek(), path), index, next))}
        />
      ))}
      <Faults path={path} isWhole />
    </fieldset>
  );
}

/** Three numbers with another in one place; what is missing is null, of which the service says that it is no number. */
function replaced(vector: unknown, index: number, value: unknown): unknown[] {
  const old = Array.isArray(vector) ? vector : [];
  return [0, 1, 2].map((at) => (at === index ? (value ?? null) : (old[at] ?? null)));
}

function Several({
  label,
  words,
  path,
  property,
}: {
  label: string;
  words: readonly string[];
  path: Path;
  property?: Property | undefined;
}) {
  const chosen = (get(draft.value, path) as string[] | undefined) ?? [];
  const toggle = (word: string, isOn: boolean) => {
    const next = isOn ? [...chosen, word] : chosen.filter((other) => other !== word);
    put(path, next.length > 0 ? next : undefined);
  };
  return (
    <details class="several" title={helpOf(property)}>
      <summary>
        {label}: {chosen.length === 0 ? 'all' : `${chosen.length} selected`}
      </summary>
      {words.map((word) => (
        <label key={word} class="check">
          <input type="checkbox" checked={chosen.includes(word)} onChange={(event) => toggle(word, event.currentTarget.checked)} />
          <code>{word}</code>
        </label>
      ))}
    </details>
  );
}

type GroupProps = Omit<ItemProps, 'field'> & { field: Extract<Field, { kind: 'group' }> };

function Group({ field, path, isBare }: GroupProps) {
  const isThere = get(draft.value, path) !== undefined;
  const body = (!field.isOptional || isThere) && <Members fields={field.fields} schema={field.schema} path={path} />;
  const toggle = (isOn: boolean) =>
    put(path, isOn ? exchanged(path, 'off', 'on', emptyOf(field)) : exchanged(path, 'on', 'off', undefined));
  const box = field.isOptional && (
    <label class="check">
      <input type="checkbox" checked={isThere} onChange={(event) => toggle(event.currentTarget.checked)} />
      {field.isOptional}
    </label>
  );
  if (isBare || field.isOptional)
    return (
      <div class="group">
        {box}
        {body}
        <Faults path={path} />
      </div>
    );
  return (
    <fieldset class="group">
      <legend>{field.label}</legend>
      {body}
      <Faults path={path} />
    </fieldset>
  );
}

/** What an optional group begins with: an impulse needs its direction. */
function emptyOf(field: Extract<Field, { kind: 'group' }>): object {
  return 'along' in field.fields ? { along: 'velocity' } : {};
}

/** The fields of a schema: alternatives in one line, columns of one table side by side. */
function Members({ fields, schema: name, path }: { fields: Fields; schema: string; path: Path }) {
  const properties = schema[name]?.properties ?? {};
  const isNeeded = isAsked(name, fields, path);
  const done = new Set<string>();
  return (
    <>
      {Object.entries(fields).map(([key, field]) => {
        if (done.has(key) || !isNeeded(key)) return null;
        const together = groupOf(fields, field).filter(isNeeded);
        for (const other of together) done.add(other);
        if (field.kind === 'column') return <Table key={key} fields={fields} names={together} path={path} />;
        if ('choice' in field && field.choice)
          return <Choice key={field.choice} fields={fields} names={together} path={path} schema={name} />;
        return <Item key={key} field={field} path={[...path, key]} property={properties[key]} />;
      })}
    </>
  );
}

/** Fields that have a meaning only beside others: the numbers of a planet that is custom, the area but with a ballistic coefficient. */
function isAsked(schemaName: string, fields: Fields, path: Path): (name: string) => boolean {
  const own = get(draft.value, path) as Record<string, unknown> | undefined;
  if (schemaName === 'Planet') {
    const isCustom = own?.model === 'custom';
    return (name) => isCustom || ['model', 'shape', 'gravity'].includes(name) || own?.[name] !== undefined;
  }
  if (schemaName === 'Vehicle') {
    const isBallistic = get(own, ['aerodynamics', 'type']) === 'ballistic';
    return (name) => name !== 'reference_area' || !isBallistic || own?.[name] !== undefined;
  }
  const hasParts = get(draft.value, ['vehicle', 'parts']) !== undefined;
  const others = (hasParts ? OF_PARTS.without : OF_PARTS.with)[schemaName];
  if (others) return (name) => !others.includes(name) || own?.[name] !== undefined;
  if (schemaName === 'Launch') return (name) => own?.site === undefined || !LAUNCH_PLACE.includes(name) || own[name] !== undefined;
  if (schemaName === 'ProgramSteering') {
    const asked = ['frame', ...(ANGLES_OF_FRAME[String(own?.frame)] ?? [])];
    return (name) => asked.includes(name) || own?.[name] !== undefined;
  }
  // A wind is given by its components, or by its speed and direction.
  if (fields.east && fields.speed) {
    const given = (names: string[]) => names.some((name) => own?.[name] !== undefined);
    if (given(['speed', 'from'])) return (name) => !['east', 'north'].includes(name) || own?.[name] !== undefined;
    if (fields.altitude || given(['east', 'north'])) return (name) => !['speed', 'from'].includes(name);
  }
  return () => true;
}

/** The fields that a vehicle has a use for only with parts, and only without. */
const OF_PARTS: Record<'with' | 'without', Record<string, string[]>> = {
  with: {
    Control: ['steering'],
    Condition: ['burnout'],
    Effect: ['ignite', 'shut_down', 'throttle', 'load_limit', 'steer', 'tilt', 'separate'],
  },
  without: { Effect: ['mass', 'thrust'] },
};
const LAUNCH_PLACE = ['geodetic_latitude', 'longitude', 'geodetic_altitude'];
/** The angles of a steering program, by its frame. */
const ANGLES_OF_FRAME: Record<string, string[]> = {
  launch: ['pitch', 'yaw'],
  local: ['pitch', 'azimuth'],
  inertial: ['right_ascension', 'declination'],
};

function groupOf(fields: Fields, field: Field): string[] {
  const key = field.kind === 'column' ? field.table : 'choice' in field ? field.choice : undefined;
  if (!key) return [];
  return Object.keys(fields).filter((name) => {
    const other = fields[name] as Field;
    return field.kind === 'column' ? other.kind === 'column' && other.table === key : 'choice' in other && other.choice === key;
  });
}

/** Exactly one of several fields: its label chooses which. */
function Choice({ fields, names, path, schema: of }: { fields: Fields; names: string[]; path: Path; schema: string }) {
  const given = names.find((name) => get(draft.value, [...path, name]) !== undefined);
  const [chosen, choose] = useState(names[0] as string);
  const name = given ?? chosen;
  const field = fields[name] as Field;
  const property = schema[of]?.properties?.[name];
  const change = (next: string) => {
    choose(next);
    if (path[0] === 'initial_state' && given) void rename(given, next);
    else if (given) put(path, swapped(path, given, next, fields[next] as Field));
    else put([...path, next], startOf(fields[next] as Field, undefined));
  };
  const label = (
    <select
      class="choice"
      aria-label={names.map((other) => (fields[other] as Field).label).join(' or ')}
      value={name}
      onChange={(event) => change(event.currentTarget.value)}
    >
      {names.map((other) => (
        <option key={other} value={other}>
          {(fields[other] as Field).label}
        </option>
      ))}
    </select>
  );
  if (field.kind === 'list' || field.kind === 'parts')
    return (
      <div class="block">
        {label}
        <Item field={field} path={[...path, name]} property={property} isBare />
      </div>
    );
  return (
    <Line
      label={label}
      path={[...path, name]}
      property={property}
      unit={unitOf(field, [...path, name])}
      role={field.kind === 'number' && <RoleChoice label={field.label} path={[...path, name]} property={property} />}
      below={field.kind === 'number' && <Bounds label={field.label} path={[...path, name]} isAngle={isAngle(field, [...path, name])} />}
    >
      <Control field={field} path={[...path, name]} property={property} name={field.label} />
    </Line>
  );
}

/** A part with one field in place of another: a number stays, anything else comes back as it was. */
function swapped(path: Path, from: string, to: string, field: Field): unknown {
  const { [from]: old, ...others } = get(draft.peek(), path) as Record<string, unknown>;
  const start = startOf(field, old);
  const staysNumber = field.kind === 'number' && typeof old !== 'object';
  return { ...others, [to]: staysNumber ? start : exchanged(path, from, to, start, old) };
}

/** What a field begins with that takes another's place. */
function startOf(field: Field, old: unknown): unknown {
  if (field.kind === 'number') return typeof old === 'number' ? old : '';
  if (field.kind === 'list') return [field.empty];
  if (field.kind === 'parts') return [{ name: 'vehicle', dry_mass: old }];
  if (field.kind === 'words') return Object.keys(field.words)[0] ?? false;
  return field.kind === 'numbers' ? [] : '';
}

/** Columns of as many numbers, edited as the rows of a table. */
function Table({ fields, names, path }: { fields: Fields; names: string[]; path: Path }) {
  const readings = names.map((name) => (isAngle(fields[name] as Field) ? angles.value : undefined));
  const columns = names.map((name, index) => {
    const own = (get(draft.value, [...path, name]) as unknown[] | undefined) ?? [];
    return readings[index] ? own.map(readings[index].shown) : own;
  });
  const length = Math.max(...columns.map((column) => column.length));
  const filled = columns.filter((column, index) => index === 0 || column.length > 0);
  const rows = Array.from({ length }, (_, row) => filled.map((column) => column[row]));
  const titles = names.map((name) => {
    const field = fields[name] as Field;
    const unit = unitOf(field);
    return unit ? `${field.label}, ${unit}` : field.label;
  });
  const store = (next: unknown[][]) => {
    const width = Math.max(0, ...next.map((cells) => cells.length));
    const written = names.slice(0, Math.max(width, 2)).map((name, index) => {
      const cells = next.map((row) => row[index]).filter((cell) => cell !== undefined);
      return [name, readings[index] ? cells.map(readings[index].stored) : cells];
    });
    const { ...part } = get(draft.peek(), path) as Record<string, unknown>;
    for (const name of names) delete part[name];
    put(path, { ...part, ...Object.fromEntries(written) });
  };
  const first = [...path, names[0] as string];
  return (
    <div class="block">
      <label for={idOf(first)}>{titles.join(' | ')}</label>
      <RowsInput {...inputOf(first, true)} value={rows} onValue={store} />
      {names.map((name) => (
        <Faults key={name} path={[...path, name]} isWhole />
      ))}
    </div>
  );
}

type VariantProps = Omit<ItemProps, 'field'> & { field: Extract<Field, { kind: 'variant' }> };

/** One of several kinds. The initial state keeps what it is where its coordinate system changes. */
function Variant({ field, path, property }: VariantProps) {
  const type = get(draft.value, [...path, 'type']) as string | undefined;
  const kind = kindOf(field.kinds, type);
  const change = (next: string) => {
    if (path[0] === 'initial_state') void retype(next as InitialState['type']);
    else put(path, exchanged(path, type ?? '', next, next === '' ? undefined : { type: next }));
  };
  return (
    <div class="group">
      <Line label={path[0] === 'initial_state' ? 'Coordinates' : field.label} path={[...path, 'type']} property={property}>
        <select {...select([...path, 'type'])} value={type ?? ''} onChange={(event) => change(event.currentTarget.value)}>
          {(field.none !== undefined || kind === undefined) && <option value="">{noneOf(field, path) ?? 'Choose …'}</option>}
          {Object.entries(field.kinds).map(([name, { label }]) => (
            <option key={name} value={name}>
              {label}
            </option>
          ))}
        </select>
      </Line>
      <Faults path={path} />
      {kind && <Members key={type} fields={kind.fields} schema={kind.schema} path={path} />}
    </div>
  );
}

/** What it is called that there is no choice: for the atmosphere, which one is used then. */
function noneOf(field: VariantProps['field'], path: Path): string | undefined {
  const model = modelOf(draft.value);
  return path[0] === 'atmosphere' && isBody(model) ? `Standard of ${bodyIn(model)} (default)` : field.none;
}

/** An angle, or a schedule of it. */
function Command({ label, path, property }: { label: string; path: Path; property?: Property | undefined }) {
  const value = get(draft.value, path);
  const isSchedule = typeof value === 'object' && value !== null;
  const toggle = (isOn: boolean) =>
    put(
      path,
      isOn
        ? exchanged(path, 'number', 'schedule', {
            type: 'schedule',
            against: 'time',
            at: [0],
            value: [typeof value === 'number' ? value : 0],
          })
        : exchanged(path, 'schedule', 'number', get(value, ['value', 0])),
    );
  return (
    <div class="group">
      <div class="line" title={helpOf(property)}>
        <label for={idOf(path)}>{label}</label>
        {isSchedule ? (
          <span class="unit">see schedule below</span>
        ) : (
          <Control field={{ kind: 'number', label, isAngle: true }} path={path} property={property} />
        )}
        {!isSchedule && (
          <span class="unit">
            {unitOf({ kind: 'number', label, isAngle: true })}
            <RoleChoice label={label} path={path} property={property ?? { default: 0 }} />
          </span>
        )}
        {!isSchedule && <Bounds label={label} path={path} isAngle />}
        <Faults path={path} />
      </div>
      <label class="check">
        <input type="checkbox" checked={isSchedule} onChange={(event) => toggle(event.currentTarget.checked)} />
        {label} schedule
      </label>
      {isSchedule && <Members fields={SCHEDULE.fields} schema={SCHEDULE.schema} path={path} />}
    </div>
  );
}

/** A correlation for air, or the constant of another gas. */
function Convective({ label, path, property }: { label: string; path: Path; property?: Property | undefined }) {
  const value = get(draft.value, path);
  const isOfGas = typeof value === 'object' && value !== null;
  const change = (next: string) => put(path, next === 'gas' ? { type: 'sutton_graves' } : next);
  return (
    <div class="group">
      <Line label={label} path={path} property={property}>
        <select
          {...select(path)}
          value={isOfGas ? 'gas' : String(value ?? property?.default ?? '')}
          onChange={(event) => change(event.currentTarget.value)}
        >
          {Object.entries(CONVECTIVE).map(([name, title]) => (
            <option key={name} value={name}>
              {title}
            </option>
          ))}
          <option value="gas">Sutton–Graves, other gas</option>
        </select>
      </Line>
      {isOfGas && <Members fields={SUTTON_GRAVES} schema="SuttonGraves" path={path} />}
    </div>
  );
}

/** Another thrust, or none any more. */
function Thrust({ label, path, property }: { label: string; path: Path; property?: Property | undefined }) {
  const value = get(draft.value, path);
  const state = value === undefined ? '' : value === 'off' ? 'off' : 'on';
  const starts: Record<string, unknown> = { '': undefined, off: 'off', on: { along: 'velocity' } };
  const change = (next: string) => put(path, exchanged(path, state, next, starts[next]));
  return (
    <div class="group">
      <Line label={label} path={path} property={property}>
        <select {...select(path)} value={state} onChange={(event) => change(event.currentTarget.value)}>
          <option value="">Unchanged</option>
          <option value="on">On</option>
          <option value="off">Off</option>
        </select>
      </Line>
      {state === 'on' && <Members fields={THRUST} schema="Thrust" path={path} />}
    </div>
  );
}

interface AlongProps {
  label: string;
  words: Record<string, string>;
  path: Path;
  property?: Property | undefined;
}

/** One of several words, or Fixed inertial direction. */
function Along({ label, words, path, property }: AlongProps) {
  const value = get(draft.value, path);
  const isInertial = typeof value === 'object' && value !== null;
  const start = { frame: 'inertial', direction: [0, 0, 1] };
  const change = (next: string) => put(path, next === 'inertial' ? start : next);
  return (
    <div class="group">
      <Line label={label} path={path} property={property}>
        <select
          {...select(path)}
          value={isInertial ? 'inertial' : String(value ?? '')}
          onChange={(event) => change(event.currentTarget.value)}
        >
          {value === undefined && <option value="">Choose …</option>}
          {Object.entries(words).map(([word, meaning]) => (
            <option key={word} value={word}>
              {meaning}
            </option>
          ))}
          <option value="inertial">Fixed inertial direction</option>
        </select>
      </Line>
      {isInertial && <Vector label="Inertial direction" unit="any length" path={[...path, 'direction']} />}
    </div>
  );
}

/** What a schedule runs along: a quantity, or the time since an event, by its name. */
function Variable({ label, words, path, property }: AlongProps) {
  const value = get(draft.value, path);
  const isSince = typeof value === 'object' && value !== null;
  const change = (next: string) => put(path, next === 'since' ? {} : next);
  return (
    <div class="group">
      <Line label={label} path={path} property={property}>
        <select {...select(path)} value={isSince ? 'since' : String(value ?? '')} onChange={(event) => change(event.currentTarget.value)}>
          {value === undefined && <option value="">Choose …</option>}
          {Object.entries(words).map(([word, meaning]) => (
            <option key={word} value={word}>
              {meaning}
            </option>
          ))}
          <option value="since">Time since event, s</option>
        </select>
      </Line>
      {isSince && <Members fields={SINCE} schema="SinceEvent" path={path} />}
    </div>
  );
}

type ListProps = Omit<ItemProps, 'field'> & { field: Extract<Field, { kind: 'list' }> };

/** A long list is shown so many elements at a time: the page would stand still as long as it makes the forms of thousands. */
const SHOWN = 100;
/** So many elements that are told in a line stand open. */
const OPEN = 2;

function List({ field, path, isBare }: ListProps) {
  const [most, setMost] = useState(SHOWN);
  const [added, add] = useState(-1);
  const items = (get(draft.value, path) as unknown[] | undefined) ?? [];
  return (
    <div class="list">
      {!isBare && <p class="list-title">{field.label}</p>}
      <Faults path={path} />
      {items.slice(0, most).map((item, index) => (
        <ListItem
          key={`${items.length}-${index}`}
          field={field}
          path={[...path, index]}
          told={field.one === 'event' ? eventInWords(item, { own: caseUnit.value, readers: angleUnit.value }) : undefined}
          isOpen={items.length <= OPEN || index === added}
        />
      ))}
      {items.length > most && (
        <button type="button" id={idOf(path)} onClick={() => setMost(most + SHOWN)}>
          Show more ({items.length - most} of {items.length} hidden)
        </button>
      )}
      <button
        type="button"
        onClick={() => {
          add(items.length);
          put(path, [...items, structuredClone(field.empty)]);
        }}
      >
        Add {/^[aeiou]/.test(field.one) ? 'an' : 'a'} {field.one}
      </button>
    </div>
  );
}

interface ListItemProps {
  field: ListProps['field'];
  path: Path;
  /** The element in a line, under which it folds. */
  told?: string | undefined;
  isOpen: boolean;
}

function ListItem({ field, path, told, isOpen }: ListItemProps) {
  const index = Number(path.at(-1));
  const name = get(draft.value, [...path, 'name']);
  const remove = (
    <button
      type="button"
      onClick={() => {
        forget();
        put(path, undefined);
      }}
      aria-label={`Remove ${field.one} ${index + 1}`}
    >
      Remove
    </button>
  );
  if (told === undefined)
    return (
      <div class="list-item">
        <div class="list-head">
          <span>
            {capital(field.one)} {index + 1}
          </span>
          {remove}
        </div>
        <Item field={field.item} path={path} isBare />
      </div>
    );
  return (
    <details class="list-item" open={isOpen}>
      <summary>
        <strong>{typeof name === 'string' && name !== '' ? name : `${capital(field.one)} ${index + 1}`}</strong>{' '}
        <span class="quiet">{told}</span>
      </summary>
      <div class="list-body">
        <Item field={field.item} path={path} isBare />
        {remove}
      </div>
    </details>
  );
}
