import type { Schemas } from '../api';

/** A field of a form, or a group of them. What it means and its bounds stand in the OpenAPI document. */
export type Field =
  /** A number; an angle has the unit of the case. Of fields with the same `choice`, exactly one is given. */
  | { kind: 'number'; label: string; unit?: string; isAngle?: true; choice?: string }
  | { kind: 'text'; label: string; hint?: string; choice?: string }
  | { kind: 'flag'; label: string }
  /** One of several words; without `required`, the first is what the service takes when none is given. */
  | { kind: 'words'; label: string; words: Record<string, string>; choice?: string }
  /** Three numbers. */
  | { kind: 'vector'; label: string; unit: string }
  /** Numbers, of which several fields of the same `table` have as many: edited side by side. */
  | { kind: 'column'; label: string; unit?: string; isAngle?: true; table: string; choice?: string }
  /** A list of numbers in a line; with `orOne`, a single one is a number. */
  | { kind: 'numbers'; label: string; unit?: string; isAngle?: true; choice?: string; orOne?: true }
  /** Rows of numbers. */
  | { kind: 'matrix'; label: string }
  /** Words of a list, each at most once. */
  | { kind: 'several'; label: string; words: readonly string[] }
  /** A number, or a schedule. */
  | { kind: 'command'; label: string }
  /** A direction: a word, or one in inertial space. */
  | { kind: 'along'; label: string; words: Record<string, string> }
  /** Names in a line, apart by commas. */
  | { kind: 'names'; label: string; hint?: string }
  /** A correlation of the convective heat flux by its name, or with the constant of a gas. */
  | { kind: 'convective'; label: string }
  /** A thrust, or `"off"`. */
  | { kind: 'thrust'; label: string }
  | { kind: 'group'; label: string; schema: string; fields: Fields; isOptional?: string }
  /** One of several kinds, told by `type`; `none` is what it is called that there is none, where there may be none. */
  | { kind: 'variant'; label: string; kinds: Record<string, Kind>; none?: string }
  | { kind: 'list'; label: string; item: Field; one: string; empty: object; choice?: string };

export type Fields = Record<string, Field>;

export interface Kind {
  label: string;
  schema: string;
  fields: Fields;
}

/** The kind of a variant that a `type` tells; undefined where it is none, whatever a case has there. */
export function kindOf(kinds: Record<string, Kind>, type: unknown): Kind | undefined {
  return typeof type === 'string' && Object.hasOwn(kinds, type) ? kinds[type] : undefined;
}

/** A field for every property of a schema: one that is added to the contract and not here does not compile. */
type Of<T> = Record<Exclude<keyof T, 'type'>, Field>;

const n = (label: string, unit?: string, choice?: string): Field => ({
  kind: 'number',
  label,
  ...(unit ? { unit } : {}),
  ...(choice ? { choice } : {}),
});
const angle = (label: string, choice?: string): Field => ({ kind: 'number', label, isAngle: true, ...(choice ? { choice } : {}) });
const column = (table: string, label: string, unit?: string): Field => ({ kind: 'column', label, table, ...(unit ? { unit } : {}) });
/** Of which at most one is given. */
const SIDEREAL = {
  sidereal_time: { kind: 'text', label: 'Sidereal time', hint: 's or HH:MM:SS', choice: 'sidereal' },
  sidereal_angle: angle('Sidereal angle', 'sidereal'),
} satisfies Fields;
const FRAME: Field = {
  kind: 'words',
  label: 'Inertial frame',
  words: { date: 'of date', teme: 'TEME (SGP4)', gcrf: 'GCRF (J2000)' } satisfies Record<Schemas['Frame'], string>,
};

