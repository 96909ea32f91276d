// The axes of the world in the corner of the 3D view, as seen from there. A click on one looks along it.
import { useEffect, useRef } from 'preact/hooks';
import { use_app } from '../ui/app';

interface Axis {
  name: string;
  kind: 'x' | 'y' | 'z';
  /** Its column in the camera's matrix, and its sign. */
  column: number;
  sign: 1 | -1;
  /** The view from its end. */
  azimuth: number;
  elevation: number;
}

const quarter = Math.PI / 2;

const axes: Axis[] = [
  { name: 'X', kind: 'x', column: 0, sign: 1, azimuth: quarter, elevation: 0 },
  { name: 'Y', kind: 'y', column: 1, sign: 1, azimuth: 0, elevation: quarter },
  { name: 'Z', kind: 'z', column: 2, sign: 1, azimuth: 0, elevation: 0 },
  { name: '−X', kind: 'x', column: 0, sign: -1, azimuth: -quarter, elevation: 0 },
  { name: '−Y', kind: 'y', column: 1, sign: -1, azimuth: 0, elevation: -quarter },
  { name: '−Z', kind: 'z', column: 2, sign: -1, azimuth: 2 * quarter, elevation: 0 },
];

/** Half of its edge and the length of an axis, px. */
const [half, reach] = [42, 30];

export function Gizmo() {
  const app = use_app();
  const view = app.view.value;
  const svg = useRef<SVGSVGElement>(null);

  useEffect(() => {
    if (!view) return;
    const turn = (): void => {
      const arms = [...svg.current!.children] as SVGGElement[];
      const e = view.camera.matrixWorldInverse.elements;
      const depth = new Map<Element, number>();
      for (const arm of arms) {
        const { column, sign } = axes[Number(arm.dataset['axis'])];
        const [x, y] = [sign * reach * e[4 * column], -sign * reach * e[4 * column + 1]];
        depth.set(arm, sign * e[4 * column + 2]);
        arm.querySelector('.end')!.setAttribute('transform', `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
        const line = arm.querySelector('line');
        line?.setAttribute('x2', x.toFixed(1));
        line?.setAttribute('y2', y.toFixed(1));
      }
      // The nearest end is drawn last, unless that changes nothing: an element that is moved loses the focus.
      const sorted = [...arms].sort((a, b) => depth.get(a)! - depth.get(b)!);
      if (sorted.some((arm, i) => arm !== arms[i]) && !svg.current!.contains(document.activeElement)) svg.current!.append(...sorted);
    };
    turn();
    view.look_listeners.add(turn);
    return () => void view.look_listeners.delete(turn);
  }, [view]);

  if (!view) return null;
  const look = ({ azimuth, elevation }: Axis): void => {
    app.views.free();
    view.orbit.look(azimuth, elevation);
    view.invalidate();
  };
  return (
    <svg class="gizmo" ref={svg} viewBox={`${-half} ${-half} ${2 * half} ${2 * half}`} role="group" aria-label="Directions of the axes">
      {axes.map((axis, i) => (
        <g key={axis.name} class={axis.kind} data-axis={i}>
          {axis.sign > 0 && <line x2="0" y2="0" />}
          <g class="end" role="button" tabindex={0} aria-label={`Look from ${axis.name}`} data-negative={axis.sign < 0}
            onClick={() => look(axis)}
            onKeyDown={(event) => {
              if (event.key !== 'Enter' && event.key !== ' ') return;
              event.preventDefault();
              event.stopPropagation();
              look(axis);
            }}>
            <title>{`Look from ${axis.name}`}</title>
            <circle r={axis.sign > 0 ? 9 : 6.5} />
            {axis.sign > 0 && <text y="0.5">{axis.name}</text>}
          </g>
        </g>
      ))}
    </svg>
  );
}
