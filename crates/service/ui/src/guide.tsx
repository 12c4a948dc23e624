import { address } from './api';

/** A link to a page of the service that explains something, beside which the reader's case stays open. */
export function Explained({ at, name }: { at: string; name: string }) {
  return (
    <a class="explained" href={address(at)} target="_blank" rel="noopener" aria-label={`Guide: ${name}`} title={`Guide: ${name}`}>
      ?
    </a>
  );
}

/** Fields of a case that the guide explains in the section of another. */
const WITHIN: Record<string, string> = { name: 'output', echo: 'output', density_factor: 'atmosphere' };

/** Where the guide explains the field of a pointer. */
export function chapterOf(pointer: string): string {
  const field = pointer.split('/')[1] ?? '';
  return field ? `guide/case#${WITHIN[field] ?? field}` : 'guide/case';
}