export const STATES = {
  planet_relative: {
    label: 'Planet-relative (the thesis’s)',
    schema: 'PlanetRelative',
    fields: {
      altitude: n('Altitude', 'm', 'height'),
      radius: n('Radius', 'm', 'height'),
      longitude: angle('Longitude'),
      geocentric_latitude: angle('Latitude, geocentric'),
      speed: n('Speed', 'm/s'),
      flight_path_angle: angle('Flight-path angle'),
      heading: angle('Heading, from east to north', 'direction'),
      azimuth: angle('Azimuth, clockwise from north', 'direction'),
      ...SIDEREAL,
    } satisfies Of<Schemas['PlanetRelative']>,
  },
  geodetic: {
    label: 'Geodetic',
    schema: 'Geodetic',
    fields: {
      geodetic_altitude: n('Altitude, geodetic', 'm'),
      longitude: angle('Longitude'),
      geodetic_latitude: angle('Latitude, geodetic'),
      speed: n('Speed', 'm/s'),
      flight_path_angle: angle('Flight-path angle'),
      azimuth: angle('Azimuth, clockwise from north'),
      ...SIDEREAL,
    } satisfies Of<Schemas['Geodetic']>,
  },
  inertial_flight_path: {
    label: 'Inertial entry interface',
    schema: 'InertialFlightPath',
    fields: {
      altitude: n('Altitude', 'm', 'height'),
      radius: n('Radius', 'm', 'height'),
      longitude: angle('Longitude'),
      geocentric_latitude: angle('Latitude, geocentric'),
      inertial_speed: n('Inertial speed', 'm/s'),
      inertial_flight_path_angle: angle('Inertial flight-path angle'),
      inertial_azimuth: angle('Inertial azimuth', 'direction'),
      inertial_heading: angle('Inertial heading', 'direction'),
      ...SIDEREAL,
    } satisfies Of<Schemas['InertialFlightPath']>,
  },
  ecef: {
    label: 'Planet-fixed vectors (ECEF)',
    schema: 'Ecef',
    fields: {
      position: { kind: 'vector', label: 'Position', unit: 'm' },
      velocity: { kind: 'vector', label: 'Velocity', unit: 'm/s' },
      ...SIDEREAL,
    } satisfies Of<Schemas['Ecef']>,
  },
  eci: {
    label: 'Inertial vectors (ECI)',
    schema: 'Eci',
    fields: {
      frame: FRAME,
      position: { kind: 'vector', label: 'Position', unit: 'm' },
      velocity: { kind: 'vector', label: 'Velocity', unit: 'm/s' },
      ...SIDEREAL,
    } satisfies Of<Schemas['Eci']>,
  },
  orbital_elements: {
    label: 'Orbital elements',
    schema: 'OrbitalElements',
    fields: {
      frame: FRAME,
      semi_major_axis: n('Semi-major axis', 'm', 'size'),
      semi_latus_rectum: n('Semi-latus rectum', 'm', 'size'),
      eccentricity: n('Eccentricity'),
      inclination: angle('Inclination'),
      raan: angle('Ascending node (RAAN)'),
      argument_of_periapsis: angle('Argument of periapsis'),
      true_anomaly: angle('True anomaly', 'anomaly'),
      mean_anomaly: angle('Mean anomaly', 'anomaly'),
      ...SIDEREAL,
    } satisfies Of<Schemas['OrbitalElements']>,
  },
} satisfies Record<Schemas['State']['type'], Kind>;

const GRAVITY: Record<Schemas['Gravity']['type'], Kind> = {
  inverse_square: { label: 'Inverse square', schema: 'InverseSquareGravity', fields: {} satisfies Of<Schemas['InverseSquareGravity']> },
  zonal: {
    label: 'Zonal harmonics',
    schema: 'ZonalGravity',
    fields: { degree: n('Degree'), j2: n('J₂'), j3: n('J₃'), j4: n('J₄') } satisfies Of<Schemas['ZonalGravity']>,
  },
};

