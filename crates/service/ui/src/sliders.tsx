import { useRef, useState } from 'preact/hooks';
import { legible, pointer, set, turned } from './case';
import { number } from './figures';
import type { CaseNumber } from './numbers';
import { freeNumber, numbersWithSlider, rangeOf, shownValue } from './roles';
import { angleUnit, caseUnit, draft } from './store';
import { allowed } from './target/solve';

const STEPS = 1000;

/** The range of a slider, which has the value in it even where that is none that could be flown. */
function rangeAround(slider: CaseNumber, value: number): [number, number] {
  const ends = [value, ...slider.range(value)];
  return [Math.min(...ends), Math.max(...ends)];
}

/** Sliders: the flight changes while they move. */
export function Sliders() {
  return (
    <fieldset class="sliders">
      <legend>Sliders</legend>
      {numbersWithSlider(draft.value).map((slider) => (
        <SliderLine key={slider.path.join('/')} slider={slider} />
      ))}
    </fieldset>
  );
}

function SliderLine({ slider }: { slider: CaseNumber }) {
  // Of an angle in degrees, in which its ends are.
  const value = shownValue(draft.value, slider);
  const isInRadians = slider.isAngle && angleUnit.value === 'rad';
  const text = isInRadians ? `${number((value * Math.PI) / 180, 6)} rad` : `${number(value, 6)} ${slider.unit}`;
  const isMoving = useRef(false);
  const [around, setAround] = useState(() => rangeAround(slider, value));
  const free = freeNumber(draft.value, pointer(slider.path));
  const range = (free && rangeOf(draft.value, free)) ?? around;
  const isOutside = value < range[0] - 1e-9 || value > range[1] + 1e-9;
  const [low, high] = isOutside && !isMoving.current ? rangeAround(slider, value) : range;
  if (isOutside && !isMoving.current && range === around) setAround([low, high]);
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
      {free && <Allowed slider={slider} low={low} high={high} />}
    </div>
  );
}

/** The part of a slider with which the limits are kept; nothing where there is no corridor of its number. */
function Allowed({ slider, low, high }: { slider: CaseNumber; low: number; high: number }) {
  const corridor = allowed.value;
  if (!corridor || corridor.pointer !== pointer(slider.path) || high <= low) return null;
  const own = (value: number) => (slider.isAngle ? (legible(value, caseUnit.value, 'deg') as number) : value);
  const share = (value: number) => (100 * (Math.min(Math.max(own(value), low), high) - low)) / (high - low);
  return (
    <div
      class="band"
      role="img"
      aria-label={`${slider.label}: ${corridor.bands.length} allowed ${corridor.bands.length === 1 ? 'range' : 'ranges'}`}
    >
      {corridor.bands.map(({ from, to }) => (
        <span key={from} style={{ left: `${share(from)}%`, width: `${share(to) - share(from)}%` }} />
      ))}
    </div>
  );
}
