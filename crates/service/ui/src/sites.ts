import { signal } from '@preact/signals';
import { sites as listed, type Schemas } from './api';

export type ListedSite = Schemas['ListedSite'];

/** The sites that a case may name, once they are loaded; angles in degrees. */
export const sites = signal<ListedSite[]>([]);

let isAsked = false;

/** Loads the sites, once; where the service does not give them, they are asked for again by whoever wants them next. */
export function loadSites(): void {
  if (isAsked) return;
  isAsked = true;
  listed()
    .then((found) => {
      sites.value = found;
    })
    .catch(() => {
      isAsked = false;
    });
}

const countries = new Intl.DisplayNames(['en'], { type: 'region', fallback: 'code' });

/** A site with its country. */
export function titleOfSite({ name, country }: ListedSite): string {
  return country ? `${name}, ${countries.of(country)}` : name;
}

export const KINDS: Record<ListedSite['kind'], string> = {
  launch: 'Launch sites',
  landing: 'Landing sites',
  recovery: 'Recovery areas',
};

/** The sites in whose name, country or slug every word of a text is. */
export function found(all: ListedSite[], text: string): ListedSite[] {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  return all.filter((site) => {
    const said = `${titleOfSite(site)} ${site.slug}`.toLowerCase();
    return words.every((word) => said.includes(word));
  });
}
