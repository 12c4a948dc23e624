import { computed } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { ANGLE_QUANTITIES, get, legible, type Path, pointer, set, turned } from '../case';
import { angleUnit, caseUnit, draft, problem } from '../store';
import type { Field } from './fields';
import type { Reading } from './inputs';
import type { Property } from './schema';

export function isWithin(inner: string, outer: string): boolean {
  return inner === outer || inner.startsWith(`${outer}/`);
}

/** What is wrong with a field; with its elements as well, where they are not fields of their own. */
function faultsOf(path: Path, isWhole: boolean): string[] {
  const own = pointer(path);
  const faults = problem.value?.errors ?? [];
  return faults
    .filter((fault) => (isWhole ? isWithin(fault.pointer, own) : fault.pointer === own))
    .map((fault) => (fault.pointer === own ? fault.detail : `${fault.pointer.slice(own.length + 1)}: ${fault.detail}`));
}

export const put = (path: Path, value: unknown) => {
  draft.value = set(draft.peek(), path, value);
};

/** The unit of a field, at a path where that decides it. */
export function unitOf(field: Field, path?: Path): string | undefined {
  if (isAngle(field, path)) return angleUnit.value === 'deg' ? '°' : 'rad';
  return 'unit' in field ? field.unit : undefined;
}

/** Whether a field is an angle; the value of a condition is one where its quantity is. */
export function isAngle(field: Field, path?: Path): boolean {
  if ('isAngle' in field && field.isAngle) return true;
  const name = path?.at(-1);
  if (!path || (name !== 'falls_through' && name !== 'rises_through')) return false;
  return ANGLE_QUANTITIES.has(get(draft.value, [...path.slice(0, -1), 'quantity']));
}

/** Angles are read and typed in the reader's unit; the case keeps its own, and with it every number as it was typed. */
export const angles = computed<Reading>(() => {
  const [own, readers] = [caseUnit.value, angleUnit.value];
  return { shown: (value) => legible(value, own, readers), stored: (value) => turned(value, readers, own) };
});

export const idOf = (path: Path) => `field${pointer(path)}`;

/** The description of a field, without the marks of Markdown. */
export function helpOf(property: Property | undefined): string | undefined {
  return property?.description?.replaceAll('`', '');
}

/** What every input has: its identity, and what is wrong with it. */
export function inputOf(path: Path, isWhole: boolean, property?: Property) {
  const faults = faultsOf(path, isWhole);
  return {
    id: idOf(path),
    isBad: faults.length > 0,
    describedBy: faults.length > 0 ? `${idOf(path)}-fault` : undefined,
    help: helpOf(property),
  };
}

export function Faults({ path, isWhole = false }: { path: Path; isWhole?: boolean }) {
  const faults = faultsOf(path, isWhole);
  if (faults.length === 0) return null;
  return (
    <p class="fault" id={`${idOf(path)}-fault`}>
      {faults.join(' · ')}
    </p>
  );
}

export interface LineProps {
  label: ComponentChildren;
  path: Path;
  property?: Property | undefined;
  unit?: string | undefined;
  /** What is done with a number, beside its unit. */
  role?: ComponentChildren;
  /** What stands below, over the whole width. */
  below?: ComponentChildren;
  children: ComponentChildren;
}

/** A label, an input and its unit. */
export function Line({ label, path, property, unit, role, below, children }: LineProps) {
  return (
    <div class="line" title={helpOf(property)}>
      {typeof label === 'string' ? <label for={idOf(path)}>{label}</label> : label}
      {children}
      <span class="unit">
        {unit}
        {role}
      </span>
      {below}
      <Faults path={path} isWhole />
    </div>
  );
}

/** A label above an input that takes the whole width. */
export function Block({ label, path, property, children }: Omit<LineProps, 'unit' | 'role' | 'below'>) {
  return (
    <div class="block" title={helpOf(property)}>
      <label for={idOf(path)}>{label}</label>
      {children}
      <Faults path={path} isWhole />
    </div>
  );
}

export function select(path: Path) {
  const { id, isBad, describedBy } = inputOf(path, false);
  return { id, 'aria-invalid': isBad, 'aria-describedby': describedBy };
}
