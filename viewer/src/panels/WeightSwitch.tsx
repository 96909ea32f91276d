import { flag_weightless } from '../protocol/state';
import { use_app } from '../ui/app';

/** Switch for weight and loads of the simulated arm. */
export function WeightSwitch() {
  const { viewer } = use_app();
  const off = (viewer.flags.value & flag_weightless) !== 0;
  return (
    <div class="weight">
      <label class="check" title="Switches weight and loads of the simulated arm on or off. Reset and runs of tasks switch them on.">
        <input type="checkbox" role="switch" id="weight" checked={!off} disabled={viewer.still}
          onChange={(event) => {
            const box = event.currentTarget;
            const on = box.checked;
            // The box shows the rig's state, not the click.
            box.checked = !off;
            void viewer.commander.weight(on);
          }} />
        Apply weight and loads
      </label>
      {off && <p role="status">Weight and loads are off until Reset; runs of tasks always include them.</p>}
    </div>
  );
}
