import { useSignal } from '@preact/signals';
import type { ComponentType } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { address, type Case } from './api';
import { Bodies } from './bodies';
import { Cards, Computing, Dispersions, Problems, Sensitivities, Warnings } from './cards';
import { Compare, Pin, Theories } from './compare';
import { open, opened, start } from './fly';
import { startFootprints } from './footprint/live';
import { AskForFootprint } from './footprint/panel';
import { Form } from './form/form';
import { whyNoCase } from './form/shape';
import { future, past, recent, redo, undo } from './history';
import { remember, remembered } from './memory';
import { Plots } from './plots/plots';
import { Sliders } from './sliders';
import { angleUnit, current, draft, isBusy, notice, waiting } from './store';
import { Take } from './take';
import { AskForTarget, isAsked, TargetPanel } from './target/panel';
import { startSearches } from './target/solve';

const NARROW = '(max-width: 899px)';

/** The page: the case on one side, its flight on the other; on a narrow screen one at a time. */
export function App() {
  const isNarrow = useMedia(NARROW);
  const view = useSignal<'case' | 'flight'>('flight');
  useEffect(begin, []);
  const shows = (which: 'case' | 'flight') => !isNarrow || view.value === which;
  return (
    <>
      <Header />
      <main class="page">
        <div class="side" hidden={!shows('case')}>
          <Open />
          {!isNarrow && <Sliders />}
          <Form />
        </div>
        <div class="flight" hidden={!shows('flight')}>
          <Problems />
          <Notice />
          {isNarrow && <Sliders />}
          <FlightView />
        </div>
      </main>
      {isNarrow && (
        <nav class="views" aria-label="Views">
          {(['case', 'flight'] as const).map((which) => (
            <button
              key={which}
              type="button"
              aria-pressed={view.value === which}
              onClick={() => {
                view.value = which;
                scrollTo(0, 0);
              }}
            >
              {which === 'case' ? 'Case' : 'Flight'}
            </button>
          ))}
        </nav>
      )}
    </>
  );
}

/** Opens the case of the address, or else the first example, and flies from then on; a file may be dropped anywhere. */
function begin(): () => void {
  start();
  startSearches();
  startFootprints();
  void opened().then(async (isOpen) => {
    if (!isOpen) open(structuredClone((await examples())[0]?.case as Case));
  });
  const over = (event: DragEvent) => event.preventDefault();
  const drop = (event: DragEvent) => {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (file) void openFile(file);
  };
  addEventListener('dragover', over);
  addEventListener('drop', drop);
  return () => {
    removeEventListener('dragover', over);
    removeEventListener('drop', drop);
  };
}

const examples = async () => (await import('virtual:examples')).default;

/** The examples, once they are loaded. */
function useExamples() {
  const list = useSignal<Awaited<ReturnType<typeof examples>>>([]);
  useEffect(() => {
    void examples().then((found) => {
      list.value = found;
    });
  }, []);
  return list;
}

/** What to know of the case, where it is an example or was made of one: it still has the name. */
function Notes({ name }: { name: string | undefined }) {
  const notes = useExamples().value.find((example) => example.case.name === name)?.notes;
  if (!notes) return null;
  return (
    <details class="notes quiet">
      <summary>{notes}</summary>
    </details>
  );
}

/** The bytes that a file may have: an answer, with its rows, is longer than a case. */
const LONGEST_FILE = 64 << 20;

/** Opens the case of a file: a case, or an answer that repeats its own. A file that has none changes nothing. */
async function openFile(file: File): Promise<void> {
  try {
    if (file.size > LONGEST_FILE) throw new Error('it exceeds 64 MiB');
    const tree = JSON.parse(await file.text());
    const found = tree?.case ?? tree;
    const why = whyNoCase(found);
    if (why) throw new Error(why);
    open(found);
    notice.value = null;
  } catch (error) {
    notice.value = `${file.name} is not a valid case: ${error instanceof Error ? error.message : error}. The current case is unchanged.`;
  }
}

/** What a new case begins with: a capsule from a low orbit, in standard air. */
const NEW: Case = {
  name: 'New case',
  angle_unit: 'deg',
  atmosphere: { type: 'standard' },
  vehicle: { mass: 5500, reference_area: 12, aerodynamics: { type: 'constant', drag_coefficient: 1.3, lift_coefficient: 0.3 } },
  initial_state: {
    type: 'geodetic',
    geodetic_altitude: 120000,
    longitude: 0,
    geodetic_latitude: 0,
    speed: 7400,
    flight_path_angle: -2,
    azimuth: 90,
  },
};

function Notice() {
  if (!notice.value) return null;
  return (
    <section class="notice bad" role="alert">
      <p>{notice.value}</p>
      <button
        type="button"
        onClick={() => {
          notice.value = null;
        }}
      >
        Dismiss
      </button>
    </section>
  );
}