const PLANET = {
  model: {
    kind: 'words',
    label: 'Planet',
    words: {
      earth_wgs84: 'Earth, WGS 84',
      earth_jameson_listing: 'Earth, the thesis’s listing',
      earth_jameson_text: 'Earth, the thesis’s text',
      custom: 'Custom',
    } satisfies Record<Schemas['PlanetModel'], string>,
  },
  shape: { kind: 'words', label: 'Shape', words: { ellipsoid: 'Ellipsoid', sphere: 'Sphere' } satisfies Record<Schemas['Shape'], string> },
  gravity: { kind: 'variant', label: 'Gravity', kinds: GRAVITY, none: 'Inverse square (default)' },
  gravitational_parameter: n('Gravitational parameter', 'm³/s²'),
  equatorial_radius: n('Equatorial radius', 'm'),
  polar_radius: n('Polar radius', 'm'),
  rotation_rate: n('Rotation rate', 'rad/s'),
} satisfies Of<Schemas['Planet']>;

const LAYER = { base_altitude: n('Base', 'm'), density: n('Density', 'kg/m³'), scale_height: n('Scale height', 'm') } satisfies Of<
  Schemas['Layer']
>;

const ATMOSPHERE: Record<Schemas['Atmosphere']['type'], Kind> = {
  exponential: {
    label: 'Exponential',
    schema: 'ExponentialAtmosphere',
    fields: { surface_density: n('Density at the surface', 'kg/m³'), scale_height: n('Scale height', 'm') } satisfies Of<
      Schemas['ExponentialAtmosphere']
    >,
  },
  us76: { label: 'U.S. Standard Atmosphere, 1976', schema: 'Us76Atmosphere', fields: {} satisfies Of<Schemas['Us76Atmosphere']> },
  layered_exponential: {
    label: 'Exponential in layers',
    schema: 'LayeredAtmosphere',
    fields: {
      preset: {
        kind: 'words',
        label: 'Preset',
        words: { earth_seven_layer: 'Earth in seven layers' } satisfies Record<Schemas['LayersPreset'], string>,
        choice: 'layers',
      },
      layers: {
        kind: 'list',
        label: 'Layers',
        one: 'layer',
        choice: 'layers',
        empty: { base_altitude: 0, density: 1.225, scale_height: 7200 },
        item: { kind: 'group', label: 'Layer', schema: 'Layer', fields: LAYER },
      },
    } satisfies Of<Schemas['LayeredAtmosphere']>,
  },
  table: {
    label: 'Table',
    schema: 'TableAtmosphere',
    fields: {
      altitude: column('air', 'Altitude', 'm'),
      density: column('air', 'Density', 'kg/m³'),
      temperature: column('air', 'Temperature', 'K'),
      pressure: column('air', 'Pressure', 'Pa'),
      speed_of_sound: { kind: 'numbers', label: 'Speeds of sound', unit: 'm/s' },
      molar_mass: { kind: 'numbers', label: 'Molar mass', unit: 'kg/mol', orOne: true },
      heat_capacity_ratio: { kind: 'numbers', label: 'Heat capacity ratio', orOne: true },
    } satisfies Of<Schemas['TableAtmosphere']>,
  },
  vacuum: { label: 'Vacuum', schema: 'Vacuum', fields: {} satisfies Of<Schemas['Vacuum']> },
};

const WIND: Record<Schemas['Wind']['type'], Kind> = {
  constant: {
    label: 'The same everywhere',
    schema: 'ConstantWind',
    fields: {
      east: n('Towards the east', 'm/s'),
      north: n('Towards the north', 'm/s'),
      speed: n('Speed', 'm/s'),
      from: angle('From, clockwise from north'),
    } satisfies Of<Schemas['ConstantWind']>,
  },
  table: {
    label: 'By altitude',
    schema: 'TableWind',
    fields: {
      altitude: column('wind', 'Altitude', 'm'),
      east: column('wind', 'East', 'm/s'),
      north: column('wind', 'North', 'm/s'),
      speed: column('wind', 'Speed', 'm/s'),
      from: { kind: 'column', label: 'From', isAngle: true, table: 'wind' },
    } satisfies Of<Schemas['TableWind']>,
  },
};

