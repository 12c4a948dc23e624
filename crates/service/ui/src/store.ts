import { computed, effect, signal } from '@preact/signals';
import type { Case, Problem, Solution, Theory } from './api';
import { type Run, withBodies } from './flight';
import { remember, remembered } from './memory';
import type { AngleUnit, Name } from './quantities';

/** The case as it is typed: the body of the next request, with texts where no numbers were typed. */
export const draft = signal<Case>({} as Case);

/** The flight of the last case that could be flown. */
export const current = signal<Run | null>(null);

/** Why the case as it is typed cannot be flown. */
export const problem = signal<Problem | null>(null);

/** Why the case as it is typed is not flown yet: the service is asked again. */
export const waiting = signal<string | null>(null);

/** The flights that were kept to compare with. */
export const pins = signal<Run[]>([]);

/** What a theory says beside the current flight. */
export const theory = signal<Theory | null>(null);

/** The instant of the current flight at which the plots and maps are looked at, s. */
export const cursor = signal<number | null>(null);

/** The quantities of which the reader wants plots beside those that are always there. */
export const added = signal<Name[]>([]);

/** The unit in which the reader reads and types angles, kept over visits. The case keeps its own. */
export const angleUnit = signal<AngleUnit>(remembered('angle-unit') === 'rad' ? 'rad' : 'deg');
effect(() => remember('angle-unit', angleUnit.value));

/** The unit of the angles of the case. */
export const caseUnit = computed<AngleUnit>(() => (draft.value.angle_unit === 'deg' ? 'deg' : 'rad'));

/** All flights that are shown: the current one, then the pins. */
export const runs = computed<Run[]>(() => (current.value ? [current.value, ...pins.value] : pins.value));

/** All that plots and maps draw: the current flight, the bodies that left it, the pins. */
export const tracks = computed<Run[]>(() => (current.value ? [...withBodies(current.value), ...pins.value] : pins.value));

/** When the last of the current flight and its bodies ends, s. */
export const lastEnd = computed(() => Math.max(0, ...tracks.value.filter(({ id }) => id <= 0).map(({ flight }) => flight.final.time ?? 0)));

/** Whether a flight is under way. */
export const isBusy = signal(false);

/** The theory that is to be set beside the flight. */
export const solution = signal<Solution | null>(null);

/** Why there is no theory beside the flight. */
export const theoryProblem = signal<Problem | null>(null);

/** Something that went wrong beside the case, such as a file that is none. */
export const notice = signal<string | null>(null);
