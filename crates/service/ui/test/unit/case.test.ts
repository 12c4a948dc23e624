import { describe, expect, it } from 'vitest';
import type { Case } from '../../src/api';
import { get, inUnit, legible, pointer, set, tidied, turned, typed } from '../../src/case';
import { type Field, type Fields, SECTIONS } from '../../src/form/fields';
import { parsed, written } from '../../src/form/inputs';

describe('a path', () => {
  it('is the pointer of RFC 6901', () => {
    expect(pointer(['vehicle', 'a/b~c', 3])).toBe('/vehicle/a~1b~0c/3');
  });

  it('reads and writes without a change to what was', () => {
    const tree = { vehicle: { mass: 1 }, events: [{ name: 'a' }, { name: 'b' }] };
    const changed = set(set(tree, ['vehicle', 'mass'], 2), ['control', 'bank_angle'], 5);
    expect(changed).toEqual({ vehicle: { mass: 2 }, events: tree.events, control: { bank_angle: 5 } });
    expect(tree.vehicle.mass).toBe(1);
    expect(changed.events).toBe(tree.events);
    expect(get(changed, ['events', 1, 'name'])).toBe('b');
    expect(get(changed, ['events', 7, 'name'])).toBeUndefined();
  });

  it('takes away fields and elements', () => {
    expect(set({ a: { b: 1, c: 2 } }, ['a', 'b'], undefined)).toEqual({ a: { c: 2 } });
    expect(set({ list: [1, 2, 3] }, ['list', 1], undefined)).toEqual({ list: [1, 3] });
  });

  it('has a part that is called as what objects have by nature only where that is written', () => {
    for (const name of ['__proto__', 'constructor', 'toString']) {
      expect(get({ a: {} }, ['a', name])).toBeUndefined();
      const changed = set({ a: {} }, ['a', name, 'mass'], 5);
      expect(Object.keys(changed.a)).toEqual([name]);
      expect(get(changed, ['a', name, 'mass'])).toBe(5);
      expect(set(changed, ['a', name], undefined)).toEqual({ a: {} });
    }
    expect(get([1], ['at'])).toBeUndefined();
    expect(get('text', ['length'])).toBeUndefined();
    expect('mass' in {}).toBe(false);
  });

  it('makes lists where a place in one is written', () => {
    expect(set({}, ['stop', 'when', 0, 'quantity'], 'mach')).toEqual({ stop: { when: [{ quantity: 'mach' }] } });
  });
});

describe('what is typed', () => {
  it.each([
    ['7500', 7500],
    [' -1.5e3 ', -1500],
    ['', undefined],
    ['  ', undefined],
    ['7,5', '7,5'],
    ['12 kg', '12 kg'],
    ['1e999', '1e999'],
    ['NaN', 'NaN'],
    ['Infinity', 'Infinity'],
    ['0x10', '0x10'],
    ['-', '-'],
  ])('%j is %j', (text, value) => {
    expect(typed(text)).toBe(value);
  });

  it('as rows comes from spreadsheets, and goes back', () => {
    expect(parsed('0\t1.2\n10 000; x\n\n')).toEqual([
      [0, 1.2],
      [10, 0, 'x'],
    ]);
    expect(parsed(written([[1, 2.5], [3]]))).toEqual([[1, 2.5], [3]]);
  });
});

describe('angles in another unit', () => {
  const tree = {
    angle_unit: 'deg',
    vehicle: {
      mass: 30,
      aerodynamics: { type: 'alpha_mach_table', angle_of_attack: [0, 30], mach: [30], lift_coefficient: [[30]], drag_coefficient: [[30]] },
    },
    control: { bank_angle: { type: 'schedule', against: 'speed', at: [30], value: [30] }, angle_of_attack: 30 },
    initial_state: {
      type: 'geodetic',
      longitude: 30,
      geodetic_latitude: -30,
      geodetic_altitude: 30,
      speed: 30,
      flight_path_angle: -30,
      azimuth: 180,
    },
    stop: {
      altitude: 30,
      when: [
        { quantity: 'flight_path_angle', falls_through: -30 },
        { quantity: 'load_factor', rises_through: 30 },
      ],
    },
  } as unknown as Case;

  it('are all angles, and nothing else', () => {
    const sixth = (30 * Math.PI) / 180;
    expect(inUnit(tree, 'rad')).toEqual({
      angle_unit: 'rad',
      vehicle: { mass: 30, aerodynamics: { ...tree.vehicle.aerodynamics, angle_of_attack: [0, sixth] } },
      control: { bank_angle: { type: 'schedule', against: 'speed', at: [30], value: [sixth] }, angle_of_attack: sixth },
      initial_state: {
        type: 'geodetic',
        longitude: sixth,
        geodetic_latitude: -sixth,
        geodetic_altitude: 30,
        speed: 30,
        flight_path_angle: -sixth,
        azimuth: Math.PI,
      },
      stop: {
        altitude: 30,
        when: [
          { quantity: 'flight_path_angle', falls_through: -sixth },
          { quantity: 'load_factor', rises_through: 30 },
        ],
      },
    });
  });

  it('are the fields that the form shows as angles, and no others', () => {
    const found: [string, boolean][] = [];
    const walk = (fields: Fields) => {
      for (const [name, field] of Object.entries(fields)) visit(name, field);
    };
    const visit = (name: string, field: Field) => {
      if (field.kind === 'group') walk(field.fields);
      else if (field.kind === 'variant') for (const kind of Object.values(field.kinds)) walk(kind.fields);
      else if (field.kind === 'list') visit(name, field.item);
      else if (field.kind === 'command') found.push([name, true]);
      else if (['number', 'numbers', 'column'].includes(field.kind)) found.push([name, 'isAngle' in field && field.isAngle === true]);
    };
    walk(SECTIONS);
    expect(found.length).toBeGreaterThan(50);
    const turned = (name: string) =>
      JSON.stringify(inUnit({ angle_unit: 'deg', part: { [name]: 180 } } as unknown as Case, 'rad')).includes('3.14');
    expect(found.filter(([name, isAngle]) => turned(name) !== isAngle)).toEqual([]);
  });

  it('come back to what they were', () => {
    expect(inUnit(inUnit(tree, 'rad'), 'deg')).toEqual(tree);
  });

  it('are radians where the case does not say', () => {
    const { angle_unit: _, ...silent } = tree;
    expect(inUnit(silent as Case, 'rad')).toBe(silent);
  });
});

describe('an angle in the other unit', () => {
  it.each([60, -1.5, 0.1, 89.999, 304, -180, 1e-7, 22.64, 1 / 3])(
    'of %d degrees comes back as it was typed, through radians',
    (degrees) => {
      const radians = turned(degrees, 'deg', 'rad');
      expect(radians).toBeCloseTo((degrees * Math.PI) / 180, 15);
      expect(legible(radians, 'rad', 'deg')).toBe(Number(degrees.toPrecision(14)));
    },
  );

  it('is itself in its own unit, and a text stays a text', () => {
    expect(legible(1 / 3, 'deg', 'deg')).toBe(1 / 3);
    expect(turned('twelve', 'deg', 'rad')).toBe('twelve');
    expect(legible(undefined, 'deg', 'rad')).toBeUndefined();
  });
});

it('a tidied case has no optional part in which nothing is left', () => {
  const tree = { vehicle: {}, initial_state: {}, stop: {}, control: {}, events: [], heating: {}, name: 'x' } as unknown as Case;
  expect(tidied(tree)).toEqual({ vehicle: {}, initial_state: {}, heating: {}, name: 'x' });
});