/** Sutton and Graves's correlation in a gas. */
export const SUTTON_GRAVES = { constant: n('Constant', '√kg/m') } satisfies Of<Schemas['SuttonGraves']>;

/** The correlations of the convective heat flux in air. */
export const CONVECTIVE = {
  sutton_graves: 'Sutton and Graves',
  detra_kemp_riddell: 'Detra, Kemp and Riddell',
  chapman: 'Chapman',
} satisfies Record<Schemas['Convective'], string>;

const AERODYNAMICS: Record<Schemas['Aerodynamics']['type'], Kind> = {
  constant: {
    label: 'Constant coefficients',
    schema: 'ConstantAerodynamics',
    fields: { drag_coefficient: n('Drag coefficient'), lift_coefficient: n('Lift coefficient') } satisfies Of<
      Schemas['ConstantAerodynamics']
    >,
  },
  ballistic: {
    label: 'Ballistic coefficient',
    schema: 'BallisticAerodynamics',
    fields: { ballistic_coefficient: n('Ballistic coefficient', 'kg/m²'), lift_to_drag: n('Lift over drag') } satisfies Of<
      Schemas['BallisticAerodynamics']
    >,
  },
  mach_table: {
    label: 'By Mach number',
    schema: 'MachTable',
    fields: {
      mach: column('mach', 'Mach'),
      drag_coefficient: column('mach', 'Drag coefficient'),
      lift_coefficient: column('mach', 'Lift coefficient'),
    } satisfies Of<Schemas['MachTable']>,
  },
  alpha_mach_table: {
    label: 'By angle of attack and Mach number',
    schema: 'AlphaMachTable',
    fields: {
      angle_of_attack: { kind: 'numbers', label: 'Angles of attack (rows)', isAngle: true },
      mach: { kind: 'numbers', label: 'Mach numbers (columns)' },
      drag_coefficient: { kind: 'matrix', label: 'Drag coefficients' },
      lift_coefficient: { kind: 'matrix', label: 'Lift coefficients' },
    } satisfies Of<Schemas['AlphaMachTable']>,
  },
};

const VEHICLE = {
  mass: n('Mass', 'kg'),
  reference_area: n('Reference area', 'm²'),
  nose_radius: n('Nose radius', 'm'),
  aerodynamics: { kind: 'variant', label: 'Aerodynamics', kinds: AERODYNAMICS },
} satisfies Of<Schemas['Vehicle']>;

export const SCHEDULE: Kind = {
  label: 'Schedule',
  schema: 'Schedule',
  fields: {
    against: {
      kind: 'words',
      label: 'Against',
      words: { time: 'Time, s', altitude: 'Altitude, m', speed: 'Speed, m/s', mach: 'Mach number' } satisfies Record<
        Schemas['Against'],
        string
      >,
    },
    at: column('schedule', 'At'),
    value: { kind: 'column', label: 'Angle', isAngle: true, table: 'schedule' },
    interpolation: {
      kind: 'words',
      label: 'In between',
      words: { linear: 'Straight lines', step: 'Steps' } satisfies Record<Schemas['Interpolation'], string>,
    },
  } satisfies Of<Schemas['Schedule']>,
};

const QUANTITIES = {
  time: 'Time, s',
  altitude: 'Altitude, m',
  speed: 'Speed, m/s',
  mach: 'Mach number',
  dynamic_pressure: 'Dynamic pressure, Pa',
  load_factor: 'Load factor, g',
  flight_path_angle: 'Flight-path angle',
  mass: 'Mass, kg',
  air_speed: 'Air speed, m/s',
  inertial_speed: 'Inertial speed, m/s',
  specific_energy: 'Specific energy, J/kg',
  apoapsis_altitude: 'Apoapsis altitude, m',
  periapsis_altitude: 'Periapsis altitude, m',
  inclination: 'Inclination',
  heat_flux: 'Heat flux, W/m²',
  heat_load: 'Heat load, J/m²',
  wall_temperature: 'Wall temperature, K',
  downrange: 'Downrange, m',
  ground_range: 'Ground range, m',
  deceleration: 'Deceleration, m/s²',
  density: 'Density, kg/m³',
} satisfies Record<Schemas['Quantity'], string>;

