import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Line, LineBasicMaterial } from 'three';
import { sample_stride, type State } from '../../protocol/state';
import type { Part, PartContext } from '../part';
import { plain } from '../plain';

export const most_points = 3000;
/**
 * Limits of time and distance between two shown states; beyond them the view was scrubbed, and the trail is
 * interrupted.
 */
const jump_s = 0.5;
const jump_share = 0.03;

/** The observed path of the tip. It restarts if time goes back or jumps, or if the tip is set to another position. */
export function make_trail({ span, theme }: PartContext): Part[] {
  const points = new Float32Array(3 * most_points);
  const attribute = new BufferAttribute(points, 3).setUsage(DynamicDrawUsage);
  const geometry = new BufferGeometry().setAttribute('position', attribute);
  const line = new Line(geometry, plain(new LineBasicMaterial({ color: theme === 'dark' ? 0xffc857 : 0xb36b00 })));
  line.frustumCulled = false;
  let count = 0;
  let time = 0;
  let leaps = 0;
  geometry.setDrawRange(0, 0);
  return [{
    id: 'trail',
    label: 'Trail of the tip',
    group: line,
    draw(state: State) {
      const tip = state.samples.length - sample_stride + 1;
      const [x, y, z] = [state.samples[tip], state.samples[tip + 1], state.samples[tip + 2]];
      const last = 3 * (count - 1);
      const way = count ? Math.hypot(x - points[last], y - points[last + 1], z - points[last + 2]) : 0;
      const jumped = state.time - time > jump_s && way > jump_share * span;
      if (state.time < time || state.leaps !== leaps || jumped) count = 0;
      time = state.time;
      leaps = state.leaps;
      if (count && way < 1e-3 * span) return;
      if (count === most_points) {
        // The oldest half is dropped at once, because moving all points with every state would cost more.
        points.copyWithin(0, (3 * most_points) / 2);
        count = most_points / 2;
      }
      points[3 * count] = x;
      points[3 * count + 1] = y;
      points[3 * count + 2] = z;
      ++count;
      geometry.setDrawRange(0, count);
      attribute.needsUpdate = true;
    },
    dispose() {
      geometry.dispose();
      (line.material as LineBasicMaterial).dispose();
    },
  }];
}
