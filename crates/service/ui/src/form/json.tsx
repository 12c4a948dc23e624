import { useEffect, useState } from 'preact/hooks';
import { get, type Path } from '../case';
import { draft } from '../store';
import { Faults, idOf, inputOf, put } from './line';

/** A part of the case as JSON, for what has no fields of its own. A text that is no JSON stays, and the case as it was. */
export function Json({ label, path, told }: { label: string; path: Path; told?: string | undefined }) {
  return (
    <details class="json">
      <summary>
        {label} {told && <span class="quiet">{told}</span>}
      </summary>
      <JsonInput label={label} path={path} />
      <Faults path={path} isWhole />
    </details>
  );
}

function JsonInput({ label, path }: { label: string; path: Path }) {
  const value = get(draft.value, path);
  const [text, setText] = useState(written(value));
  const isJson = parsed(text) !== undefined;
  useEffect(() => {
    const own = parsed(text);
    if (own === undefined || JSON.stringify(own.value) !== JSON.stringify(value)) setText(written(value));
  }, [value]);
  const { id, isBad, describedBy } = inputOf(path, true);
  return (
    <>
      <textarea
        id={id}
        aria-label={`${label} as JSON`}
        aria-invalid={isBad || !isJson}
        aria-describedby={describedBy}
        rows={Math.min(Math.max(text.split('\n').length, 3), 16)}
        spellcheck={false}
        value={text}
        onInput={(event) => {
          setText(event.currentTarget.value);
          const own = parsed(event.currentTarget.value);
          if (own) put(path, own.value);
        }}
      />
      {!isJson && (
        <p class="fault" id={`${idOf(path)}-json`}>
          Not valid JSON. The case is unchanged.
        </p>
      )}
    </>
  );
}

function written(value: unknown): string {
  return value === undefined ? '' : JSON.stringify(value, null, 1);
}

/** What a text says; nothing typed is no value. */
function parsed(text: string): { value: unknown } | undefined {
  if (text.trim() === '') return { value: undefined };
  try {
    return { value: JSON.parse(text) };
  } catch {
    return undefined;
  }
}
