import type { Case, Goal } from '../api';

type Events = Case['events'];

/** A body that an event of a case separates, with its own events. */
interface Body {
  name: string;
  events: Events;
}

/** All bodies that events separate, and that leave those; of a case that may be half typed. */
export function bodiesOf(events: Events): Body[] {
  return (events ?? []).flatMap((event) =>
    (event?.then?.separate ?? []).flatMap((body) =>
      typeof body?.name === 'string' && body.name !== '' ? [{ name: body.name, events: body.events }, ...bodiesOf(body.events)] : [],
    ),
  );
}

/** The names of events that have one. */
export function namesOf(events: Events): string[] {
  return (events ?? []).flatMap((event) => (typeof event?.name === 'string' && event.name !== '' ? [event.name] : []));
}

/** The same goal on the flight of a body, or of the vehicle where the name is empty; an event of the former flight is no moment of it. */
export function goalOn(name: string, goal: Goal): Record<string, unknown> {
  const { body: _, at, ...rest } = goal as Record<string, unknown>;
  const isOfEvent = typeof at === 'object' && at !== null && 'event' in at;
  return { ...rest, ...(at === undefined || isOfEvent ? {} : { at }), ...(name === '' ? {} : { body: name }) };
}