const CONDITION: Field = {
  kind: 'group',
  label: 'When',
  schema: 'Condition',
  fields: {
    quantity: { kind: 'words', label: 'Quantity', words: QUANTITIES },
    falls_through: n('falls through', undefined, 'way'),
    rises_through: n('rises through', undefined, 'way'),
    event: { kind: 'text', label: 'or after the event', hint: 'its name' },
    delay: n('Delay after it', 's'),
  } satisfies Of<Schemas['Condition']>,
};

const ALONG: Field = {
  kind: 'along',
  label: 'Along',
  words: {
    velocity: 'the velocity',
    horizontal: 'the velocity’s level part',
    radial: 'the radius, outwards',
    normal: 'the normal, left',
  } satisfies Record<Schemas['Axis'], string>,
};

/** A thrust that is switched on. */
export const THRUST = {
  along: ALONG,
  value: n('Thrust', 'N'),
  specific_impulse: n('Specific impulse', 's'),
  propellant: n('Propellant', 'kg'),
} satisfies Of<Schemas['Thrust']>;

const EFFECT = {
  mass: n('Mass becomes', 'kg'),
  reference_area: n('Reference area becomes', 'm²'),
  aerodynamics: { kind: 'variant', label: 'Aerodynamics become', kinds: AERODYNAMICS, none: 'as before' },
  delta_v: {
    kind: 'group',
    label: 'Impulse',
    schema: 'DeltaV',
    isOptional: 'An impulse',
    fields: { along: ALONG, value: n('Change of speed', 'm/s') } satisfies Of<Schemas['DeltaV']>,
  },
  thrust: { kind: 'thrust', label: 'Thrust' },
  deploy: {
    kind: 'group',
    label: 'Parachute',
    schema: 'Parachute',
    isOptional: 'A parachute',
    fields: {
      name: { kind: 'text', label: 'Name' },
      drag_area: n('Drag area', 'm²'),
      inflation_time: n('Inflation time', 's'),
      delay: n('Delay', 's'),
    } satisfies Of<Schemas['Parachute']>,
  },
  release: { kind: 'names', label: 'Release', hint: 'names of parachutes' },
} satisfies Of<Schemas['Effect']>;

const COLUMNS = [
  'time',
  'altitude',
  'radius',
  'longitude',
  'geocentric_latitude',
  'geodetic_latitude',
  'geodetic_altitude',
  'speed',
  'flight_path_angle',
  'heading',
  'density',
  'dynamic_pressure',
  'deceleration',
  'load_factor',
  'azimuth',
  'air_speed',
  'temperature',
  'pressure',
  'speed_of_sound',
  'mach',
  'bank_angle',
  'angle_of_attack',
  'downrange',
  'crossrange',
  'inertial_speed',
  'inertial_flight_path_angle',
  'specific_energy',
  'utc',
  'convective_heat_flux',
  'radiative_heat_flux',
  'heat_load',
  'wall_temperature',
  'mass',
  'ground_range',
  'ground_distance',
  'semi_major_axis',
  'eccentricity',
  'inclination',
  'raan',
  'argument_of_periapsis',
  'true_anomaly',
  'apoapsis_altitude',
  'periapsis_altitude',
  'thrust',
] as const satisfies readonly (keyof Schemas['Columns'])[];

