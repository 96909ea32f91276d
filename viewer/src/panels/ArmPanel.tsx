import type { State } from '../protocol/state';
import type { Range } from '../protocol/types';
import { preferences, type ArmMode } from '../state/preferences';
import { edit_experiment, use_app } from '../ui/app';
import { Icon } from '../ui/Icon';
import { ActuatorPanel } from './ActuatorPanel';
import { degree } from '../ui/format';
import { changed, command_of, mode_names, modes_of, reach_of, slots_of, span_of, start_tangent, values_of, type Shape } from './arm_model';
import { use_draft } from './draft';
import { Slider } from './Slider';
import { pull, tendon_reach } from './tendons';
import { TipPanel } from './TipPanel';
import { WeightSwitch } from './WeightSwitch';

export function ArmPanel() {
  const app = use_app();
  const { viewer } = app;
  const draft = use_draft<Shape>();
  viewer.tick.value;
  const hello = viewer.hello.value;
  const scene = viewer.scene.value;
  const state = viewer.shown;
  if (!hello || !scene || !state) return <p class="empty">No data received yet.</p>;
  const { kind } = scene.arm;
  const { controls } = hello;
  const modes = modes_of(kind, controls);
  const mode = modes.find((each) => each === preferences.arm_mode.value) ?? modes[0];
  const start = start_tangent(scene.arm.base);
  const actual = values_of(mode, kind, state, start);
  const shape_in = (from: State): Shape => ({
    values: draft.value?.values.length === actual.length ? draft.value.values : values_of(mode, kind, from, start),
    stretches: draft.value?.stretches ?? Array.from(from.stretches),
    bends: draft.value?.bends ?? Array.from(from.bends),
  });
  const { values, stretches, bends } = shape_in(state);
  const { still } = viewer;
  const stretchable = controls.sections.some(({ stretch }) => stretch[1] > stretch[0]);

  const send = (shape: Shape): void => {
    draft.set(shape);
    viewer.commander.arm(command_of(mode, kind, shape.values, stretchable ? shape.stretches : null));
  };
  const reach = (i: number): Range => mode === 'tendons'
    ? tendon_reach(kind, controls, { displacements: values, bends }, i)
    : reach_of(mode, kind, controls, values, i, start);
  // Unchanged values are taken from the current state, not from a held earlier one.
  const now = (): Shape => shape_in(viewer.newest ?? state);
  const change = (i: number, value: number): void => {
    const from = now();
    if (mode !== 'tendons') return send({ ...from, values: changed(mode, kind, controls, from.values, i, value, start) });
    const pulled = pull(kind, controls, { displacements: from.values, bends: from.bends }, i, value);
    send({ ...from, values: pulled.displacements, bends: pulled.bends });
  };
  const stretch = (section: number, value: number): void => {
    const from = now();
    send({ ...from, stretches: from.stretches.map((f, j) => (j === section ? value : f)) });
  };
  const slots = slots_of(mode, kind, controls);
  // With one slider per section, no headings are needed.
  const plain = kind === 'planar' && mode !== 'tendons' && !stretchable;
  const set_mode = (next: ArmMode): void => {
    draft.set({ values: [], stretches: now().stretches, bends: Array.from((viewer.newest ?? state).bends) });
    preferences.arm_mode.value = next;
  };
  return (
    <>
      {modes.length > 1 && (
        <div class="segmented" role="group" aria-label="The arm’s shape in">
          {modes.map((each) => (
            <button key={each} type="button" title={`The arm’s shape in ${mode_names[each].toLowerCase()}`} aria-pressed={each === mode} onClick={() => set_mode(each)}>{mode_names[each]}</button>
          ))}
        </div>
      )}
      {controls.weight && <WeightSwitch />}
      {mode === 'tendons' && controls.actuators && <ActuatorPanel actuators={controls.actuators} />}
      {!(mode === 'tendons' && controls.actuators) && controls.sections.map((control, section) => (
        <fieldset key={section} class="section" data-plain={plain}>
          <legend class={plain ? 'sr' : ''}>Section {section + 1}</legend>
          {slots.map((slot, i) => slot.section === section && (
            <Slider
              key={`${mode} ${i}`}
              id={`arm-${mode}-${i}`}
              label={plain ? `Section ${section + 1}` : slot.label}
              title={`Section ${section + 1}, ${slot.label}`}
              value={values[i]}
              actual={actual[i]}
              span={span_of(mode, kind, controls, i, values[i], start)}
              reach={reach(i)}
              scale={slot.unit === 'deg' ? degree : 1000}
              unit={slot.unit === 'deg' ? '°' : 'mm'}
              places={1}
              disabled={still}
              change={(value) => change(i, value)}
            />
          ))}
          {mode !== 'tendons' && control.stretch[1] > control.stretch[0] && (
            <Slider
              id={`arm-stretch-${section}`} label="stretch" title={`Section ${section + 1}, stretch`}
              value={stretches[section]} actual={state.stretches[section]}
              span={wider(control.stretch)} reach={control.stretch} scale={100} unit="%" places={1} disabled={still}
              change={(value) => stretch(section, value)}
            />
          )}
        </fieldset>
      ))}
      <TipPanel />
      <button type="button" class="button save-shown" title="Opens the text of the experiment with an added task that moves the arm to the shown pose; you can save it as a new file"
        disabled={viewer.link.status.value.kind !== 'open'} onClick={() => edit_experiment(app, { add: 'pose' })}><Icon name="save" />Save pose as a task</button>
    </>
  );
}

function wider([low, high]: Range): Range {
  const margin = 0.06 * (high - low);
  return [low - margin, high + margin];
}
