/** What was remembered of an earlier visit; nothing where the browser keeps nothing. */
export function remembered(name: string): string | null {
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

/** Remembers a text for the next visit; where the browser keeps nothing it holds for this one. */
export function remember(name: string, value: string): void {
  try {
    localStorage.setItem(name, value);
  } catch {
    // Nothing to do: storage is switched off, or full.
  }
}
