import { computed } from '@preact/signals';
import { get, type Path, pointer } from '../case';
import { freeNumbers, hasRole, type Role, rolesOf, withRole } from '../roles';
import { draft } from '../store';
import { NumberInput } from './inputs';
import { angles, inputOf, put } from './line';
import type { Property } from './schema';

/** The roles, in the order in which a click goes through them. */
const ROLES: Record<Role, { mark: string; title: string; next: Role }> = {
  fixed: { mark: '○', title: 'fixed', next: 'slider' },
  slider: { mark: '⇆', title: 'slider', next: 'free' },
  free: { mark: '◆', title: 'free within bounds', next: 'fixed' },
};

const roles = computed(() => rolesOf(draft.value));

interface RoleProps {
  label: string;
  path: Path;
  property?: Property | undefined;
}

/** The role of a number, beside its field; nothing where there is no number. */
export function RoleChoice({ label, path, property }: RoleProps) {
  if (!hasRole(path)) return null;
  const role = roles.value.get(pointer(path)) ?? 'fixed';
  if (role !== 'free' && typeof (get(draft.value, path) ?? property?.default) !== 'number') return null;
  const { mark, title, next } = ROLES[role];
  return (
    <button
      type="button"
      class={`role ${role}`}
      aria-label={`Role of ${label}: ${title}`}
      title={`Role: ${title}. Click: ${ROLES[next].title}`}
      onClick={() => {
        draft.value = withRole(draft.peek(), path, next);
      }}
    >
      {mark}
    </button>
  );
}

/** The bounds of a number that is free, below its field. */
export function Bounds({ label, path, isAngle }: { label: string; path: Path; isAngle: boolean }) {
  const at = pointer(path);
  if (roles.value.get(at) !== 'free') return null;
  const index = freeNumbers(draft.value).findIndex((number) => number.pointer === at);
  const input = (end: string, place: number) => (
    <NumberInput
      {...inputOf(['vary', index, 'between', place], false)}
      label={`${end} ${label}`}
      value={get(draft.value, ['vary', index, 'between', place]) as number | undefined}
      reading={isAngle ? angles.value : undefined}
      onValue={(next) => put(['vary', index, 'between', place], next ?? '')}
    />
  );
  return (
    <div class="bounds">
      <span class="quiet">free from</span>
      {input('Least', 0)}
      <span class="quiet">to</span>
      {input('Greatest', 1)}
    </div>
  );
}
