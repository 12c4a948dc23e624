import { useState } from 'preact/hooks';
import { typed } from '../case';

interface Common {
  id: string;
  label?: string | undefined;
  /** Identifiers of the texts that say what is wrong. */
  describedBy?: string | undefined;
  isBad: boolean;
  help?: string | undefined;
}

/** How a value of the case is read, and how what is typed is stored. */
export interface Reading {
  shown(value: unknown): unknown;
  stored(value: unknown): unknown;
}

const AS_IT_IS: Reading = { shown: (value) => value, stored: (value) => value };

interface TextProps<T> extends Common {
  value: T | undefined;
  placeholder?: string | undefined;
  onValue(value: T | undefined): void;
}

const attributes = ({ id, label, describedBy, isBad, help }: Common) => ({
  id,
  'aria-label': label,
  'aria-invalid': isBad,
  'aria-describedby': describedBy,
  'aria-description': help,
});

/** A field for a number. What is typed stays as it is typed as long as it means the value. */
export function NumberInput({
  value,
  placeholder,
  onValue,
  reading = AS_IT_IS,
  ...common
}: TextProps<number | string> & { reading?: Reading | undefined }) {
  const [text, setText] = useState('');
  return (
    <input
      {...attributes(common)}
      type="text"
      inputMode="text"
      autocomplete="off"
      spellcheck={false}
      value={reading.stored(typed(text)) === value ? text : shown(reading.shown(value))}
      placeholder={placeholder}
      onInput={(event) => {
        setText(event.currentTarget.value);
        onValue(reading.stored(typed(event.currentTarget.value)) as number | string | undefined);
      }}
    />
  );
}

function shown(value: unknown): string {
  return value === undefined || value === null ? '' : String(value);
}

/** A field for a text; nothing typed is no text. */
export function TextInput({ value, placeholder, onValue, ...common }: TextProps<string>) {
  return (
    <input
      {...attributes(common)}
      type="text"
      autocomplete="off"
      spellcheck={false}
      value={shown(value)}
      placeholder={placeholder}
      onInput={(event) => onValue(event.currentTarget.value || undefined)}
    />
  );
}

/** A field for rows of numbers, as they come from a spreadsheet: cells apart by tabs, commas, semicolons or blanks. What is typed stays as it is typed as long as it means the rows. */
export function RowsInput({
  value,
  rows = 6,
  onValue,
  ...common
}: Common & { value: unknown[][]; rows?: number; onValue(value: unknown[][]): void }) {
  const [text, setText] = useState('');
  return (
    <textarea
      {...attributes(common)}
      rows={rows}
      spellcheck={false}
      value={normal(text) === normal(written(value)) ? text : written(value)}
      onInput={(event) => {
        setText(event.currentTarget.value);
        onValue(parsed(event.currentTarget.value));
      }}
    />
  );
}

/** The rows of a text, a cell a number where it is one. */
export function parsed(text: string): unknown[][] {
  return text
    .split('\n')
    .map((line) => line.split(/[\s,;]+/).filter((cell) => cell !== ''))
    .filter((cells) => cells.length > 0)
    .map((cells) => cells.map(typed));
}

/** A text of rows without what makes no cell. */
const normal = (text: string) => written(parsed(text));

/** Rows as text. */
export function written(rows: unknown[][]): string {
  return rows.map((cells) => cells.map(shown).join('  ')).join('\n');
}
