import type { ActuatorControl, Range } from '../protocol/types';
import { preferences } from '../state/preferences';
import { use_app } from '../ui/app';
import { actuators_of, force_scale, force_text, moved, type ActuatorState } from './actuators';
import { use_draft } from './draft';
import { Slider } from './Slider';

/** A slider and the tension for each tendon. */
export function ActuatorPanel({ actuators }: { actuators: ActuatorControl[] }) {
  const { viewer } = use_app();
  const draft = use_draft<number[]>();
  viewer.tick.value;
  const state = viewer.shown;
  const shown = state ? actuators_of(state) : [];
  if (shown.length !== actuators.length) return <p class="empty">Waiting for the tendon tensions.</p>;
  const { still } = viewer;
  const together = preferences.tendons_together.value;
  const scale = force_scale(shown.map(({ force }) => force));
  const change = (i: number, value: number): void => {
    const now = draft.value ?? actuators_of(viewer.newest ?? state!).map((each) => each.value);
    const tendons = moved(actuators, now, i, value, together);
    draft.set(tendons);
    viewer.commander.arm({ tendons });
  };
  const sections = [...new Set(actuators.map(({ section }) => section))].sort((a, b) => a - b);
  return (
    <>
      <label class="check" title="If on, tendons that bend the same section move together with the moved tendon, so that none pulls against it. If off, each tendon moves alone.">
        <input type="checkbox" checked={together} disabled={still}
          onChange={(event) => (preferences.tendons_together.value = event.currentTarget.checked)} />
        The other tendons follow
      </label>
      {sections.map((section) => (
        <fieldset key={section} class="section">
          <legend>To the end of section {section + 1}</legend>
          {actuators.map(({ name, range, section: own }, i) => own === section && (
            <div key={i} class="actuator">
              <Slider
                id={`actuator-${i}`} label={name} title={`${name}, pulled in`}
                value={draft.value?.[i] ?? shown[i].value} actual={shown[i].value}
                span={wider(range)} reach={range} scale={1000} unit="mm" places={2} disabled={still}
                change={(value) => change(i, value)}
              />
              <Pull name={name} state={shown[i]} scale={scale} />
            </div>
          ))}
        </fieldset>
      ))}
    </>
  );
}

/** A tendon's tension as a bar that ends at `scale`, N. */
function Pull({ name, state: { force, slack, lost }, scale }: { name: string; state: ActuatorState; scale: number }) {
  const text = slack ? 'slack' : force_text(force);
  return (
    <div class="pull" data-slack={slack} title={`${name}: ${slack ? 'hangs slack' : `pulls by ${text}; the bar ends at ${scale} N`}`}>
      <span class="lost" title="The motor of this tendon was overloaded and lost microsteps, which its controller did not notice">
        {lost > 0 && <>lost {Math.round(lost)}<span class="sr"> microsteps</span></>}
      </span>
      <span class="bar" aria-hidden="true"><span style={{ width: `${Math.min(100, (100 * force) / scale)}%` }} /></span>
      <span class="force">{text}</span>
    </div>
  );
}

function wider([low, high]: Range): Range {
  const margin = 0.06 * (high - low);
  return [low - margin, high + margin];
}