/** The form of a case, a section each. */
export const SECTIONS = {
  vehicle: { kind: 'group', label: 'Vehicle', schema: 'Vehicle', fields: VEHICLE },
  initial_state: { kind: 'variant', label: 'Initial state', kinds: STATES },
  control: {
    kind: 'group',
    label: 'Control',
    schema: 'Control',
    fields: {
      bank_angle: { kind: 'command', label: 'Bank angle' },
      angle_of_attack: { kind: 'command', label: 'Angle of attack' },
    } satisfies Of<Schemas['Control']>,
  },
  atmosphere: { kind: 'variant', label: 'Atmosphere', kinds: ATMOSPHERE, none: 'Exponential (default)' },
  density_factor: n('Density factor'),
  wind: { kind: 'variant', label: 'Wind', kinds: WIND, none: 'Still air' },
  planet: { kind: 'group', label: 'Planet', schema: 'Planet', fields: PLANET },
  heating: {
    kind: 'group',
    label: 'Heating',
    schema: 'Heating',
    isOptional: 'Compute heat fluxes (the vehicle needs a nose radius)',
    fields: {
      convective: { kind: 'convective', label: 'Convective' },
      radiative: {
        kind: 'words',
        label: 'Radiative',
        words: { none: 'None', tauber_sutton: 'Tauber and Sutton' } satisfies Record<Schemas['Radiative'], string>,
      },
      emissivity: n('Emissivity of the wall'),
    } satisfies Of<Schemas['Heating']>,
  },
  events: {
    kind: 'list',
    label: 'Events',
    one: 'event',
    empty: { when: { quantity: 'altitude', falls_through: 10000 }, then: {} },
    item: {
      kind: 'group',
      label: 'Event',
      schema: 'Event',
      fields: {
        name: { kind: 'text', label: 'Name' },
        when: CONDITION,

        then: { kind: 'group', label: 'Then', schema: 'Effect', fields: EFFECT },
      } satisfies Of<Schemas['Event']>,
    },
  },
  stop: {
    kind: 'group',
    label: 'Stop',
    schema: 'Stop',
    fields: {
      altitude: n('Altitude', 'm'),
      time: n('Time', 's'),
      ceiling: n('Ceiling', 'm'),
      when: { kind: 'list', label: 'Conditions', one: 'condition', empty: { quantity: 'load_factor', rises_through: 12 }, item: CONDITION },
    } satisfies Of<Schemas['Stop']>,
  },
  epoch: { kind: 'text', label: 'Epoch of t = 0, UTC', hint: '2026-11-26T12:00:00Z' },
  solver: {
    kind: 'group',
    label: 'Solver',
    schema: 'Solver',
    fields: {
      formulation: {
        kind: 'words',
        label: 'Formulation',
        words: { cartesian: 'Cartesian', spherical: 'Spherical (the thesis’s)' } satisfies Record<Schemas['Formulation'], string>,
      },
      relative_tolerance: n('Relative tolerance'),
    } satisfies Of<Schemas['Solver']>,
  },
  output: {
    kind: 'group',
    label: 'Rows of downloads',
    schema: 'Output',
    fields: {
      samples_per_step: n('Rows a step', undefined, 'rows'),
      interval: n('Seconds between rows', undefined, 'rows'),
      count: n('Number of rows', undefined, 'rows'),
      times: { kind: 'numbers', label: 'At the instants', unit: 's', choice: 'rows' },
      trajectory: { kind: 'words', label: 'None', words: {}, choice: 'rows' },
      columns: { kind: 'several', label: 'Columns', words: COLUMNS },
    } satisfies Of<Schemas['Output']>,
  },
  name: { kind: 'text', label: 'Name' },
  sensitivities: { kind: 'flag', label: 'Sensitivities of the end' },
  verify: { kind: 'flag', label: 'Verify the accuracy' },
  angle_unit: {
    kind: 'words',
    label: 'Angles in the JSON',
    words: { rad: 'radians', deg: 'degrees' } satisfies Record<Schemas['AngleUnit'], string>,
  },
  echo: { kind: 'flag', label: 'Repeat the case in the answer' },
} satisfies Of<Schemas['SimulateRequest']>;
