import { describe, expect, it, vi } from 'vitest';
import type { Case, Footprint, Goal } from '../../src/api';
import { adopted, alone } from '../../src/case';
import { edgesOf, groundOf, within } from '../../src/footprint/ground';
import { switched } from '../../src/footprint/panel';
import { coarse, dependence, footprintRequest, withoutLimits, withValues } from '../../src/footprint/request';
import { footprintInWords, whyNoFootprint } from '../../src/footprint/words';
import { whyNoCase } from '../../src/form/shape';
import { fromFragment, toFragment } from '../../src/link';

vi.stubGlobal('document', { baseURI: 'http://localhost/' });

const FLIGHT = {
  angle_unit: 'deg',
  vehicle: { mass: 5500, reference_area: 12, aerodynamics: { type: 'constant', drag_coefficient: 1.3, lift_coefficient: 0.39 } },
  control: { bank_angle: { type: 'schedule', against: 'time', at: [0, 250, 260], value: [40, 40, -40] } },
  initial_state: { type: 'planet_relative', altitude: 120000, longitude: 0, geocentric_latitude: 0, speed: 7400, flight_path_angle: -2 },
} as unknown as Case;
const FIRST = {
  pointer: '/control/bank_angle/value/0',
  between: [-90, 90] as [number, number],
  also: [{ pointer: '/control/bank_angle/value/1', factor: 1 }],
};
const SECOND = { pointer: '/control/bank_angle/value/2', between: [-90, 90] as [number, number] };
const SITE = { site: { longitude: 67, geodetic_latitude: 48 }, within: 1e5 } as unknown as Goal;
const LOAD = { quantity: 'load_factor', at: 'peak', at_most: 6, tolerance: 0.01 } as unknown as Goal;
const SPEED = { quantity: 'speed', equals: 100 } as unknown as Goal;
const END = { termination: ['surface_impact'] } as unknown as Goal;
const LIMIT = { quantity: 'load_factor', at: 'peak', at_most: 6 };
const asked = (more: object) => ({ ...FLIGHT, vary: [FIRST, SECOND], footprint: true, ...more }) as Case;

describe('a request', () => {
  it('has what is free, and of the goals those that are ranges or ways to end', () => {
    expect(footprintRequest(asked({ achieve: [SITE, LOAD, SPEED, END], sliders: [], output: { interval: 1 } }))).toEqual({
      ...FLIGHT,
      vary: [FIRST, SECOND],
      limits: [LIMIT, END],
    });
  });

  it('has the limits and options of the case, but none that is flown with other numbers', () => {
    const other = { ...LIMIT, with: { '/control/bank_angle/value/2': 0 } };
    const options = { resolution: 500, flights: 4000 };
    expect(footprintRequest(asked({ limits: [LIMIT, other], footprint: options }))).toMatchObject({
      limits: [LIMIT],
      resolution: 500,
      search: { flights: 4000 },
    });
  });

  it('is none where it is off, where nothing is free, or too much', () => {
    expect(footprintRequest(asked({ footprint: false }))).toBeNull();
    expect(footprintRequest(asked({ vary: undefined }))).toBeNull();
    const many = asked({ vary: Array.from({ length: 9 }, () => SECOND) });
    expect(footprintRequest(many)).toBeNull();
    expect(whyNoFootprint(many)).toBe('At most 8 numbers may be free for a footprint.');
    expect(whyNoFootprint(asked({}))).toBeNull();
  });

  it('is coarse while the case moves, and never finer than it is at rest', () => {
    const request = footprintRequest(asked({ footprint: { flights: 900 } })) as NonNullable<ReturnType<typeof footprintRequest>>;
    expect(coarse(request, undefined)).toEqual({ ...request, search: { flights: 900 } });
    expect(coarse({ ...request, search: {} }, 300)).toMatchObject({ resolution: 1500, search: { flights: 1500 } });
  });

  it('depends on all but its own values of what is free, within the bounds', () => {
    const on = (tree: Case) => dependence(footprintRequest(tree) as never);
    const tree = asked({});
    const schedule = (value: number) => ({ bank_angle: { ...(FLIGHT.control?.bank_angle as object), value: [40, 40, value] } });
    expect(on(asked({ control: schedule(30) }))).toBe(on(tree));
    expect(on(asked({ control: schedule(95) }))).not.toBe(on(tree));
    expect(on(asked({ density_factor: 1.1 }))).not.toBe(on(tree));
  });

  it('has a sibling without limits, where it has limits', () => {
    const request = footprintRequest(asked({ achieve: [LOAD] }));
    expect(withoutLimits(request as never)).toEqual(footprintRequest(asked({})));
    expect(withoutLimits(footprintRequest(asked({})) as never)).toBeNull();
  });
});

it('the numbers of a landing are taken with those that are coupled', () => {
  const half = { ...FIRST, also: [{ pointer: '/control/bank_angle/value/1', factor: 0.5 }] };
  const next = withValues(asked({ vary: [half, SECOND] }), [-60, 12]);
  expect(next.control).toEqual({ bank_angle: { type: 'schedule', against: 'time', at: [0, 250, 260], value: [-60, -30, 12] } });
  const list = withValues(asked({ vary: [{ pointer: '/control/bank_angle/value', between: [-90, 90] }] }), [1, 2, 3]);
  expect(list.control).toMatchObject({ bank_angle: { value: [1, 2, 3] } });
});

