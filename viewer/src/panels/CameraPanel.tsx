import type { Range } from '../protocol/types';
import { camera_commanded, camera_pan, camera_stride } from '../protocol/state';
import { preferences } from '../state/preferences';
import { edit_experiment, use_app } from '../ui/app';
import { Icon } from '../ui/Icon';
import { degree, fixed } from '../ui/format';
import { use_draft } from './draft';
import { Slider } from './Slider';

/** Pan, tilt, zoom and stage of each camera that has these axes. */
export function CameraPanel() {
  const app = use_app();
  const { viewer } = app;
  const hello = viewer.hello.value;
  const scene = viewer.scene.value;
  if (!hello || !scene) return <p class="empty">No data received yet.</p>;
  const { heads, stages } = hello.controls;
  if (!heads.length && !stages.length) return <p class="empty">This rig has no camera that can be moved.</p>;
  return (
    <>
      <label class="check" title="Shows the true axis positions of the simulated cameras. They differ from the commanded ones by [truth], backlash and motor steps; tasks cannot use them.">
        <input type="checkbox" checked={preferences.true_axes.value}
          onChange={(event) => (preferences.true_axes.value = event.currentTarget.checked)} />
        Show where they truly stand
      </label>
      {scene.cameras.map(({ name }, index) => {
        const head = heads.find(({ camera }) => camera === name);
        const stage = stages.find(({ camera }) => camera === name);
        if (!head && !stage) return null;
        const at = index * camera_stride;
        return (
          <fieldset key={name} class="section">
            <legend>Camera “{name}”</legend>
            {head && (
              <>
                <Axis what="head" camera={name} axis="pan" row={at} place={0} range={head.pan} scale={degree} unit="°" />
                <Axis what="head" camera={name} axis="tilt" row={at} place={1} range={head.tilt} scale={degree} unit="°" />
                <Axis what="head" camera={name} axis="zoom" row={at} place={2} range={head.zoom} scale={1}
                  unit={head.zoom_unit === 'count' ? 'counts' : '×'} />
              </>
            )}
            {stage && (['x', 'y', 'z'] as const).map((axis, i) => (
              <Axis key={axis} what="stage" camera={name} axis={axis} row={at} place={3 + i} range={stage[axis]} scale={1000} unit="mm" />
            ))}
            <button type="button" class="button save-shown" title={`Adds the view of ${name} as its start to the text of the experiment, to be saved as a new file`}
              aria-label={`Save the view of ${name}`} disabled={viewer.link.status.value.kind !== 'open'}
              onClick={() => edit_experiment(app, { add: 'view', camera: name })}><Icon name="save" />Save view</button>
          </fieldset>
        );
      })}
    </>
  );
}

interface AxisProps {
  what: 'head' | 'stage';
  camera: string;
  axis: string;
  /** Where the camera's row in the state begins. */
  row: number;
  /** Which of its axes: pan, tilt, zoom, stage x, y, z. */
  place: number;
  range: Range;
  scale: number;
  unit: string;
}

function Axis({ what, camera, axis, row, place, range, scale, unit }: AxisProps) {
  const { viewer } = use_app();
  const draft = use_draft<number>();
  viewer.tick.value;
  // What is commanded: where it truly stands nobody knows who has its readings alone.
  const commanded = viewer.shown?.cameras[row + camera_commanded + place] ?? range[0];
  const truth = viewer.shown?.cameras[row + camera_pan + place] ?? commanded;
  const is_true_shown = preferences.true_axes.value;
  const places = unit === '×' ? 2 : Number(unit !== 'counts');
  // An axis without a way to go is no control.
  if (!(range[1] > range[0])) return null;
  return (
    <>
      <Slider
        id={`${what}-${camera}-${axis}`}
        label={what === 'stage' ? `stage ${axis}` : axis}
        title={`Camera ${camera}, ${what === 'stage' ? `stage ${axis}` : axis}`}
        value={draft.value ?? commanded}
        actual={is_true_shown ? truth : undefined}
        span={range}
        reach={range}
        scale={scale}
        unit={unit}
        places={places}
        disabled={viewer.still}
        change={(value) => {
          draft.set(value);
          viewer.commander.axis(what, camera, { [axis]: value });
        }}
      />
      {is_true_shown && <p class="truth">truly {fixed(truth * scale, places + 1)} {unit}</p>}
    </>
  );
}
