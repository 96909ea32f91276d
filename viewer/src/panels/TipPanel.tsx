import { sample_stride } from '../protocol/state';
import type { Vector3 } from '../protocol/types';
import { total_length } from '../scene/rings';
import { obstruction } from '../state/commander';
import { use_app } from '../ui/app';
import { length_places } from '../ui/format';
import { NumberField } from './Slider';

/** The tip's position: the keyboard equivalent of dragging its handle. */
export function TipPanel() {
  const { viewer } = use_app();
  viewer.tick.value;
  const samples = viewer.shown?.samples;
  const scene = viewer.scene.value;
  if (!samples || !scene) return null;
  const tip = tip_of(samples);
  const places = length_places(total_length(scene.arm));
  const { still } = viewer;
  const go = (position: Vector3): void => {
    viewer.commander.tip(position);
    viewer.commander.release_tip();
  };
  const result = viewer.commander.tip_result.value;
  const why = result && obstruction(result);
  return (
    <fieldset class="section tip">
      <legend>Tip, m</legend>
      <div class="triple">
        {(['X', 'Y', 'Z'] as const).map((axis, i) => (
          <label key={axis}>
            <span aria-hidden="true">{axis}</span>
            <NumberField label={`Tip’s ${axis}, m`} value={tip[i]} places={places} disabled={still}
              change={(value) => {
                // The other coordinates are taken from the current state, even while an earlier one is held.
                const now = tip_of(viewer.newest?.samples ?? samples);
                go(now.map((old, j) => (j === i ? value : old)) as Vector3);
              }} />
          </label>
        ))}
      </div>
      {why && <p class="bad" role="status">{why}</p>}
    </fieldset>
  );
}

function tip_of(samples: Float32Array): Vector3 {
  const at = samples.length - sample_stride + 1;
  return [samples[at], samples[at + 1], samples[at + 2]];
}
