import type { Case, VariedNumber } from './api';
import { get, isAngleAt, legible, type Path, pathOf, pointer, set, turned, withList } from './case';
import { type CaseNumber, numberAt, numbersThatMatter } from './numbers';

/** What the page does with a number: nothing, moves it by hand, or finds it. */
export type Role = 'fixed' | 'slider' | 'free';

/** What a request for a search takes no number of. */
const WITHOUT = new Set(['solver', 'output', 'sensitivities', 'dispersions', 'echo', 'verify', 'vary', 'achieve', 'limits', 'footprint']);

/** Whether a number may have a role other than fixed. */
export function hasRole(path: Path): boolean {
  return !WITHOUT.has(String(path[0]));
}

/** The role of the number at a path. */
export function roleOf(tree: Case, path: Path): Role {
  const at = pointer(path);
  return rolesOf(tree).get(at) ?? 'fixed';
}

/** The roles of the numbers that are not fixed, by their pointers. */
export function rolesOf(tree: Case): Map<string, Role> {
  return new Map([
    ...chosen(tree).map((at) => [at, 'slider'] as const),
    ...freeNumbers(tree).map(({ pointer: at }) => [at, 'free'] as const),
  ]);
}

/** The numbers that are free. */
export function freeNumbers(tree: Case): VariedNumber[] {
  return withList(tree).vary ?? [];
}

/** A free number, by its pointer. */
export function freeNumber(tree: Case, at: string): VariedNumber | undefined {
  return freeNumbers(tree).find((number) => number.pointer === at);
}

/** The pointers of the numbers that have a slider by choice, or because they matter. */
function chosen(tree: Case): string[] {
  return tree.sliders ?? numbersThatMatter(tree).map(({ path }) => pointer(path));
}

/** The numbers that have a slider: those that are free have one too. */
export function numbersWithSlider(tree: Case): CaseNumber[] {
  const pointers = [...new Set([...chosen(tree), ...freeNumbers(tree).map((number) => number.pointer)])];
  const numbers = pointers.map((at) => numberAt(tree, pathOf(tree, at)));
  return numbers.filter(({ path, without }) => typeof (get(tree, path) ?? without) === 'number');
}

/** The value of a number, of an angle in degrees; what holds without it where the case has none. */
export function shownValue(tree: Case, { path, isAngle, without = 0 }: CaseNumber): number {
  const own = get(tree, path);
  if (typeof own !== 'number') return without;
  return isAngle ? (legible(own, unitOf(tree), 'deg') as number) : own;
}

const unitOf = (tree: Case) => (tree.angle_unit === 'deg' ? 'deg' : 'rad');

/** The case with a number in another role; one that becomes free is so in a range around its value. */
export function withRole(tree: Case, path: Path, role: Role): Case {
  const at = pointer(path);
  const others = chosen(tree).filter((other) => other !== at);
  const sliders = role === 'fixed' ? others : [...others, at];
  const isAsBefore = role === 'free' || roleOf({ ...tree, vary: [] }, path) === role;
  const fixed = freeNumbers(tree).filter((number) => number.pointer !== at);
  const vary = role === 'free' ? [...fixed, freed(tree, path)] : fixed;
  const next = isAsBefore ? tree : { ...tree, sliders };
  return set(next, ['vary'], vary.length > 0 ? vary : undefined);
}

function freed(tree: Case, path: Path): VariedNumber {
  const number = numberAt(tree, path);
  const value = shownValue(tree, number);
  const own = unitOf(tree);
  const ends = [value, ...number.range(value)];
  const range = [Math.min(...ends), Math.max(...ends)].map(
    (end) => (number.isAngle ? turned(rounded(end), 'deg', own) : rounded(end)) as number,
  );
  return { pointer: pointer(path), between: range as [number, number] };
}

/** Six digits, as one types them. */
const rounded = (value: number) => Number(value.toPrecision(6));

/** The range in which a number is free, of an angle in degrees; null where an end is no number. */
export function rangeOf(tree: Case, { pointer: at, between }: VariedNumber): [number, number] | null {
  const [least, greatest] = isAngleAt(tree, at) ? between.map((end) => legible(end, unitOf(tree), 'deg')) : between;
  return typeof least === 'number' && typeof greatest === 'number' && least <= greatest ? [least, greatest] : null;
}
