import { useSignal } from '@preact/signals';
import { type Case, download, ProblemError } from './api';
import { set, tidied } from './case';
import { copied } from './clipboard';
import { toFragment } from './link';
import { bodyIn, hasGlobe, modelOf, whyNoOem } from './planets';
import { asCurl, asJson, asPython, fileName } from './snippets';
import { draft } from './store';

const FORMATS = ['csv', 'json', 'geojson', 'kml', 'czml', 'oem'] as const;

/** What a user takes along: the link, the case in three languages, the flight as a file. */
export function Take() {
  const said = useSignal('');
  const say = (text: string) => {
    said.value = text;
  };
  const copy = async (what: string, text: string) => {
    await copied(text);
    say(`${what} copied`);
  };
  const link = async () => {
    const fragment = await toFragment(tidied(draft.value));
    await copy('Link', new URL(fragment, location.href).href);
  };
  const save = async (format: (typeof FORMATS)[number]) => {
    try {
      const blob = await download(`simulate?format=${format}`, bodyFor(format));
      saved(blob, `${fileName(draft.value)}.${format}`);
      say(`${format.toUpperCase()} saved`);
    } catch (error) {
      say(
        error instanceof ProblemError
          ? `Download failed: ${[error.message, ...(error.problem.errors ?? []).map(({ pointer, detail }) => `${pointer} ${detail}`)].join(' ')}`
          : 'Download failed: the service does not respond.',
      );
    }
  };
  const model = modelOf(draft.value);
  const without = FORMATS.filter((format) => !hasGlobe(format, model));
  const noOem = whyNoOem(draft.value);
  const isOffered = (format: (typeof FORMATS)[number]) => (format === 'oem' ? noOem === null : hasGlobe(format, model));
  return (
    <section class="take" aria-label="Export">
      <div class="buttons">
        <span class="quiet">Copy</span>
        <button type="button" onClick={() => void link()}>
          Link
        </button>
        <button type="button" onClick={() => void copy('curl command', asCurl(tidied(draft.value)))}>
          curl
        </button>
        <button type="button" onClick={() => void copy('Case JSON', asJson(tidied(draft.value)))}>
          Case JSON
        </button>
        <button type="button" onClick={() => void copy('Python program', asPython(tidied(draft.value)))}>
          Python
        </button>
      </div>
      <div class="buttons">
        <span class="quiet">Download</span>
        {FORMATS.map((format) => (
          <button key={format} type="button" disabled={!isOffered(format)} onClick={() => void save(format)}>
            {nameOf(format)}
          </button>
        ))}
        <button
          type="button"
          onClick={() => {
            saved(new Blob([asJson(tidied(draft.value))], { type: 'application/json' }), `${fileName(draft.value)}.case.json`);
            say('Case file saved');
          }}
        >
          Case file
        </button>
        <button type="button" onClick={() => print()}>
          Print
        </button>
      </div>
      {without.length > 0 && (
        <p class="quiet">{`${without.map(nameOf).join(' and ')}: viewers have no globe of ${bodyIn(model)}. GeoJSON names the planet.`}</p>
      )}
      {noOem !== null && <p class="quiet">{noOem}</p>}
      <output class="quiet" aria-live="polite">
        {said.value}
      </output>
    </section>
  );
}

const nameOf = (format: (typeof FORMATS)[number]) => (format === 'geojson' ? 'GeoJSON' : format.toUpperCase());

/** The case for a format: a table, a map and a list of states have no place for what is said about a flight, and the last two have no columns. */
function bodyFor(format: (typeof FORMATS)[number]): Case {
  const tree = tidied(draft.value);
  if (format === 'json') return tree;
  const { sensitivities: _, dispersions: __, verify: ___, ...flight } = tree;
  return format === 'csv' ? flight : tidied(set(flight, ['output', 'columns'], undefined));
}

function saved(blob: Blob, name: string): void {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
