import type { PlanarRow } from '../math/planar';

const degree = 180 / Math.PI;

function deg(radians: number): string {
  return `${(radians * degree).toFixed(1).replace('-', '−')}°`;
}

function len(value: number): string {
  return value.toFixed(3).replace('-', '−');
}

/** The whole recurrence as a table; each row depends on the one above. */
export function Recurrence({ rows, at, choose }: { rows: PlanarRow[]; at: number; choose(at: number): void }) {
  return (
    <table class="recurrence">
      <thead>
        <tr>
          <th scope="col">n</th><th scope="col">tangent</th><th scope="col">β</th><th scope="col">γ</th>
          <th scope="col">cord</th><th scope="col">end x</th><th scope="col">end y</th>
        </tr>
      </thead>
      <tbody>
        {rows.map((row, i) => (
          <tr key={i} data-at={i === at} onClick={() => choose(i)}>
            <th scope="row">{i + 1}</th>
            <td>{deg(row.tangent)}</td><td>{deg(row.arching)}</td><td>{deg(row.cord_angle)}</td>
            <td>{len(row.cord)}</td><td>{len(row.end_x)}</td><td>{len(row.end_y)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
