const probe = document.createElement('span');
probe.hidden = true;

let known = new Map<string, string>();
const listeners = new Set<() => void>();

/** A colour of the style sheet, as the reader's theme has it now: a canvas knows no custom properties. */
export function colour(name: string): string {
  const found = known.get(name);
  if (found) return found;
  if (!probe.isConnected) document.body.append(probe);
  probe.style.color = `var(--${name})`;
  const resolved = getComputedStyle(probe).color;
  known.set(name, resolved);
  return resolved;
}

/** Calls whenever the theme changes; returns what ends that. */
export function onTheme(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

function changed(): void {
  known = new Map();
  for (const listener of listeners) listener();
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', changed);
new MutationObserver(changed).observe(document.documentElement, { attributeFilter: ['data-theme'] });
