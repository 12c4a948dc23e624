import { useLayoutEffect, useState } from 'preact/hooks';
import { get, type Path, set } from '../case';
import { draft } from '../store';
import { idOf, inputOf, put } from './line';
import { whyNoCase } from './shape';

/** A part of the case as JSON, for what has no fields of its own. */
export function Json({ label, path, told }: { label: string; path: Path; told?: string | undefined }) {
  return (
    <details class="json">
      <summary>
        {label} {told && <span class="quiet">{told}</span>}
      </summary>
      <JsonInput label={label} path={path} />
    </details>
  );
}

/** What is no JSON, or would make the case none, stays as it is typed, and the case as it was. */
function JsonInput({ label, path }: { label: string; path: Path }) {
  const value = get(draft.value, path);
  const [text, setText] = useState(written(value));
  // The text of the case itself needs no look.
  const own = text === written(value) ? { value } : read(text, path);
  // Before the paint: a text that is not of the value is never seen.
  useLayoutEffect(() => {
    if ('why' in own || JSON.stringify(own.value) !== JSON.stringify(value)) setText(written(value));
  }, [value]);
  const { id, isBad, describedBy } = inputOf(path, true);
  const why = 'why' in own ? `${idOf(path)}-why` : undefined;
  return (
    <>
      <textarea
        id={id}
        aria-label={`${label} as JSON`}
        aria-invalid={isBad || why !== undefined}
        aria-describedby={why ?? describedBy}
        rows={Math.min(Math.max(text.split('\n').length, 3), 16)}
        spellcheck={false}
        value={text}
        onInput={(event) => {
          setText(event.currentTarget.value);
          const next = read(event.currentTarget.value, path);
          if (!('why' in next)) put(path, next.value);
        }}
      />
      {'why' in own && (
        <p class="fault" id={why}>
          {own.why}. The case is unchanged.
        </p>
      )}
    </>
  );
}

function written(value: unknown): string {
  return value === undefined ? '' : JSON.stringify(value, null, 1);
}

/** What a text says, or why it is not taken. Nothing typed is no value; an element of a list goes by its button. */
function read(text: string, path: Path): { value: unknown } | { why: string } {
  if (text.trim() === '' && typeof path.at(-1) === 'string') return { value: undefined };
  try {
    const value = JSON.parse(text);
    const why = whyNoCase(set(draft.peek(), path, value));
    return why === null ? { value } : { why: `Not taken: ${why}` };
  } catch {
    return { why: 'Not valid JSON' };
  }
}
