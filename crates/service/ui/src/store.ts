import { computed, signal } from '@preact/signals';
import type { Case, Problem, Solution, Theory } from './api';
import type { Run } from './flight';
import type { AngleUnit } from './quantities';

/** The case as it is typed: the body of the next request, with texts where no numbers were typed. */
export const draft = signal<Case>({} as Case);

/** The flight of the last case that could be flown. */
export const current = signal<Run | null>(null);

/** Why the case as it is typed cannot be flown. */
export const problem = signal<Problem | null>(null);

/** The flights that were kept to compare with. */
export const pins = signal<Run[]>([]);

/** What a theory says beside the current flight. */
export const theory = signal<Theory | null>(null);

/** The instant of the current flight at which the plots and maps are looked at, s. */
export const cursor = signal<number | null>(null);

/** The unit of angles, in and out. */
export const angleUnit = computed<AngleUnit>(() => (draft.value.angle_unit === 'deg' ? 'deg' : 'rad'));

/** All flights that are shown: the current one, then the pins. */
export const runs = computed<Run[]>(() => (current.value ? [current.value, ...pins.value] : pins.value));

/** Whether a flight is under way. */
export const isBusy = signal(false);

/** The theory that is to be set beside the flight. */
export const solution = signal<Solution | null>(null);

/** Why there is no theory beside the flight. */
export const theoryProblem = signal<Problem | null>(null);

/** Something that went wrong beside the case, such as a file that is none. */
export const notice = signal<string | null>(null);
