import { convert, type Schemas, type State } from '../api';
import { draft } from '../store';

/** Puts the initial state into another coordinate system, in place; what cannot be converted is typed anew. */
export async function retype(type: State['type']): Promise<void> {
  const before = draft.peek().initial_state;
  const answer = await converted();
  const state = answer?.[type];
  if (draft.peek().initial_state !== before) return;
  draft.value = { ...draft.peek(), initial_state: state ? likeBefore(state, before, answer) : ({ type } as State) };
}

/** Puts another field of the initial state in place of one that says the same, such as the altitude in place of the radius. */
export async function rename(from: string, to: string): Promise<void> {
  const before = draft.peek().initial_state;
  const answer = await converted();
  if (draft.peek().initial_state !== before) return;
  const { [from]: _, ...others } = before as unknown as Record<string, unknown>;
  const value =
    (answer?.[before.type] as Record<string, unknown> | null | undefined)?.[to] ??
    (answer?.derived as Record<string, unknown> | undefined)?.[to];
  draft.value = { ...draft.peek(), initial_state: { ...others, [to]: value ?? '' } as unknown as State };
}

async function converted(): Promise<Schemas['ConvertResponse'] | null> {
  const { angle_unit = 'rad', planet, epoch, initial_state } = draft.peek();
  return convert({ angle_unit, planet, epoch, state: initial_state }).catch(() => null);
}

/** With the altitude where the state had no radius, and without the sidereal time where it had none: it still follows from the epoch. */
function likeBefore(state: State, before: State, answer: Schemas['ConvertResponse'] | null): State {
  const { sidereal_time, ...others } = state as State & { radius?: number };
  const timed = 'sidereal_time' in before ? { sidereal_time } : {};
  if (!('radius' in others) || 'radius' in before || !answer) return { ...others, ...timed } as State;
  const { radius: _, type, ...rest } = others;
  return { type, altitude: answer.derived.altitude, ...rest, ...timed } as State;
}
