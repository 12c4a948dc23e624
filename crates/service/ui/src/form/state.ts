import { convert, type InitialState, type Schemas, type State } from '../api';
import { sites } from '../sites';
import { draft } from '../store';
import { exchanged } from './held';
import { atRest, firstLaunch, type Launch } from './launch';

/**
 * Puts the initial state into another coordinate system, in place; what cannot be converted is typed anew. A launch is no state in
 * coordinates: it takes the place of the one that was there, which comes back after it.
 */
export async function retype(type: InitialState['type']): Promise<void> {
  const before = draft.peek().initial_state;
  if (type === 'launch') {
    draft.value = { ...draft.peek(), initial_state: exchanged(PATH, 'state', type, firstLaunch()) as InitialState };
    return;
  }
  const state = before.type === 'launch' ? (exchanged(PATH, 'launch', 'state', standing(before)) as State) : before;
  if (state.type === type && state !== before) {
    draft.value = { ...draft.peek(), initial_state: state };
    return;
  }
  const answer = await converted(state);
  const next = answer?.[type];
  if (draft.peek().initial_state !== before) return;
  draft.value = { ...draft.peek(), initial_state: next ? likeBefore(next, state, answer) : ({ type } as InitialState) };
}

const PATH = ['initial_state'];

/** A launch as a state at rest. */
function standing(launch: Launch): State {
  return atRest(
    launch,
    sites.peek().find(({ slug }) => slug === launch.site),
  );
}

/** Puts another field of the initial state in place of one that says the same, such as the altitude in place of the radius. */
export async function rename(from: string, to: string): Promise<void> {
  const before = draft.peek().initial_state;
  if (before.type === 'launch') return;
  const answer = await converted(before);
  if (draft.peek().initial_state !== before) return;
  const { [from]: _, ...others } = before as unknown as Record<string, unknown>;
  const value =
    (answer?.[before.type] as Record<string, unknown> | null | undefined)?.[to] ??
    (answer?.derived as Record<string, unknown> | undefined)?.[to];
  draft.value = { ...draft.peek(), initial_state: { ...others, [to]: value ?? '' } as unknown as InitialState };
}

async function converted(state: State): Promise<Schemas['ConvertResponse'] | null> {
  const { angle_unit = 'rad', planet, epoch } = draft.peek();
  return convert({ angle_unit, planet, epoch, state }).catch(() => null);
}

/** With the altitude where the state had no radius, and without the sidereal time where it had none: it still follows from the epoch. */
function likeBefore(state: State, before: State, answer: Schemas['ConvertResponse'] | null): State {
  const { sidereal_time, ...others } = state as State & { radius?: number };
  const timed = 'sidereal_time' in before ? { sidereal_time } : {};
  if (!('radius' in others) || 'radius' in before || !answer) return { ...others, ...timed } as State;
  const { radius: _, type, ...rest } = others;
  return { type, altitude: answer.derived.altitude, ...rest, ...timed } as State;
}
