import { useSignal } from '@preact/signals';
import type { ComponentType } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { address, type Case } from './api';
import { Cards, Computing, Problems, Sensitivities, Warnings } from './cards';
import { inUnit } from './case';
import { Compare, Pin, Theories } from './compare';
import { opened, start, take } from './fly';
import { Form } from './form/form';
import { Plots } from './plots/plots';
import { Sliders } from './sliders';
import { angleUnit, current, draft, isBusy, notice } from './store';
import { Take } from './take';

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
  void opened().then(async (isOpen) => {
    if (!isOpen) take(structuredClone((await examples())[0]?.case as Case));
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

/** The case of a file: a case, or an answer that repeats its own. */
async function openFile(file: File): Promise<void> {
  try {
    const tree = JSON.parse(await file.text());
    if (typeof tree !== 'object' || tree === null || Array.isArray(tree)) throw new Error('it is not a JSON object');
    take(tree.case ?? tree);
    notice.value = null;
  } catch (error) {
    notice.value = `${file.name} cannot be opened: ${error instanceof Error ? error.message : error}.`;
  }
}

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
      <p class="quiet tagline">Flights back through the atmosphere</p>
      <div class="buttons">
        <fieldset class="segments">
          <legend class="hidden">Unit of angles</legend>
          {(['deg', 'rad'] as const).map((unit) => (
            <button
              key={unit}
              type="button"
              aria-pressed={angleUnit.value === unit}
              onClick={() => {
                draft.value = inUnit(draft.value, unit);
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

/** What was remembered of an earlier visit; nothing where the browser keeps nothing. */
function remembered(name: string): string | null {
  try {
    return localStorage.getItem(name);
  } catch {
    return null;
  }
}

function remember(name: string, value: string): void {
  try {
    localStorage.setItem(name, value);
  } catch {
    // Then it holds for this visit.
  }
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
          {name}
        </option>
      ))}
    </select>
  );
}

/** The examples, a file, and the name of the case. */
function Open() {
  const list = useSignal<Awaited<ReturnType<typeof examples>>>([]);
  useEffect(() => {
    void examples().then((found) => {
      list.value = found;
    });
  }, []);
  const groups = [...new Set(list.value.map(({ group }) => group))];
  return (
    <section class="open" aria-label="Open">
      <label for="example">Example</label>
      <select
        id="example"
        value=""
        onChange={(event) => {
          const chosen = list.value[Number(event.currentTarget.value)];
          if (chosen) take(structuredClone(chosen.case));
          event.currentTarget.value = '';
        }}
      >
        <option value="">choose one …</option>
        {groups.map((group) => (
          <optgroup key={group} label={group}>
            {list.value.map((example, index) =>
              example.group === group ? (
                <option key={example.title} value={index}>
                  {example.title}
                </option>
              ) : null,
            )}
          </optgroup>
        ))}
      </select>
      <label for="file">or a file</label>
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
  if (!current.value) return <p class="quiet">{isBusy.value ? 'Flying …' : 'No flight yet.'}</p>;
  return (
    <>
      <div class="panel-head">
        <h2 class="title">{current.value.case.name ?? 'Flight'}</h2>
        <Pin />
      </div>
      <Cards />
      <Warnings />
      <Take />
      <Plots />
      <Compare />
      {Maps ? <Maps /> : <p class="quiet map-space">The map is loading …</p>}
      <Theories />
      <Sensitivities />
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
