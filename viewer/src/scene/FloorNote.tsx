// Says that the arm passes through the floor, where the floor is only drawn. A floor that is an obstacle is not
// mentioned: the program's condition names it (ui/ConditionBadge.tsx).
import { use_app } from '../ui/app';
import { depth_below, depth_text, floor_of } from './floor_level';

export function FloorNote() {
  const { viewer } = use_app();
  viewer.tick.value;
  const scene = viewer.scene.value;
  if (!scene?.arm.visible || !viewer.shown) return null;
  const { height, obstacle } = floor_of(scene);
  const depth = obstacle === null ? depth_below(viewer.shown.samples, scene.arm, height) : 0;
  if (depth === 0) return null;
  return (
    <div class="floor-note" id="floor-note" role="status" title="The floor is drawn only to show heights. The experiment has no plane obstacle there, so nothing stops the arm.">
      The arm passes through the floor by {depth_text(depth)}
    </div>
  );
}
