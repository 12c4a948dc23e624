import type { Case, Footprint } from '../api';
import { number } from '../figures';
import { endsInWords } from '../target/why';
import { limitsOf, MOST_FREE } from './request';

/** Why no footprint is asked for though it is switched on; null where one is. */
export function whyNoFootprint({ vary }: Case): string | null {
  if (!vary?.length) return `Free one to ${MOST_FREE} numbers to find the ground that flights reach with them.`;
  return vary.length > MOST_FREE ? `At most ${MOST_FREE} numbers may be free for a footprint.` : null;
}

/** A footprint in a sentence: how large it is, and how well it is known. */
export function footprintInWords({ asked, answer, isCoarse }: { asked: Case; answer: Footprint; isCoarse: boolean }): string {
  const { area, boundary, curve, points, pieces, classes, complete, error } = answer;
  const isEmpty = boundary.coordinates.length === 0 && !curve?.coordinates.length;
  if (isEmpty && !complete && points.longitude.length > 0) return 'no boundary found before flights or time ran out';
  if (isEmpty && points.longitude.length === 0) return `no flight lands${classes.length > 0 ? `, they ${endsInWords(classes)}` : ''}`;
  if (isEmpty) return limitsOf(asked).length > 0 ? 'no flight that lands keeps the limits' : 'all flights land in one place';
  const lines = curve?.coordinates.length ?? 0;
  const ground = boundary.coordinates.length > 0 ? `${squareKilometres(area)}${pieces > 1 ? ` in ${pieces} pieces` : ''}` : '';
  const line = lines > 0 ? `a curve${lines > 1 ? ` in ${lines} parts` : ''}${ground ? ' that encloses ' : ''}` : '';
  // Null where nothing is known of it.
  const off = error === null ? '' : `, the ${line && !ground ? 'curve' : 'boundary'} may be off by ${distance(error)}`;
  const known = isCoarse ? 'coarse outline' : complete ? 'complete' : `not complete${off}`;
  return `${line}${ground}, ${known}`;
}

/** An area, of m². */
export function squareKilometres(area: number): string {
  return `${number(area / 1e6, 3)} km²`;
}

const distance = (metres: number) => (metres < 1000 ? `${number(metres, 2)} m` : `${number(metres / 1e3, 2)} km`);

/** A landing that is farthest in one direction. */
type Extreme = NonNullable<Footprint['extent']['downrange'][number]>;

const EXTREMES = [
  { label: 'Least downrange', of: 'downrange', sign: -1 },
  { label: 'Greatest downrange', of: 'downrange', sign: 1 },
  { label: 'Farthest left', of: 'crossrange', sign: -1 },
  { label: 'Farthest right', of: 'crossrange', sign: 1 },
] as const;

/** The four extreme landings of an answer, as far as there are such: of one that ran out of flights the farthest that were flown. */
export function extremesOf({ extent, points }: Footprint): (Extreme & { label: string })[] {
  return EXTREMES.flatMap(({ label, of, sign }) => {
    const extreme = extent[of][sign < 0 ? 0 : 1] ?? farthest(points, of, sign);
    return extreme ? [{ label, ...extreme }] : [];
  });
}

/** The farthest of the landings that keep the limits; null where there is none. */
function farthest(points: Footprint['points'], of: 'downrange' | 'crossrange', sign: number): Extreme | null {
  let [best, most] = [-1, Number.NEGATIVE_INFINITY];
  points[of].forEach((value, index) => {
    if (value === null || !points.within_limits[index] || sign * value <= most) return;
    [best, most] = [index, sign * value];
  });
  if (best < 0) return null;
  const [value, longitude, latitude] = [points[of][best], points.longitude[best], points.geodetic_latitude[best]] as [
    number,
    number,
    number,
  ];
  return { value, values: points.values.map((of) => of[best] as number), site: { longitude, geodetic_latitude: latitude } };
}
