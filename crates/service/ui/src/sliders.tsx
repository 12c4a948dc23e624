import { useRef, useState } from 'preact/hooks';
import type { Case } from './api';
import { get, legible, type Path, set, turned } from './case';
import { number } from './figures';
import { angleUnit, caseUnit, draft } from './store';

interface Slider {
  label: string;
  path: Path;
  unit: string;
  isAngle?: true;
  /** Where it begins and ends, of a value in its unit; of an angle in degrees. */
  range(value: number): [number, number];
  /** What holds where the case does not say. */
  without?: number;
}

const around = (share: number) => (value: number) => [value * (1 - share), value * (1 + share)] as [number, number];

/** The numbers that matter, of whichever the case has. */
const SLIDERS: Slider[] = [
  ...['flight_path_angle', 'inertial_flight_path_angle'].map(
    (name): Slider => ({
      label: 'Flight-path angle',
      path: ['initial_state', name],
      unit: '°',
      isAngle: true,
      range: (value) => [Math.max(value - 5, -90), Math.min(value + 5, 90)],
    }),
  ),
  ...['speed', 'inertial_speed'].map(
    (name): Slider => ({ label: 'Speed', path: ['initial_state', name], unit: 'm/s', range: around(0.25) }),
  ),
  { label: 'Eccentricity', path: ['initial_state', 'eccentricity'], unit: '', range: (value) => [Math.max(value - 0.02, 0), value + 0.02] },
  { label: 'Bank angle', path: ['control', 'bank_angle'], unit: '°', isAngle: true, range: () => [-180, 180], without: 0 },
  { label: 'Mass', path: ['vehicle', 'mass'], unit: 'kg', range: (value) => [value / 2, value * 2] },
  { label: 'Air density', path: ['density_factor'], unit: '×', range: () => [0.5, 1.5], without: 1 },
];

const LAUNCH_AZIMUTH: Slider = {
  label: 'Launch azimuth',
  path: ['initial_state', 'azimuth'],
  unit: '°',
  isAngle: true,
  range: (value) => [value - 45, value + 45],
  without: 0,
};

/** The sliders that a case may have: of a launch its azimuth, and the angle of its first tilt, by which it begins to turn. */
function slidersOf({ initial_state, events }: Case): Slider[] {
  if (initial_state?.type !== 'launch') return SLIDERS;
  const tilt = Array.isArray(events) ? events.findIndex((event) => get(event, ['then', 'tilt', 'angle']) !== undefined) : -1;
  const tilts: Slider = {
    label: 'Tilt',
    path: ['events', tilt, 'then', 'tilt', 'angle'],
    unit: '°',
    isAngle: true,
    range: (value) => [Math.max(value - 3, 0), value + 3],
  };
  return [LAUNCH_AZIMUTH, ...(tilt < 0 ? [] : [tilts]), ...SLIDERS];
}

const STEPS = 1000;

/** The range of a slider, which has the value in it even where that is none that could be flown. */
function rangeOf(slider: Slider, value: number): [number, number] {
  const ends = [value, ...slider.range(value)];
  return [Math.min(...ends), Math.max(...ends)];
}

/** Sliders: the flight changes while they move. */
export function Sliders() {
  const shown = slidersOf(draft.value).filter((slider) => typeof (get(draft.value, slider.path) ?? slider.without) === 'number');
  return (
    <fieldset class="sliders">
      <legend>Sliders</legend>
      {shown.map((slider) => (
        <SliderLine key={slider.path.join('/')} slider={slider} />
      ))}
    </fieldset>
  );
}

function SliderLine({ slider }: { slider: Slider }) {
  const own = (get(draft.value, slider.path) as number | undefined) ?? slider.without ?? 0;
  // Of an angle in degrees, in which its ends are.
  const value = slider.isAngle ? (legible(own, caseUnit.value, 'deg') as number) : own;
  const isInRadians = slider.isAngle && angleUnit.value === 'rad';
  const text = isInRadians ? `${number((value * Math.PI) / 180, 6)} rad` : `${number(value, 6)} ${slider.unit}`;
  const isMoving = useRef(false);
  const [range, setRange] = useState(() => rangeOf(slider, value));
  const isOutside = value < range[0] - 1e-9 || value > range[1] + 1e-9;
  const [low, high] = isOutside && !isMoving.current ? rangeOf(slider, value) : range;
  if (isOutside && !isMoving.current) setRange([low, high]);
  const step = (high - low) / STEPS;
  const id = `slider-${slider.path.join('-')}`;
  return (
    <div class="slider">
      <label for={id}>{slider.label}</label>
      <output for={id}>{text}</output>
      <input
        id={id}
        type="range"
        min={0}
        max={STEPS}
        step={1}
        value={high > low ? Math.round((value - low) / step) : 0}
        aria-valuetext={text}
        onPointerDown={() => {
          isMoving.current = true;
        }}
        onPointerUp={() => {
          isMoving.current = false;
        }}
        onInput={(event) => {
          const next = Number((low + Number(event.currentTarget.value) * step).toPrecision(5));
          draft.value = set(draft.peek(), slider.path, slider.isAngle ? turned(next, 'deg', caseUnit.peek()) : next);
        }}
      />
    </div>
  );
}
