// Drawing of the planar arm: arcs, cords, base points, and handles to drag.
import { useRef } from 'preact/hooks';
import { planar_rows, type PlanarSection } from '../math/planar';
import { grid_step } from '../scene/parts/floor';
import { pull } from './drag';

interface Props {
  sections: PlanarSection[];
  at: number;
  goal?: [number, number];
  reached: boolean;
  limit: number;
  choose(at: number): void;
  change(sections: PlanarSection[]): void;
}

export function PlaneView({ sections, at, goal, reached, limit, choose, change }: Props) {
  const svg = useRef<SVGSVGElement>(null);
  const dragged = useRef<number | null>(null);
  const rows = planar_rows(sections);
  const total = sections.reduce((sum, { length }) => sum + length, 0);
  const unit = total / 100;
  const box = { x: -0.95 * total, y: -1.1 * total, w: 1.9 * total, h: 1.6 * total };
  const point = (event: PointerEvent): [number, number] => {
    const matrix = svg.current!.getScreenCTM()!.inverse();
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
    return [p.x, -p.y];
  };
  const row = rows[at];
  return (
    <svg ref={svg} class="plane" viewBox={`${box.x} ${box.y} ${box.w} ${box.h}`} role="img"
      aria-label={`The arm in the plane; its tip is at ${rows.at(-1)!.end_x.toFixed(2)}, ${rows.at(-1)!.end_y.toFixed(2)}`}
      onPointerMove={(event) => {
        if (dragged.current !== null) change(pull(sections, dragged.current, ...point(event), limit));
      }}
      onPointerUp={() => (dragged.current = null)}
      onPointerCancel={() => (dragged.current = null)}>
      <Grid box={{ x: 2 * box.x, y: 2 * box.y, w: 2 * box.w, h: 2.4 * box.h }} step={grid_step(total)} unit={unit} />
      {goal && <Goal at={goal} unit={unit} reached={reached} />}
      {rows.map((each, i) => (
        <g key={i} class="segment" data-at={i === at} onPointerDown={() => choose(i)}>
          <path class="skin" d={arc_path(each, sections[i].length)} stroke-width={2.6 * unit} />
          <line class="cord" x1={each.x} y1={-each.y} x2={each.end_x} y2={-each.end_y} stroke-width={0.45 * unit} />
        </g>
      ))}
      <Tangent row={row} length={sections[at].length} unit={unit} />
      {rows.map((each, i) => (
        <circle key={i} class="joint" data-tip={i === rows.length - 1} cx={each.end_x} cy={-each.end_y} r={(i === rows.length - 1 ? 2.4 : 1.6) * unit}
          onPointerDown={(event) => {
            svg.current!.setPointerCapture(event.pointerId);
            dragged.current = i;
            choose(i);
          }} />
      ))}
      <circle class="foot" cx={0} cy={0} r={1.6 * unit} />
    </svg>
  );
}

type Row = ReturnType<typeof planar_rows>[0];

function arc_path(row: Row, length: number): string {
  const start = `M${row.x} ${-row.y}`;
  if (Math.abs(row.arching) < 1e-4) return `${start}L${row.end_x} ${-row.end_y}`;
  const radius = Math.abs(length / (2 * row.arching));
  const large = Math.abs(row.arching) > Math.PI / 2 ? 1 : 0;
  return `${start}A${radius} ${radius} 0 ${large} ${row.arching > 0 ? 0 : 1} ${row.end_x} ${-row.end_y}`;
}

/** The straight section from which the arching is measured, and the angle itself. */
function Tangent({ row, length, unit }: { row: Row; length: number; unit: number }) {
  const far = (angle: number, r: number): [number, number] => [row.x + r * Math.cos(angle), -(row.y + r * Math.sin(angle))];
  const [x, y] = far(row.tangent, length);
  const r = Math.min(0.55 * length, 16 * unit);
  const [x0, y0] = far(row.tangent, r);
  const [x1, y1] = far(row.cord_angle, r);
  // In a short section the label would cover the next joint, so it is placed on the other side of the tangent.
  const is_short = length < r + 8 * unit;
  const [tx, ty] = is_short
    ? far(row.tangent - Math.sign(row.arching) * 0.6, Math.max(r, 6.5 * unit))
    : far(row.tangent + row.arching / 2, r + 4 * unit);
  return (
    <g class="tangent" stroke-width={0.4 * unit}>
      <line x1={row.x} y1={-row.y} x2={x} y2={y} stroke-dasharray={`${1.4 * unit} ${unit}`} />
      <path d={`M${x0} ${y0}A${r} ${r} 0 0 ${row.arching > 0 ? 0 : 1} ${x1} ${y1}`} />
      <text x={tx} y={ty} font-size={4.4 * unit} text-anchor="middle" dominant-baseline="middle">β</text>
    </g>
  );
}

function Goal({ at: [x, y], unit, reached }: { at: [number, number]; unit: number; reached: boolean }) {
  return (
    <g class="goal" data-reached={reached} stroke-width={0.6 * unit}>
      <circle cx={x} cy={-y} r={3.4 * unit} />
      <path d={`M${x - 5 * unit} ${-y}h${10 * unit}M${x} ${-y - 5 * unit}v${10 * unit}`} />
    </g>
  );
}

function Grid({ box, step, unit }: { box: { x: number; y: number; w: number; h: number }; step: number; unit: number }) {
  const lines: string[] = [];
  for (let x = Math.ceil(box.x / step) * step; x <= box.x + box.w; x += step) lines.push(`M${x} ${box.y}v${box.h}`);
  for (let y = Math.ceil(box.y / step) * step; y <= box.y + box.h; y += step) lines.push(`M${box.x} ${y}h${box.w}`);
  return (
    <g class="paper-grid" stroke-width={0.2 * unit}>
      <path d={lines.join('')} />
      <path class="axis" d={`M${box.x} 0h${box.w}M0 ${box.y}v${box.h}`} stroke-width={0.35 * unit} />
      <text x={(box.x + box.w) / 2 - 4 * unit} y={-2 * unit} font-size={4 * unit}>x</text>
      <text x={2 * unit} y={box.y / 2 + 5 * unit} font-size={4 * unit}>y</text>
    </g>
  );
}
