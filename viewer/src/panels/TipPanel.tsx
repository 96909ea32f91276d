import type { Vector3 } from '../protocol/types';
import { total_length } from '../scene/rings';
import { obstruction } from '../state/commander';
import { use_app } from '../ui/app';
import { length_places } from '../ui/format';
import { NumberField } from './Slider';

/** The tip's position, to read and to type: what dragging its handle does, for those who use the keyboard. */
export function TipPanel() {
  const { viewer } = use_app();
  viewer.tick.value;
  const samples = viewer.shown?.samples;
  const scene = viewer.scene.value;
  if (!samples || !scene) return null;
  const at = samples.length - 7;
  const tip = [samples[at], samples[at + 1], samples[at + 2]] as Vector3;
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
                const next = tip.map((old, j) => (j === i ? value : old)) as Vector3;
                go(next);
              }} />
          </label>
        ))}
      </div>
      {why && <p class="bad" role="status">{why}</p>}
    </fieldset>
  );
}
