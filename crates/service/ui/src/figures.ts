import type { Flight, Numbers } from './flight';
import { type AngleUnit, type Name, QUANTITIES, scaleOf, unitOf } from './quantities';

/** A figure by which a flight is judged. */
export interface Figure {
  label: string;
  unit: string;
  /** In the unit; what has no number is a text. */
  value: number | string;
  /** Where and when, for people. */
  note?: string;
}

const ENDS = {
  surface_impact: 'Impact',
  stop_altitude: 'Stop altitude',
  time_limit: 'Time limit',
  condition: 'Stop condition',
  atmosphere_exit: 'Exit',
} as const;

const PEAKS = ['load_factor', 'deceleration', 'dynamic_pressure', 'mach', 'heat_flux', 'heat_load', 'wall_temperature'] as const;

/** How a flight ended, in a word or two. */
export function endOf(flight: Flight): string {
  return ENDS[flight.answer.termination];
}

/** The figures of a flight, in the order in which people ask for them. */
export function figuresOf(flight: Flight, angleUnit: AngleUnit): Figure[] {
  const { final, answer } = flight;
  const end = (name: Name): Figure => ({
    label: `${QUANTITIES[name].label} at the end`,
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
        unit,
        value: peak.value * scale,
        ...(name === 'heat_load' ? {} : { note: whereOf(peak) }),
      },
    ];
  });
  const highest = answer.peaks.altitude;
  return [
    { label: 'Time', unit: 's', value: final.time ?? Number.NaN, note: endOf(flight) },
    { label: 'Place', unit: '', value: placeOf(final), note: 'geodetic latitude, longitude' },
    end('speed'),
    end('flight_path_angle'),
    ...peaks,
    { label: 'Highest point', unit: 'km', value: highest.value / 1e3, note: `${number(highest.time, 5)} s` },
    ...(final.downrange === undefined ? [] : [{ label: 'Downrange', unit: 'km', value: final.downrange / 1e3 }]),
  ];
}

function whereOf(peak: { time: number; altitude: number }): string {
  return `${kilometres(peak.altitude, 4)} km, ${number(peak.time, 4)} s`;
}

/** Geodetic latitude and longitude, degrees, as other tools take them. */
export function placeOf(row: Numbers): string {
  return `${(row.geodetic_latitude ?? Number.NaN).toFixed(5)}°, ${(row.longitude ?? Number.NaN).toFixed(5)}°`;
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
