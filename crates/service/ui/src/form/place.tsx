import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import { get, type Path } from '../case';
import { isEarth, modelOf } from '../planets';
import { found, KINDS, type ListedSite, loadSites, sites, titleOfSite } from '../sites';
import { draft } from '../store';
import { launchAt, launchFrom } from './launch';
import { Block, Line, put, select } from './line';

/** Where a launch begins: a site, to be found by its name or country, or a place, whose fields follow. */
export function LaunchPlace({ path }: { path: Path }) {
  useEffect(loadSites, []);
  const wanted = useSignal('');
  const slug = get(draft.value, path) as string | undefined;
  const site = sites.value.find((other) => other.slug === slug);
  const onEarth = isEarth(modelOf(draft.value));
  const change = (next: string) => {
    if (next === 'place') launchAt(site?.geodetic_latitude ?? 0, site?.longitude ?? 0, site?.geodetic_altitude ?? 0);
    else launchFrom(sites.peek()[0]?.slug ?? 'ksc_lc39a');
  };
  const way = [...path, 'way'];
  return (
    <>
      <Line label="Launch from" path={way}>
        <select {...select(way)} value={slug === undefined ? 'place' : 'site'} onChange={(event) => change(event.currentTarget.value)}>
          {(onEarth || slug !== undefined) && <option value="site">Site</option>}
          <option value="place">Latitude and longitude</option>
        </select>
      </Line>
      {slug !== undefined && (
        <Block label="Site" path={path}>
          <input
            aria-label="Search sites"
            type="search"
            autocomplete="off"
            placeholder="Search by name or country"
            value={wanted.value}
            onInput={(event) => {
              wanted.value = event.currentTarget.value;
            }}
          />
          <select {...select(path)} value={slug} onChange={(event) => put(path, event.currentTarget.value)}>
            <Options of={found(sites.value, wanted.value)} chosen={slug} />
          </select>
        </Block>
      )}
      {site && (
        <p class="quiet">
          {site.geodetic_latitude.toFixed(4)}°, {site.longitude.toFixed(4)}°, {site.geodetic_altitude} m
        </p>
      )}
      <p class="quiet">{onEarth ? 'On the map, click a site, or use “Pick launch place”.' : 'On the map, use “Pick launch place”.'}</p>
    </>
  );
}

/** Sites by their use; the chosen one is always there. */
function Options({ of, chosen }: { of: ListedSite[]; chosen: string }) {
  const own = sites.value.find(({ slug }) => slug === chosen);
  return (
    <>
      {!of.some(({ slug }) => slug === chosen) && <option value={chosen}>{own ? titleOfSite(own) : chosen}</option>}
      {Object.entries(KINDS).map(([kind, label]) => {
        const group = of.filter((site) => site.kind === kind);
        return group.length === 0 ? null : (
          <optgroup key={kind} label={label}>
            {group.map((site) => (
              <option key={site.slug} value={site.slug}>
                {titleOfSite(site)}
              </option>
            ))}
          </optgroup>
        );
      })}
    </>
  );
}