function Header() {
  const isOpen = useSignal(false);
  const Validation = useLater(isOpen.value, () => import('./validation'));
  return (
    <header class="top">
      <h1>reentry</h1>
      <p class="quiet tagline">Simulator of atmospheric entry and launch</p>
      <output class="quiet waiting" aria-live="polite">
        {waiting.value}
      </output>
      <div class="buttons">
        <button type="button" aria-label="Undo" title="Undo (Ctrl+Z)" disabled={past.value.length === 0} onClick={undo}>
          ↶
        </button>
        <button type="button" aria-label="Redo" title="Redo (Ctrl+Shift+Z)" disabled={future.value.length === 0} onClick={redo}>
          ↷
        </button>
        <fieldset class="segments">
          <legend class="hidden">Angle unit</legend>
          {(['deg', 'rad'] as const).map((unit) => (
            <button
              key={unit}
              type="button"
              aria-pressed={angleUnit.value === unit}
              onClick={() => {
                angleUnit.value = unit;
              }}
            >
              {unit}
            </button>
          ))}
        </fieldset>
        <Theme />
        <button
          type="button"
          onClick={() => {
            isOpen.value = true;
          }}
        >
          Validation
        </button>
        <a href={address('guide/')}>Guide</a>
        <a href={address('docs/')}>API</a>
      </div>
      {isOpen.value && Validation && (
        <Validation
          onClose={() => {
            isOpen.value = false;
          }}
        />
      )}
    </header>
  );
}

const THEMES = ['auto', 'light', 'dark'] as const;

/** Light, dark, or as the reader's system has it. */
function Theme() {
  const theme = useSignal<string>(remembered('theme') ?? 'auto');
  useEffect(() => {
    document.documentElement.dataset.theme = theme.value;
    remember('theme', theme.value);
  }, [theme.value]);
  return (
    <select
      aria-label="Theme"
      value={theme.value}
      onChange={(event) => {
        theme.value = event.currentTarget.value;
      }}
    >
      {THEMES.map((name) => (
        <option key={name} value={name}>
          {`Theme: ${name}`}
        </option>
      ))}
    </select>
  );
}

/** When a case was changed, for people. */
function dayOf(at: number): string {
  return new Date(at).toLocaleString([], { day: 'numeric', month: 'short', hour: '2-digit', minute: '2-digit' });
}

/** The examples, what was worked on, a file, a new case, and the name of the case. */
function Open() {
  const list = useExamples();
  const groups = [...new Set(list.value.map(({ group }) => group))];
  return (
    <section class="open" aria-label="Open a case">
      <label for="example">Open</label>
      <select
        id="example"
        value=""
        onChange={(event) => {
          const [of, index] = event.currentTarget.value.split(' ');
          const chosen = (of === 'recent' ? recent : list).peek()[Number(index)];
          if (chosen) open(structuredClone(chosen.case));
          event.currentTarget.value = '';
        }}
      >
        <option value="">Example or recent case …</option>
        {groups.map((group) => (
          <optgroup key={group} label={group}>
            {list.value.map((example, index) =>
              example.group === group ? (
                <option key={example.title} value={`example ${index}`}>
                  {example.title}
                </option>
              ) : null,
            )}
          </optgroup>
        ))}
        {recent.value.length > 0 && (
          <optgroup label="Recent">
            {recent.value.map(({ id, at, case: { name } }, index) => (
              <option key={id} value={`recent ${index}`}>
                {`${name ?? 'Unnamed case'}, ${dayOf(at)}`}
              </option>
            ))}
          </optgroup>
        )}
      </select>
      <button type="button" onClick={() => open(structuredClone(NEW))} title="New case: capsule in the U.S. Standard Atmosphere 1976">
        New
      </button>
      <label for="file">File</label>
      <input
        id="file"
        type="file"
        accept=".json,application/json"
        onChange={(event) => {
          const file = event.currentTarget.files?.[0];
          if (file) void openFile(file);
          event.currentTarget.value = '';
        }}
      />
      <label for="name">Name</label>
      <input
        id="name"
        type="text"
        autocomplete="off"
        value={draft.value.name ?? ''}
        onInput={(event) => {
          const { name: _, ...others } = draft.value;
          const name = event.currentTarget.value;
          draft.value = name ? { name, ...others } : others;
        }}
      />
    </section>
  );
}

function FlightView() {
  const Maps = useLater(current.value !== null, () => import('./map/map'));
  // Beside the target, where there is one, which is set on it.
  const map = Maps ? <Maps key="map" /> : <p class="quiet map-space">Loading map …</p>;
  if (!current.value) return <p class="quiet">{isBusy.value ? 'Computing …' : 'No results yet.'}</p>;
  return (
    <>
      <div class="panel-head">
        <h2 class="title">{current.value.case.name ?? 'Flight'}</h2>
        <Pin />
        <AskForTarget />
        <AskForFootprint />
      </div>
      <Notes name={current.value.case.name} />
      <Cards />
      <Warnings />
      <Take />
      <TargetPanel key="target" />
      {isAsked(draft.value) && map}
      <Bodies key="bodies" />
      <Plots key="plots" />
      <Compare key="compare" />
      {!isAsked(draft.value) && map}
      <Theories />
      <Sensitivities />
      <Dispersions />
      <Computing />
    </>
  );
}

/** A component that is loaded once it is wanted. */
function useLater<P>(isWanted: boolean, load: () => Promise<{ default: ComponentType<P> }>): ComponentType<P> | null {
  const [loaded, setLoaded] = useState<{ component: ComponentType<P> } | null>(null);
  useEffect(() => {
    if (isWanted && !loaded) void load().then((module) => setLoaded({ component: module.default }));
  }, [isWanted]);
  return loaded?.component ?? null;
}

function useMedia(query: string): boolean {
  const [matches, setMatches] = useState(() => matchMedia(query).matches);
  useEffect(() => {
    const media = matchMedia(query);
    const follow = () => setMatches(media.matches);
    media.addEventListener('change', follow);
    return () => media.removeEventListener('change', follow);
  }, [query]);
  return matches;
}
