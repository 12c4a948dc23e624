import { get, type Path } from '../case';
import { draft } from '../store';
import { NumberInput, TextInput } from './inputs';
import { Json } from './json';
import { Faults, inputOf, put } from './line';

/** A cell of the table of parts. */
interface Cell {
  label: string;
  path: Path;
  placeholder?: string;
}

const CELLS: Cell[] = [
  { label: 'Count', path: ['count'], placeholder: '1' },
  { label: 'Dry mass, kg', path: ['dry_mass'] },
  { label: 'Propellant, kg', path: ['propellant'], placeholder: '0' },
  { label: 'Thrust in vacuum, N', path: ['engine', 'thrust', 'vacuum'] },
  { label: 'Thrust at sea level, N', path: ['engine', 'thrust', 'sea_level'] },
  { label: 'Specific impulse, s', path: ['engine', 'specific_impulse'] },
];

/** What a part has beyond the table, each with what it is called. */
const OTHERS: [Path, string][] = [
  [['engine', 'exit_area'], 'exit area'],
  [['reference_area'], 'reference area'],
  [['aerodynamics'], 'aerodynamics'],
  [['nose_radius'], 'nose radius'],
];

/** The parts of a vehicle: stages, boosters, fairing, payload. What fits no cell is written as JSON. */
export function Parts({ path }: { path: Path }) {
  const parts = (get(draft.value, path) as unknown[] | undefined) ?? [];
  return (
    <div class="list parts">
      <Faults path={path} />
      {parts.map((_, index) => (
        <Part key={`${parts.length}-${index}`} path={[...path, index]} index={index} />
      ))}
      <button type="button" onClick={() => put(path, [...parts, { name: `part ${parts.length + 1}`, dry_mass: 100 }])}>
        Add a part
      </button>
    </div>
  );
}

function Part({ path, index }: { path: Path; index: number }) {
  const part = get(draft.value, path);
  const title = `Part ${index + 1}`;
  return (
    <fieldset class="list-item part">
      <legend class="hidden">{title}</legend>
      <div class="list-head">
        <TextInput
          {...inputOf([...path, 'name'], false)}
          label={`${title}: Name`}
          value={get(part, ['name']) as string | undefined}
          placeholder="name"
          onValue={(name) => put([...path, 'name'], name ?? '')}
        />
        <button type="button" onClick={() => put(path, undefined)} aria-label={`Remove part ${index + 1}`}>
          Remove
        </button>
      </div>
      <div class="part-cells">
        {CELLS.map((cell) => (
          <CellInput key={cell.label} cell={cell} part={path} title={title} />
        ))}
      </div>
      <Faults path={path} isWhole />
      <Json label="As JSON" told={beyond(part)} path={path} />
    </fieldset>
  );
}

function CellInput({ cell, part, title }: { cell: Cell; part: Path; title: string }) {
  const path = [...part, ...cell.path];
  const value = get(draft.value, path);
  return (
    // biome-ignore lint/a11y/noLabelWithoutControl: the input is inside
    <label class="part-cell">
      <span>{cell.label}</span>
      {Array.isArray(value) ? (
        <input type="text" value="table" disabled aria-label={`${title}: ${cell.label}`} />
      ) : (
        <NumberInput
          {...inputOf(path, false)}
          label={`${title}: ${cell.label}`}
          value={value as number | undefined}
          placeholder={cell.placeholder}
          onValue={(next) => put(part, withCell(get(draft.peek(), part), cell.path, next))}
        />
      )}
    </label>
  );
}

/** A part with another value in a cell, and without the objects around it in which nothing is left. */
export function withCell(tree: unknown, [name, ...rest]: Path, value: unknown): unknown {
  if (name === undefined) return value;
  const { [name]: old, ...others } = (typeof tree === 'object' && tree !== null ? tree : {}) as Record<string | number, unknown>;
  const inner = withCell(old, rest, value);
  const isLeft = inner !== undefined && !(rest.length > 0 && Object.keys(inner as object).length === 0);
  return isLeft ? { ...(tree as object | undefined), [name]: inner } : others;
}

/** What a part has beyond the table, in a few words. */
export function beyond(part: unknown): string | undefined {
  const given = OTHERS.filter(([path]) => get(part, path) !== undefined).map(([, label]) => label);
  if (get(part, ['engine', 'thrust', 'type']) === 'table') given.unshift('thrust table');
  return given.length === 0 ? undefined : given.join(', ');
}
