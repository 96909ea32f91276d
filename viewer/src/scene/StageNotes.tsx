// Overlays of the 3D view: current camera, age, and values of the picked point.
import { angle, fixed, format_time, length_places, vector } from '../ui/format';
import { obstruction } from '../state/commander';
import { preferences, toggle_hidden } from '../state/preferences';
import { eye_of, eyes_of } from '../overlays/extras';
import { use_app } from '../ui/app';
import { Icon } from '../ui/Icon';
import { FloorNote } from './FloorNote';
import { Gizmo } from './Gizmo';
import { PushNote, PushTool } from './PushNotes';
import { StageLabels } from './StageLabels';
import { point_at } from '../math/arc';
import { total_length } from './rings';

export function StageNotes() {
  const { viewer, views } = use_app();
  const names = viewer.scene.value?.cameras.map(({ name }) => name) ?? [];
  return (
    <>
      <div class="view-switch" role="group" aria-label="View">
        {[null, ...names].map((name) => (
          <button key={name ?? ''} type="button" title={name ? `Through the camera ${name}` : 'From where you like: drag to turn'} aria-pressed={views.current.value === name}
            onClick={() => (views.current.value = name)}>{name ?? 'Free view'}</button>
        ))}
      </div>
      <PushTool />
      <OldLabel />
      <Clock />
      <ExtrasLegend />
      <StageLabels />
      <Gizmo />
      <TipNote />
      <PushNote />
      <div class="stage-corner">
        <FloorNote />
        <PickedPoint />
      </div>
    </>
  );
}

function OldLabel() {
  const { viewer } = use_app();
  const freshness = viewer.freshness.value;
  viewer.tick.value;
  if (freshness !== 'stale' && freshness !== 'lost') return null;
  return (
    <div class="old-label" role="status">
      {freshness === 'lost' ? 'Connection lost' : 'No new data'} — showing the state at {format_time(viewer.shown?.time ?? NaN)}
    </div>
  );
}

function Clock() {
  const { viewer } = use_app();
  viewer.tick.value;
  if (!viewer.shown) return null;
  return <div class="stage-clock" id="clock">{format_time(viewer.shown.time)}</div>;
}

/** Legend of the extras drawn by the program, each with an eye. */
function ExtrasLegend() {
  const { viewer } = use_app();
  const extras = viewer.shown_extras.value;
  if (!extras) return null;
  const hidden = preferences.hidden.value;
  return (
    <aside class="extras" aria-label={`${extras.title}: what is drawn`}>
      <header><b>{extras.title}</b> <span>{extras.text}</span></header>
      <div class="chips" role="group" aria-label="Overlays in the 3D view and on the pictures">
        {eyes_of(extras).map(({ id, label, color }) => {
          const shown = !hidden.includes(eye_of(id));
          return (
            <button key={id} type="button" class="chip" aria-pressed={shown} aria-label={`Show: ${label}`} title={`Show ${label}, or not`} onClick={() => toggle_hidden(eye_of(id))}>
              <span class="swatch" style={{ background: color }} />{label}<Icon name={shown ? 'eye' : 'hidden'} />
            </button>
          );
        })}
      </div>
    </aside>
  );
}

function PickedPoint() {
  const { viewer } = use_app();
  viewer.tick.value;
  const s = viewer.picked.value;
  const scene = viewer.scene.value;
  if (s === null || !scene || !viewer.shown) return null;
  const span = total_length(scene.arm);
  const places = length_places(span);
  const point = point_at(viewer.shown.samples, s);
  const bent = point.curvature * span > 1e-4;
  return (
    <aside class="picked" aria-label="The picked point of the backbone">
      <header>
        <b>Backbone</b>
        <button type="button" class="button quiet square" aria-label="Clear selection" title="Clear selection (Esc)" onClick={() => (viewer.picked.value = null)}>
          <Icon name="close" />
        </button>
      </header>
      <label class="sr" for="picked-s">Arc length of the picked point</label>
      <input id="picked-s" type="range" title="Where along the arm" min={0} max={span} step={span / 1000} value={s}
        onInput={(event) => (viewer.picked.value = event.currentTarget.valueAsNumber)} />
      <dl>
        <div><dt>s</dt><dd>{fixed(s, places)} m, section {section_of(scene.arm.sections, s)}</dd></div>
        <div><dt>Curvature</dt><dd>{fixed(point.curvature, 3)} 1/m{bent && ` (radius ${fixed(1 / point.curvature, places)} m)`}</dd></div>
        <div><dt>Bending plane</dt><dd>{bent ? angle(point.plane) : 'straight'}</dd></div>
        <div><dt>Position</dt><dd>{vector(point.position, places)} m</dd></div>
        <div><dt>Tangent</dt><dd>{vector(point.tangent, 3)}</dd></div>
      </dl>
    </aside>
  );
}

function section_of(sections: { length: number }[], s: number): number {
  let end = 0;
  const i = sections.findIndex(({ length }) => s <= (end += length));
  return (i < 0 ? sections.length - 1 : i) + 1;
}

function TipNote() {
  const { viewer } = use_app();
  const { tip_goal, tip_result } = viewer.commander;
  const goal = tip_goal.value;
  const result = tip_result.value;
  const span = viewer.scene.value ? total_length(viewer.scene.value.arm) : 1;
  if (!goal) return null;
  const why = result && obstruction(result);
  return (
    <div class="tip-note" data-reached={!why} role="status" id="tip-note">
      {why ? `${why} (off by ${fixed(result!.position_error, length_places(span))} m)` : `Tip to ${vector(goal, length_places(span))} m`}
    </div>
  );
}
