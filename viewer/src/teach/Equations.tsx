// The paper's equations 1 to 10 with a consistent sign convention, and the values of the chosen section.
import type { ComponentChildren } from 'preact';
import type { PlanarRow } from '../math/planar';
import { Frac, Func, Math_, N, Op, Sub, Sum } from './mathml';

interface Props {
  rows: PlanarRow[];
  lengths: number[];
  /** The section whose values are shown. */
  at: number;
}

const degree = 180 / Math.PI;

function deg(radians: number): string {
  return `${(radians * degree).toFixed(1).replace('-', '−')}°`;
}

function len(value: number): string {
  return value.toFixed(3).replace('-', '−');
}

/** Formats an angle as "+ 9.0°" or "− 9.0°". */
function signed(radians: number): ComponentChildren {
  return <><Op>{radians < 0 ? '−' : '+'}</Op><N>{deg(Math.abs(radians))}</N></>;
}

function signed_length(value: number): ComponentChildren {
  return <><Op>{value < 0 ? '−' : '+'}</Op><N>{len(Math.abs(value))}</N></>;
}

export function Equations({ rows, lengths, at }: Props) {
  const row = rows[at];
  const n = at + 1;
  const sum = rows.slice(0, at).reduce((total, { arching }) => total + arching, 0);
  return (
    <div class="equations">
      <Equation number="1" words="An arc leaves its base along the straight section. Its arching β, the angle between that direction and the cord, is half the angle at the centre.">
        <Sub of="β" by={n} /><Op>=</Op><Frac over={<Sub of="α" by={n} />} under={<N>2</N>} /><Op>=</Op><N>{deg(row.arching)}</N>
      </Equation>
      <Equation number="2, 3, 6" words="The arc keeps its length; its cord is shorter, by a factor that is 1 for a straight section.">
        <Sub of="c" by={n} /><Op>=</Op><Sub of="l" by={n} />
        <Frac over={<><Func>sin</Func><Sub of="β" by={n} /></>} under={<Sub of="β" by={n} />} />
        <Op>=</Op><N>{len(lengths[at])}</N><Op>·</Op><N>{len(row.cord / lengths[at])}</N><Op>=</Op><N>{len(row.cord)}</N>
      </Equation>
      <Equation number="5" words="Each earlier section turns the base of this section by twice its arching; the cord angle adds this section’s own arching once."
        values={<><Op>=</Op><N>90°</N>{signed(2 * sum)}{signed(row.arching)}<Op>=</Op><N>{deg(row.cord_angle)}</N></>}>
        <Sub of="γ" by={n} /><Op>=</Op><Sub of="γ" by={0} /><Op>+</Op><N>2</N><Op>·</Op>
        <Sum /><Sub of="β" by="k" /><Op>+</Op><Sub of="β" by={n} />
      </Equation>
      <Equation number="7, 9" words="The next base point is at the other end of the cord."
        values={<><Op>=</Op><N>{len(row.x)}</N>{signed_length(row.end_x - row.x)}<Op>=</Op><N>{len(row.end_x)}</N></>}>
        <Sub of="x" by={n + 1} /><Op>=</Op><Sub of="x" by={n} /><Op>+</Op><Sub of="c" by={n} /><Func>cos</Func><Sub of="γ" by={n} />
      </Equation>
      <Equation number="8, 10" words=""
        values={<><Op>=</Op><N>{len(row.y)}</N>{signed_length(row.end_y - row.y)}<Op>=</Op><N>{len(row.end_y)}</N></>}>
        <Sub of="y" by={n + 1} /><Op>=</Op><Sub of="y" by={n} /><Op>+</Op><Sub of="c" by={n} /><Func>sin</Func><Sub of="γ" by={n} />
      </Equation>
      <p class="note">
        Angles are counter-clockwise from Ox; the arm starts upright, γ<sub>0</sub> = 90°. The paper counts archings
        clockwise, so its equation 5 has minus signs.
      </p>
    </div>
  );
}

interface EquationProps {
  number: string;
  words: string;
  /** Part that moves to the next line if it does not fit; MathML has no automatic line breaks. */
  values?: ComponentChildren;
  children: ComponentChildren;
}

function Equation({ number, words, values, children }: EquationProps) {
  return (
    <div class="equation">
      {words && <p>{words}</p>}
      <div class="formula">
        <div class="sides"><Math_>{children}</Math_>{values && <Math_>{values}</Math_>}</div>
        <span class="number-of">({number})</span>
      </div>
    </div>
  );
}