describe('a case', () => {
  it('has the switch in its link, and flies without it', async () => {
    const tree = asked({ achieve: [LOAD], footprint: { resolution: 500 } });
    expect(adopted((await fromFragment(await toFragment(tree))) as Case)).toEqual(tree);
    expect(alone(tree)).toEqual(FLIGHT);
    expect(whyNoCase({ ...tree, footprint: [] })).toBe('/footprint must be a single value, got an array');
  });

  it('of /footprint opens with it on, and of a corridor or a target as before', () => {
    const { footprint: _, ...request } = asked({ limits: [LIMIT] });
    const of = (tree: object) => adopted(tree as Case).footprint;
    expect(of(request)).toBe(true);
    expect(of({ ...FLIGHT, vary: [FIRST], resolution: 500 })).toEqual({ resolution: 500 });
    expect(adopted({ ...request, resolution: 500, search: { flights: 9 } } as Case)).toEqual({
      ...request,
      footprint: { resolution: 500, flights: 9 },
    });
    expect(of({ ...request, achieve: [LOAD], search: { flights: 9 } })).toBeUndefined();
    expect(of({ ...FLIGHT, vary: [FIRST] })).toBeUndefined();
    const corridor = adopted({ ...request, vary: SECOND } as unknown as Case);
    expect(corridor).toEqual({ ...request, vary: [SECOND], footprint: false });
    expect(adopted(corridor)).toEqual(corridor);
    expect(of({ ...request, limits: [{ ...LIMIT, with: {} }] })).toBe(false);
  });

  it('stays off once it is switched off', () => {
    const off = switched(asked({ limits: [LIMIT] }), false);
    expect(adopted(off)).toEqual(off);
    expect(off.footprint).toBe(false);
    expect(switched(asked({}), false).footprint).toBeUndefined();
    expect(switched(off, true).footprint).toBe(true);
  });
});

/** A square around a place, as GeoJSON has it. */
const square = (longitude: number, latitude: number, half: number) =>
  [
    [-half, -half],
    [half, -half],
    [half, half],
    [-half, half],
    [-half, -half],
  ].map(([east, north]) => [longitude + (east as number), latitude + (north as number)]);
const boundary = (...coordinates: number[][][][]) => ({ type: 'MultiPolygon', coordinates }) as Footprint['boundary'];
const place = (longitude: number, latitude: number) => ({ longitude, geodetic_latitude: latitude });

describe('the ground of a boundary', () => {
  it('is within its rings and not in its holes', () => {
    const ring = boundary([square(20, 10, 5), square(20, 10, 1).reverse()]);
    const inside = place(23, 10);
    expect(within(ring, [inside, place(20, 10), place(30, 10), place(-160, -10)])).toEqual([inside]);
    expect(within(boundary(), [inside])).toEqual([]);
    expect((groundOf(ring) as { coordinates: unknown[][] }).coordinates[0]).toHaveLength(2);
  });

  it('has no edge where it is cut at the antimeridian', () => {
    const west = [
      [175, -5],
      [180, -5],
      [180, 5],
      [175, 5],
      [175, -5],
    ];
    expect(edgesOf(boundary([west]))).toEqual([
      [
        [175, -5],
        [180, -5],
      ],
      [
        [180, 5],
        [175, 5],
        [175, -5],
      ],
    ]);
    expect(edgesOf(boundary([square(0, 0, 1)]))).toEqual([square(0, 0, 1)]);
  });
});

describe('the sentence', () => {
  const said = (answer: object, more: object = {}, isCoarse = false) =>
    footprintInWords({
      asked: asked(more),
      answer: {
        area: 1.96345e11,
        pieces: 1,
        boundary: boundary([square(0, 0, 1)]),
        curve: null,
        points: { longitude: [0] },
        classes: [],
        complete: true,
        error: 120,
        ...answer,
      } as unknown as Footprint,
      isCoarse,
    });

  it('says how large the ground is, and how well it is known', () => {
    expect(said({})).toBe('196,000 km², complete');
    expect(said({ pieces: 2, complete: false })).toBe('196,000 km² in 2 pieces, not complete, the boundary may be off by 120 m');
    expect(said({}, {}, true)).toBe('196,000 km², coarse outline');
    const line = { coordinates: [[[0, 0]]] };
    expect(said({ curve: line, boundary: boundary() })).toBe('a curve, complete');
    expect(said({ complete: false, error: null })).toBe('196,000 km², not complete');
    expect(said({ curve: line, area: 5e6 })).toBe('a curve that encloses 5 km², complete');
  });

  it('says why there is none', () => {
    const none = { boundary: boundary() };
    expect(said({ ...none, points: { longitude: [] }, classes: ['time_limit'] })).toBe('no flight lands, they run into the time limit');
    expect(said(none, { achieve: [LOAD] })).toBe('no flight that lands keeps the limits');
    expect(said(none)).toBe('all flights land in one place');
    expect(said({ ...none, complete: false })).toBe('no boundary found before flights or time ran out');
  });
});
