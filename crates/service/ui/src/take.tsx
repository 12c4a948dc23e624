import { useSignal } from '@preact/signals';
import { type Case, download, ProblemError } from './api';
import { alone, set, tidied } from './case';
import { copied } from './clipboard';
import { footprintRequest } from './footprint/request';
import { toFragment } from './link';
import { bodyIn, hasGlobe, modelOf, whyNoOem } from './planets';
import { asCurl, asJson, asPython, fileName } from './snippets';
import { draft } from './store';
import { corridorRequest, targetRequest } from './target/request';

const FORMATS = ['csv', 'json', 'geojson', 'kml', 'czml', 'oem'] as const;

/** The requests of searches that a case makes, each with its path. */
const SEARCHES = { target: targetRequest, corridor: corridorRequest, footprint: footprintRequest };

/** What a user takes along: the link, the case in three languages, what is searched for, the flight as a file. */
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
  const save = async (path: string, body: object, ending: string, what: string) => {
    try {
      saved(await download(path, body), `${fileName(draft.value)}.${ending}`);
      say(`${what} saved`);
    } catch (error) {
      say(
        error instanceof ProblemError
          ? `Download failed: ${[error.message, ...(error.problem.errors ?? []).map(({ pointer, detail }) => `${pointer} ${detail}`)].join(' ')}`
          : 'Download failed: the service does not respond.',
      );
    }
  };
  const searches = Object.entries(SEARCHES).flatMap(([name, requestOf]) => {
    const request = requestOf(draft.value);
    return request ? [[name, request] as const] : [];
  });
  const footprint = footprintRequest(draft.value);
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
        <button type="button" onClick={() => void copy('curl command', asCurl(alone(tidied(draft.value))))}>
          curl
        </button>
        <button type="button" onClick={() => void copy('Case JSON', asJson(alone(tidied(draft.value))))}>
          Case JSON
        </button>
        <button type="button" onClick={() => void copy('Python program', asPython(alone(tidied(draft.value))))}>
          Python
        </button>
      </div>
      {searches.length > 0 && (
        <div class="buttons">
          <span class="quiet">Searches</span>
          {searches.map(([name, request]) => (
            <button key={name} type="button" onClick={() => void copy(`curl command of /${name}`, asCurl(request, name))}>
              {`curl /${name}`}
            </button>
          ))}
          {footprint && (
            <button type="button" onClick={() => void save('footprint?format=geojson', footprint, 'footprint.geojson', 'Footprint')}>
              Footprint GeoJSON
            </button>
          )}
        </div>
      )}
      <div class="buttons">
        <span class="quiet">Download</span>
        {FORMATS.map((format) => (
          <button
            key={format}
            type="button"
            disabled={!isOffered(format)}
            onClick={() => void save(`simulate?format=${format}`, bodyFor(format), format, nameOf(format))}
          >
            {nameOf(format)}
          </button>
        ))}
        <button
          type="button"
          onClick={() => {
            saved(new Blob([asJson(alone(tidied(draft.value)))], { type: 'application/json' }), `${fileName(draft.value)}.case.json`);
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
  const tree = alone(tidied(draft.value));
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
