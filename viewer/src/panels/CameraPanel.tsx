import type { Range } from '../protocol/types';
import { camera_pan, camera_stage, camera_stride, camera_tilt, camera_zoom } from '../protocol/state';
import { use_app } from '../ui/app';
import { degree } from '../ui/format';
import { use_draft } from './draft';
import { Slider } from './Slider';

/** Pan, tilt, zoom and stage of each camera that has these axes. */
export function CameraPanel() {
  const { viewer } = use_app();
  const hello = viewer.hello.value;
  const scene = viewer.scene.value;
  if (!hello || !scene) return <p class="empty">Nothing has come yet.</p>;
  const { heads, stages } = hello.controls;
  if (!heads.length && !stages.length) return <p class="empty">No camera here can be moved.</p>;
  return (
    <>
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
                <Axis what="head" camera={name} axis="pan" place={at + camera_pan} range={head.pan} scale={degree} unit="°" />
                <Axis what="head" camera={name} axis="tilt" place={at + camera_tilt} range={head.tilt} scale={degree} unit="°" />
                <Axis what="head" camera={name} axis="zoom" place={at + camera_zoom} range={head.zoom} scale={1}
                  unit={head.zoom_unit === 'count' ? 'counts' : '×'} />
              </>
            )}
            {stage && (['x', 'y', 'z'] as const).map((axis, i) => (
              <Axis key={axis} what="stage" camera={name} axis={axis} place={at + camera_stage + i} range={stage[axis]} scale={1000} unit="mm" />
            ))}
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
  /** Index of the value in a camera's row of the state. */
  place: number;
  range: Range;
  scale: number;
  unit: string;
}

function Axis({ what, camera, axis, place, range, scale, unit }: AxisProps) {
  const { viewer } = use_app();
  const draft = use_draft<number>();
  viewer.tick.value;
  const actual = viewer.shown?.cameras[place] ?? range[0];
  // An axis without travel has no control.
  if (!(range[1] > range[0])) return null;
  return (
    <Slider
      id={`${what}-${camera}-${axis}`}
      label={what === 'stage' ? `stage ${axis}` : axis}
      title={`Camera ${camera}, ${what === 'stage' ? `stage ${axis}` : axis}`}
      value={draft.value ?? actual}
      actual={actual}
      span={range}
      reach={range}
      scale={scale}
      unit={unit}
      places={unit === '×' ? 2 : Number(unit !== 'counts')}
      disabled={viewer.still}
      change={(value) => {
        draft.set(value);
        viewer.commander.axis(what, camera, { [axis]: value });
      }}
    />
  );
}
