import type { Answer, Schemas } from './api';
import { endOf, type Flight, type Numbers } from './flight';
import { bodyIn, isEarth, titleOfModel } from './planets';
import { type AngleUnit, type Name, QUANTITIES, scaleOf, unitOf } from './quantities';

/** A figure by which a flight is judged. */
export interface Figure {
  label: string;
  unit: string;
  /** In the unit; what has no number is a text. */
  value: number | string;
  /** Where and when, for people. */
  note?: string;
  /** Of a peak, those of the parts of the flight between events. */
  parts?: string;
}

const PEAKS = ['load_factor', 'deceleration', 'dynamic_pressure', 'mach', 'heat_flux', 'heat_load', 'wall_temperature'] as const;

/** The figures of a flight, in the order in which people ask for them. */
export function figuresOf(flight: Flight, angleUnit: AngleUnit): Figure[] {
  const { final, answer } = flight;
  const end = (name: Name): Figure => ({
    label: `Final ${QUANTITIES[name].label.toLowerCase()}`,
    unit: unitOf(name, angleUnit),
    value: (final[name] ?? Number.NaN) * scaleOf(name, angleUnit),
  });
  const peaks = PEAKS.flatMap((name) => {
    const peak = answer.peaks[name];
    if (!peak) return [];
    const like = name === 'heat_flux' ? 'convective_heat_flux' : name;
    const { label, unit, scale } = QUANTITIES[like];
    const title = name === 'heat_flux' ? 'Heat flux' : label;
    return [
      {
        label: name === 'heat_load' ? title : `Peak ${title === 'Mach number' ? title : title.toLowerCase()}`,
        unit: name === 'load_factor' ? unitOfLoad(answer.models.planet) : unit,
        value: peak.value * scale,
        ...(name === 'heat_load' ? {} : { note: whereOf(peak) }),
        ...(name === 'load_factor' ? partsOf(answer) : {}),
      },
    ];
  });
  const highest = answer.peaks.altitude;
  return [
    {
      label: 'Time',
      unit: 's',
      value: final.time ?? Number.NaN,
      note: [capital(endOf(answer)), instantOf(answer)].filter(Boolean).join(', '),
    },
    { label: 'Final position', unit: '', value: placeOf(final, angleUnit), note: 'geodetic latitude, longitude' },
    end('speed'),
    end('flight_path_angle'),
    ...peaks,
    {
      label: 'Maximum altitude',
      unit: 'km',
      value: highest.value / 1e3,
      note: highest.time > (answer.initial_state.time ?? 0) ? `${number(highest.time, 5)} s` : 'at the start',
    },
    final.downrange === undefined
      ? { label: 'Ground range', unit: 'km', value: (final.ground_range ?? Number.NaN) / 1e3 }
      : { label: 'Downrange', unit: 'km', value: final.downrange / 1e3 },
  ];
}

/** The unit of load factors, which is the g of the Earth on every planet. */
export function unitOfLoad(planet: string): string {
  return isEarth(planet) ? 'g' : 'g of the Earth';
}

/** A peak below this share of the greatest is not worth a word. */
const SHARE = 1 / 3;

/** The peak loads of the parts of a flight, so that the opening of a parachute does not hide that of the entry. */
function partsOf({ peaks, phases, events }: Answer): { parts?: string } {
  const told = (phases ?? []).filter((phase) => phase.peaks.load_factor.value >= SHARE * peaks.load_factor.value);
  if (told.length < 2) return {};
  const from = (origin: (typeof told)[number]['from']) => {
    if (!origin) return 'before the first event';
    const name = origin.name ?? events?.find(({ index }) => index === origin.index)?.name ?? `event ${origin.index + 1}`;
    return origin.burnout ? `after burnout of ${name}` : `after ${name}`;
  };
  return { parts: told.map((phase) => `${number(phase.peaks.load_factor.value, 3)} g ${from(phase.from)}`).join(' · ') };
}

function whereOf(peak: { time: number; altitude: number }): string {
  return `${kilometres(peak.altitude, 4)} km, ${number(peak.time, 4)} s`;
}

/** Geodetic latitude and longitude, as other tools take them in degrees: to a metre. */
export function placeOf(row: Numbers, unit: AngleUnit): string {
  const written = (name: Name) => {
    const value = (row[name] ?? Number.NaN) * scaleOf(name, unit);
    return unit === 'deg' ? `${value.toFixed(5)}°` : `${value.toFixed(7)} rad`;
  };
  return `${written('geodetic_latitude')}, ${written('longitude')}`;
}

export const capital = (text: string) => text.charAt(0).toUpperCase() + text.slice(1);

