import type { Columns } from './api';

/** A column of a trajectory of which there are plots. */
export type Name = Exclude<keyof Columns, 'utc'>;

export type AngleUnit = 'rad' | 'deg';

/** How a quantity is shown. */
export interface Quantity {
  label: string;
  /** The unit in which it is shown; of an angle that of the case. */
  unit: string;
  /** By which a number in SI is multiplied to be shown; an angle comes in degrees. */
  scale: number;
  angle?: true;
}

const angle = (label: string): Quantity => ({ label, unit: '°', scale: 1, angle: true });
const plain = (label: string, unit: string, scale = 1): Quantity => ({ label, unit, scale });

/** The columns, in the order in which people read them. */
export const QUANTITIES: Record<Name, Quantity> = {
  time: plain('Time', 's'),
  altitude: plain('Altitude', 'km', 1e-3),
  speed: plain('Speed', 'm/s'),
  flight_path_angle: angle('Flight-path angle'),
  heading: angle('Heading'),
  longitude: angle('Longitude'),
  geocentric_latitude: angle('Geocentric latitude'),
  deceleration: plain('Deceleration', 'm/s²'),
  load_factor: plain('Load factor', 'g'),
  dynamic_pressure: plain('Dynamic pressure', 'kPa', 1e-3),
  mach: plain('Mach number', ''),
  convective_heat_flux: plain('Convective heat flux', 'kW/m²', 1e-3),
  radiative_heat_flux: plain('Radiative heat flux', 'kW/m²', 1e-3),
  heat_load: plain('Heat load', 'MJ/m²', 1e-6),
  wall_temperature: plain('Wall temperature', 'K'),
  downrange: plain('Downrange', 'km', 1e-3),
  crossrange: plain('Crossrange', 'km', 1e-3),
  ground_range: plain('Ground range', 'km', 1e-3),
  ground_distance: plain('Ground track length', 'km', 1e-3),
  mass: plain('Mass', 'kg'),
  thrust: plain('Thrust', 'N'),
  throttle: plain('Throttle', ''),
  pitch: angle('Pitch'),
  bank_angle: angle('Bank angle'),
  angle_of_attack: angle('Angle of attack'),
  density: plain('Air density', 'kg/m³'),
  temperature: plain('Air temperature', 'K'),
  pressure: plain('Air pressure', 'Pa'),
  speed_of_sound: plain('Speed of sound', 'm/s'),
  air_speed: plain('Airspeed', 'm/s'),
  azimuth: angle('Azimuth'),
  geodetic_latitude: angle('Geodetic latitude'),
  geodetic_altitude: plain('Geodetic altitude', 'km', 1e-3),
  radius: plain('Radius', 'km', 1e-3),
  inertial_speed: plain('Inertial speed', 'm/s'),
  inertial_flight_path_angle: angle('Inertial flight-path angle'),
  specific_energy: plain('Specific energy', 'MJ/kg', 1e-6),
  energy: plain('Energy relative to the planet', 'MJ/kg', 1e-6),
  semi_major_axis: plain('Semi-major axis', 'km', 1e-3),
  eccentricity: plain('Eccentricity', ''),
  inclination: angle('Inclination'),
  raan: angle('Right ascension of the ascending node'),
  argument_of_periapsis: angle('Argument of periapsis'),
  true_anomaly: angle('True anomaly'),
  apoapsis_altitude: plain('Apoapsis altitude', 'km', 1e-3),
  periapsis_altitude: plain('Periapsis altitude', 'km', 1e-3),
};

/** By which a number of a column is multiplied to be shown, angles in a unit. */
export function scaleOf(name: Name, angleUnit: AngleUnit): number {
  const { scale, angle } = QUANTITIES[name];
  return angle && angleUnit === 'rad' ? Math.PI / 180 : scale;
}

/** The unit in which a column is shown, angles in a unit. */
export function unitOf(name: Name, angleUnit: AngleUnit): string {
  const { unit, angle } = QUANTITIES[name];
  return angle && angleUnit === 'rad' ? 'rad' : unit;
}
