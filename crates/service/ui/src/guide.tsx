import { address } from './api';

/** A link to a page of the service that explains something, beside which the reader's case stays open. */
export function Explained({ at, name }: { at: string; name: string }) {
  return (
    <a class="explained" href={address(at)} target="_blank" rel="noopener" aria-label={`Guide: ${name}`} title={`Guide: ${name}`}>
      ?
    </a>
  );
}

/** Where the guide explains the field of a pointer. */
export function chapterOf(pointer: string): string {
  const field = pointer.split('/')[1] ?? '';
  return field ? `guide/case#${field}` : 'guide/case';
}