/** When a flight ends, in UTC to the second; nothing where its case has no epoch. */
function instantOf({ final_state: { utc } }: Answer): string | null {
  return utc ? `${utc.slice(0, 19).replace('T', ' ')} UTC` : null;
}

const EARTHS: Record<string, string> = {
  earth_wgs84: 'WGS 84',
  earth_jameson_listing: 'thesis listing',
  earth_jameson_text: 'thesis text',
};
const ATMOSPHERES: Record<Schemas['Atmosphere']['type'], string> = {
  standard: 'standard atmosphere',
  exponential: 'exponential atmosphere',
  us76: 'U.S. Standard Atmosphere 1976',
  nrlmsise00: 'NRLMSISE-00',
  layered_exponential: 'layered exponential atmosphere',
  table: 'tabulated atmosphere',
  vacuum: 'no atmosphere',
};
const GRAVITIES: Record<Schemas['Gravity']['type'], string> = {
  inverse_square: 'inverse-square gravity',
  zonal: 'zonal gravity',
};

/** A text with the names of planets in words. */
export function withPlanetsInWords(text: string): string {
  return text.replaceAll(/earth_\w+/g, (name) => EARTHS[name] ?? name);
}

/** The models of a flight: planet, atmosphere, gravity. */
export function modelsInWords({ planet, shape, atmosphere, gravity }: Answer['models']): string {
  const air = ATMOSPHERES[atmosphere as keyof typeof ATMOSPHERES] ?? atmosphere;
  const name = EARTHS[planet] ?? titleOfModel(planet);
  const ground = planet.startsWith('earth_jameson') ? `Earth ${shape} (${name})` : `${name} ${shape}`;
  const of = atmosphere === 'standard' ? ` of ${bodyIn(planet)}` : '';
  return `${ground}, ${air}${of}, ${GRAVITIES[gravity as keyof typeof GRAVITIES] ?? gravity}`;
}

/** A number to so many digits, without zeros at its end. */
export function number(value: number, digits = 6): string {
  if (!Number.isFinite(value)) return '–';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e9 || size < 1e-4) return Number(value.toPrecision(digits)).toExponential().replace('-', '−').replace('e+', 'e');
  return Number(value.toPrecision(digits))
    .toLocaleString('en', { maximumFractionDigits: 12, useGrouping: size >= 1e5 })
    .replace('-', '−');
}

/** A number to four digits, zeros at its end among them: it keeps its width while it changes. */
export function reading(value: number): string {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e7)) return value.toExponential(3).replaceAll('-', '−').replace('e+', 'e');
  return value.toFixed(decimalsFor(size, 4)).replace('-', '−');
}

/** So many decimals that a number of this size has so many digits. */
function decimalsFor(size: number, digits: number): number {
  return size === 0 ? digits - 1 : Math.min(Math.max(digits - 1 - Math.floor(Math.log10(size)), 0), 20);
}

/** The numbers of a column, with the same decimals, six digits in its greatest; by powers of ten where the least would vanish. */
export function columnOf(values: number[]): string[] {
  const sizes = values.map(Math.abs).filter((size) => size > 0 && Number.isFinite(size));
  const [least, greatest] = [Math.min(...sizes), Math.max(...sizes, 0)];
  const decimals = decimalsFor(greatest, 6);
  const isWide = sizes.length > 0 && (greatest >= 1e9 || greatest < 1e-3 || (least < 1e-3 && least < 10 ** -decimals));
  return values.map((value) => {
    if (!Number.isFinite(value)) return '–';
    return (isWide ? value.toExponential(4) : value.toFixed(decimals)).replaceAll('-', '−').replace('e+', 'e');
  });
}

/** A length in km, of metres to the millimetre: a flight ends on the ground and not a rounding above it. */
export function kilometres(metres: number, digits = 6): string {
  return number(Math.round(metres * 1e3) / 1e6, digits);
}

/** A number with its sign. */
export function difference(value: number): string {
  return value > 0 ? `+${number(value, 4)}` : number(value, 4);
}

/** The distance, km, between the ends of two flights, along a sphere of the mean radius there. */
export function endsApart(a: Flight, b: Flight): number {
  const direction = ({ geocentric_latitude: latitude = 0, longitude = 0 }: Numbers) => {
    const [phi, lambda] = [(latitude * Math.PI) / 180, (longitude * Math.PI) / 180];
    return [Math.cos(phi) * Math.cos(lambda), Math.cos(phi) * Math.sin(lambda), Math.sin(phi)] as const;
  };
  const [p, q] = [direction(a.final), direction(b.final)];
  const cross = Math.hypot(p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]);
  const dot = p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  return ((((a.final.radius ?? 0) + (b.final.radius ?? 0)) / 2) * Math.atan2(cross, dot)) / 1e3;
}
