import type { Range } from '../protocol/types';
import { preferences, type ArmMode } from '../state/preferences';
import { use_app } from '../ui/app';
import { degree } from '../ui/format';
import { changed, command_of, mode_names, modes_of, reach_of, slots_of, span_of, start_tangent, values_of, type Shape } from './arm_model';
import { use_draft } from './draft';
import { Slider } from './Slider';
import { pull, tendon_reach } from './tendons';
import { TipPanel } from './TipPanel';

export function ArmPanel() {
  const { viewer } = use_app();
  const draft = use_draft<Shape>();
  viewer.tick.value;
  const hello = viewer.hello.value;
  const scene = viewer.scene.value;
  const state = viewer.shown;
  if (!hello || !scene || !state) return <p class="empty">The arm’s state has not come yet.</p>;
  const { kind } = scene.arm;
  const { controls } = hello;
  const modes = modes_of(kind, controls);
  const mode = modes.find((each) => each === preferences.arm_mode.value) ?? modes[0];
  const start = start_tangent(scene.arm.base);
  const actual = values_of(mode, kind, state, start);
  const values = draft.value?.values.length === actual.length ? draft.value.values : actual;
  const stretches = draft.value?.stretches ?? Array.from(state.stretches);
  const { still } = viewer;
  const bends = draft.value?.bends ?? Array.from(state.bends);
  const stretchable = controls.sections.some(({ stretch }) => stretch[1] > stretch[0]);

  const send = (shape: Shape): void => {
    draft.set(shape);
    viewer.commander.arm(command_of(mode, kind, shape.values, stretchable ? shape.stretches : null));
  };
  const reach = (i: number): Range => mode === 'tendons'
    ? tendon_reach(kind, controls, { displacements: values, bends }, i)
    : reach_of(mode, kind, controls, values, i, start);
  const change = (i: number, value: number): void => {
    if (mode !== 'tendons') return send({ values: changed(mode, kind, controls, values, i, value, start), stretches, bends });
    const pulled = pull(kind, controls, { displacements: values, bends }, i, value);
    send({ values: pulled.displacements, bends: pulled.bends, stretches });
  };
  const slots = slots_of(mode, kind, controls);
  // One slider a section needs no heading of its own.
  const plain = kind === 'planar' && mode !== 'tendons' && !stretchable;
  const set_mode = (next: ArmMode): void => {
    draft.set({ values: [], stretches, bends: Array.from(state.bends) });
    preferences.arm_mode.value = next;
  };
  return (
    <>
      {modes.length > 1 && (
        <div class="segmented" role="group" aria-label="The arm’s shape in">
          {modes.map((each) => (
            <button key={each} type="button" aria-pressed={each === mode} onClick={() => set_mode(each)}>{mode_names[each]}</button>
          ))}
        </div>
      )}
      {controls.sections.map((control, section) => (
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
              change={(value) => send({ values, bends, stretches: stretches.map((f, j) => (j === section ? value : f)) })}
            />
          )}
        </fieldset>
      ))}
      <TipPanel />
    </>
  );
}

function wider([low, high]: Range): Range {
  const margin = 0.06 * (high - low);
  return [low - margin, high + margin];
}
