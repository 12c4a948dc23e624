import type { Case } from '../api';
import { set } from '../case';
import { airOfEarth, bodyIn, isBody, isSameGround, modelOf } from '../planets';
import { draft } from '../store';
import { exchanged, settled } from './held';

const OF_PLANET = ['gravitational_parameter', 'equatorial_radius', 'polar_radius', 'rotation_rate'];
const OF_GRAVITY = ['j2', 'j3', 'j4'];

/**
 * Puts another planet into the case. The numbers of the one before go with it, and come back with it; what is the Earth's air becomes the
 * standard atmosphere of a body. What changes so is told.
 */
export function settle(next: string): void {
  const tree = draft.peek();
  const before = modelOf(tree);
  if (isSameGround(before, next)) {
    draft.value = set(tree, ['planet', 'model'], next);
    return;
  }
  const changes: string[] = [];
  const [own, shared] = parted(tree.planet, OF_PLANET);
  const [coefficients, gravity] = parted(shared.gravity as object | undefined, OF_GRAVITY);
  const kept = exchanged(['planet'], before, next, { own: {}, coefficients: {} }, { own, coefficients }) as Record<string, object>;
  const isZonal = gravity.type === 'zonal';
  if (isZonal && Object.keys(coefficients).length > 0 && Object.keys(kept.coefficients ?? {}).length === 0)
    changes.push(`The zonal coefficients of ${bodyIn(before)} are no longer used.`);
  const planet = {
    ...shared,
    ...kept.own,
    model: next,
    ...(shared.gravity === undefined ? {} : { gravity: isZonal ? { ...gravity, ...kept.coefficients } : gravity }),
  };
  const air = isBody(next) ? airOfEarth(tree.atmosphere) : null;
  const type = tree.atmosphere?.type;
  let changed = { ...tree, planet } as Case;
  if (air !== null && type !== undefined) {
    changed = set(changed, ['atmosphere'], exchanged(['atmosphere'], type, 'standard', { type: 'standard' }));
    changes.push(`The atmosphere is now the standard one of ${bodyIn(next)}, in place of the ${air}.`);
  }
  settled.value = changes.length > 0 ? { model: next, changes } : null;
  draft.value = changed;
}

/** The fields of an object that have given names, and the others. */
function parted(of: object | undefined, names: string[]): [Record<string, unknown>, Record<string, unknown>] {
  const fields = Object.entries(of ?? {});
  const isOne = ([name]: [string, unknown]) => names.includes(name);
  return [Object.fromEntries(fields.filter(isOne)), Object.fromEntries(fields.filter((field) => !isOne(field)))];
}
