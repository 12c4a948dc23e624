import type { Case } from '../api';
import { turned } from '../case';
import { capital, kilometres, number, placeOf } from '../figures';
import { Explained } from '../guide';
import type { AngleUnit } from '../quantities';
import { Scroll } from '../scroll';
import { titleOfSite } from '../sites';
import { angleUnit, current, draft } from '../store';
import { valueInWords, variedNumbers } from '../target/why';
import { isSurveying, type Reached, reached, sitesWithin } from './live';
import { withValues } from './request';
import { extremesOf, footprintInWords, squareKilometres, whyNoFootprint } from './words';

/** Switches the footprint on and off; the panel has it as well as the head of the flight. */
export function AskForFootprint() {
  const isOn = Boolean(draft.value.footprint);
  return (
    <button
      type="button"
      aria-pressed={isOn}
      disabled={!current.value && !isOn}
      title="Find the ground that flights reach with the numbers that are free"
      onClick={() => {
        draft.value = switched(draft.peek(), !isOn);
      }}
    >
      Footprint
    </button>
  );
}

/** A case with the footprint on or off; where it has limits of its own, it says that it is off. */
export function switched({ footprint: _, ...tree }: Case, isOn: boolean): Case {
  if (isOn) return { ...tree, footprint: true };
  return tree.limits && !tree.achieve ? { ...tree, footprint: false } : tree;
}

/** The footprint in words and numbers, where it is asked for. */
export function FootprintPart() {
  if (!draft.value.footprint) return null;
  const why = whyNoFootprint(draft.value);
  const shown = reached.value;
  return (
    <section class="footprint" aria-label="Footprint">
      <h3>Footprint</h3>
      {why ? (
        <p class="quiet">{why}</p>
      ) : shown ? (
        <>
          <Sentence shown={shown} />
          <FootprintWarnings shown={shown} />
          <SitesWithin />
          <Extremes shown={shown} />
        </>
      ) : (
        <p class="quiet">{isSurveying.value ? 'Searching …' : ''}</p>
      )}
    </section>
  );
}

/** How large it is and how well it is known, with what the map has of it. */
function Sentence({ shown }: { shown: Reached }) {
  const { answer, wide, isCoarse } = shown;
  const { flights, elapsed } = answer.search;
  return (
    <>
      <p class="outcome" role="status">
        {capital(footprintInWords(shown))}.{' '}
        <span class="quiet">
          {`${number(flights, 6)} flights, ${number(elapsed, 2)} s`}
          {isCoarse && isSurveying.value ? '; refining …' : ''}
        </span>
      </p>
      <ul class="key quiet" aria-label="Marks on the map">
        {answer.boundary.coordinates.length > 0 && (
          <li>
            <span class="key-area" />
            {wide ? 'within all limits' : 'within reach'}
          </li>
        )}
        {answer.curve && answer.curve.coordinates.length > 0 && (
          <li>
            <span class="key-line" />
            {wide ? 'landings within all limits' : 'landings'}
          </li>
        )}
        {wide && (wide.boundary.coordinates.length > 0 || wide.curve) && (
          <li>
            <span class="key-edge" />
            without limits{wide.curve ? '' : `: ${squareKilometres(wide.area)}`}
          </li>
        )}
        {extremesOf(answer).length > 0 && (
          <li>
            <span class="key-mark" />
            farthest landings
          </li>
        )}
      </ul>
    </>
  );
}

/** Warnings that are of a footprint; those of the case stand above its flight. */
const CODES = ['partly_landed', 'coarse_boundary'];

function FootprintWarnings({ shown: { answer, isCoarse } }: { shown: Reached }) {
  // An outline that is refined at rest is coarse by intent.
  const warnings = answer.warnings.filter(({ code }) => CODES.includes(code) && !(isCoarse && code === 'coarse_boundary'));
  if (warnings.length === 0) return null;
  return (
    <ul class="footprint-warnings" aria-label="Warnings of the footprint">
      {warnings.map(({ code, detail }) => (
        <li key={code}>
          {detail} <Explained at={`warnings/${code}`} name={code} />
        </li>
      ))}
    </ul>
  );
}

/** So many sites are named. */
const MOST_SITES = 12;

/** Where vehicles land that is within the footprint, once the sites are loaded. */
function SitesWithin() {
  const inside = sitesWithin.value;
  if (inside.length === 0) return null;
  const more = inside.length - MOST_SITES;
  return (
    <p>
      {`Landing sites within: ${inside.slice(0, MOST_SITES).map(titleOfSite).join('; ')}`}
      {more > 0 ? `; and ${more} more` : ''}.
    </p>
  );
}

/** A place of an answer in degrees. */
function inDegrees(site: { longitude: number; geodetic_latitude: number }, unit: AngleUnit) {
  const [longitude, latitude] = [site.longitude, site.geodetic_latitude].map((angle) => turned(angle, unit, 'deg') as number);
  return { longitude, geodetic_latitude: latitude } as { longitude: number; geodetic_latitude: number };
}

/** The extreme landings, a line each. */
function Extremes({ shown: { asked, answer } }: { shown: Reached }) {
  const rows = extremesOf(answer);
  if (rows.length === 0) return null;
  const numbers = variedNumbers(asked);
  return (
    <Scroll label="Farthest landings">
      <table>
        <thead>
          <tr>
            <th scope="col">Landing</th>
            <th scope="col">Value, km</th>
            {numbers.map(({ label }, index) => (
              <th scope="col" key={`${index}${label}`}>
                {label}
              </th>
            ))}
            <th scope="col">Latitude, longitude</th>
            <th scope="col">
              <span class="hidden">Take</span>
            </th>
          </tr>
        </thead>
        <tbody>
          {rows.map(({ label, value, values, site }) => (
            <tr key={label}>
              <th scope="row">{label}</th>
              <td>{kilometres(value, 5)}</td>
              {numbers.map((one, place) => (
                <td key={`${place}${one.label}`}>{valueInWords(one, values[place] ?? Number.NaN, answer.angle_unit, angleUnit.value)}</td>
              ))}
              <td>{placeOf(inDegrees(site, answer.angle_unit), angleUnit.value)}</td>
              <td>
                <button
                  type="button"
                  class="small"
                  aria-label={`Take the landing into the case: ${label.toLowerCase()}`}
                  onClick={() => {
                    draft.value = withValues(draft.peek(), values);
                  }}
                >
                  Take
                </button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Scroll>
  );
}
