import schema from 'virtual:schema';
import { ANGLE_QUANTITIES, get, legible } from '../case';
import { number } from '../figures';
import type { AngleUnit } from '../quantities';

/** The units of the angles of a case, and of those that a person reads. */
export interface Units {
  own: AngleUnit;
  readers: AngleUnit;
}

/** An event in a line: when it happens, and what it does. */
export function eventInWords(event: unknown, units: Units): string {
  const does = effectInWords(get(event, ['then']), units);
  return [conditionInWords(get(event, ['when']), units), does || 'no change'].join(': ');
}

/** When an event happens. */
export function conditionInWords(when: unknown, units: Units): string {
  const [quantity, other, burnout] = ['quantity', 'event', 'burnout'].map((name) => get(when, [name]));
  if (quantity !== undefined) {
    const [label, unit] = titleOf(String(quantity));
    const way = get(when, ['rises_through']) === undefined ? 'falls' : 'rises';
    const value = get(when, [`${way}_through`]);
    const isAngle = ANGLE_QUANTITIES.has(quantity);
    const shown = isAngle ? angle(value, units) : `${plain(value)}${unit ? ` ${unit}` : ''}`;
    if (quantity === 'time') return `at ${shown}`;
    return `${label.toLowerCase()} ${way} ${way === 'falls' ? 'below' : 'above'} ${shown}`;
  }
  const delay = get(when, ['delay']) ?? 0;
  const after = burnout === undefined ? String(other ?? '?') : `burnout of ${burnout}`;
  return delay === 0 ? `at ${other === undefined ? '' : 'event '}${after}` : `${plain(delay)} s after ${after}`;
}

/** What an event does; nothing where it only marks an instant. */
export function effectInWords(then: unknown, units: Units): string {
  const at = (...path: string[]) => get(then, path);
  const said = [
    at('separate') !== undefined && `separates ${separated(at('separate'))}`,
    at('ignite') !== undefined && `ignites ${listed(at('ignite'))}`,
    at('shut_down') !== undefined && `shuts down ${listed(at('shut_down'))}`,
    at('throttle') !== undefined && `throttles ${throttled(at('throttle'))}`,
    at('load_limit') !== undefined &&
      (at('load_limit') === null ? 'removes the load limit' : `limits the load to ${plain(at('load_limit'))} g`),
    at('tilt') !== undefined && `tilts by ${angle(at('tilt', 'angle'), units)}`,
    at('steer') !== undefined && `steers: ${steering(at('steer'))}`,
    at('delta_v') !== undefined && `Δv ${plain(at('delta_v', 'value'))} m/s`,
    at('thrust') !== undefined && (at('thrust') === 'off' ? 'thrust off' : `thrust ${plain(at('thrust', 'value'))} N`),
    at('release') !== undefined && `releases ${listed(at('release'))}`,
    at('deploy') !== undefined && `deploys ${at('deploy', 'name') ?? 'a parachute'}`,
    at('mass') !== undefined && `mass ${plain(at('mass'))} kg`,
    at('reference_area') !== undefined && `area ${plain(at('reference_area'))} m²`,
    at('aerodynamics') !== undefined && 'new aerodynamics',
  ];
  return said.filter(Boolean).join(', ');
}

/** The label of a quantity, and its unit. */
function titleOf(quantity: string): [string, string] {
  const title = String(get(schema.Quantity?.['x-titles'], [quantity]) ?? quantity);
  const [label = quantity, unit = ''] = title.split(', ');
  return [label, unit];
}

function plain(value: unknown): string {
  return typeof value === 'number' ? number(value) : '?';
}

function angle(value: unknown, { own, readers }: Units): string {
  return `${plain(legible(value, own, readers))}${readers === 'deg' ? '°' : ' rad'}`;
}

function listed(names: unknown): string {
  return Array.isArray(names) && names.length > 0 ? names.map(String).join(', ') : 'nothing';
}

function separated(bodies: unknown): string {
  const names = Array.isArray(bodies) ? bodies.map((body) => get(body, ['name'])).filter((name) => name !== undefined) : [];
  return listed(names);
}

function throttled(throttle: unknown): string {
  if (typeof throttle !== 'object' || throttle === null) return 'nothing';
  return Object.entries(throttle)
    .map(([name, share]) => `${name} to ${typeof share === 'number' ? number(share * 100, 4) : '?'} %`)
    .join(', ');
}

function steering(steer: unknown): string {
  const type = String(get(steer, ['type']));
  const of = schema.Steering;
  const reference = get(of?.discriminator?.mapping, [type]);
  return (of?.variants?.find(({ $ref }) => $ref === reference)?.title ?? type).toLowerCase();
}
