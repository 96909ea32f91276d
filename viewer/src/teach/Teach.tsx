// The planar arm beside its equations. No program is needed: the page computes the recurrence itself.
import { useSignal } from '@preact/signals';
import { archings_of, paper_cord_angles, paper_lengths, planar_rows, type PlanarSection } from '../math/planar';
import { Slider } from '../panels/Slider';
import { Icon } from '../ui/Icon';
import { Equations } from './Equations';
import { exercises, type Exercise } from './exercises';
import { PlaneView } from './PlaneView';
import { Recurrence } from './Recurrence';

/** Slightly more than a full turn of the section's arc. */
const limit = Math.PI;
const degree = 180 / Math.PI;

function paper_arm(): PlanarSection[] {
  return archings_of(paper_cord_angles).map((arching, i) => ({ length: paper_lengths[i], arching }));
}

export function Teach() {
  const sections = useSignal<PlanarSection[]>(paper_arm());
  const at = useSignal(0);
  const exercise = useSignal<Exercise | null>(null);
  const solved = useSignal<string[]>([]);
  const all = sections.value;
  const place = Math.min(at.value, all.length - 1);
  const rows = planar_rows(all);
  const verdict = exercise.value?.check(all);
  const change = (next: PlanarSection[]): void => {
    sections.value = next;
    const current = exercise.value;
    if (current?.check(next).done && !solved.value.includes(current.id)) solved.value = [...solved.value, current.id];
  };
  const open = (next: Exercise | null): void => {
    exercise.value = next;
    at.value = 0;
    change(next ? next.lengths.map((length, i) => ({ length, arching: next.start[i] })) : paper_arm());
  };
  return (
    <main class="teach">
      <section class="teach-arm" aria-label="The arm">
        <div class="plane-box">
          <PlaneView sections={all} at={place} goal={exercise.value?.goal} reached={verdict?.done ?? false} limit={limit}
            choose={(i) => (at.value = i)} change={change} />
          <output class="effector" id="effector">
            E = ({coordinate(rows.at(-1)!.end_x)}, {coordinate(rows.at(-1)!.end_y)})
          </output>
        </div>
        <div class="archings" role="group" aria-label="Archings">
          {all.map(({ arching }, i) => (
            <div key={`${exercise.value?.id} ${i}`} class="arching" data-at={i === place} onFocusCapture={() => (at.value = i)}>
              <Slider id={`arching-${i}`} label={`β${subscript(i + 1)}`} title={`Arching of section ${i + 1}`} value={arching}
                span={[-limit, limit]} reach={[-limit, limit]} scale={degree} unit="°" places={1}
                change={(value) => change(all.map((section, j) => (j === i ? { ...section, arching: value } : section)))} />
            </div>
          ))}
        </div>
      </section>
      <section class="teach-text" aria-label="Equations">
        <h2>Section {place + 1}</h2>
        <Equations rows={rows} lengths={all.map(({ length }) => length)} at={place} />
        <h2>Section by section</h2>
        <Recurrence rows={rows} at={place} choose={(i) => (at.value = i)} />
      </section>
      <Exercises current={exercise.value} solved={solved.value} verdict={verdict} open={open} />
    </main>
  );
}

interface ExercisesProps {
  current: Exercise | null;
  solved: string[];
  verdict: { done: boolean; text: string } | undefined;
  open(exercise: Exercise | null): void;
}

function Exercises({ current, solved, verdict, open }: ExercisesProps) {
  return (
    <section class="exercises" aria-label="Exercises">
      <h2>Exercises <span class="tally">{solved.length} of {exercises.length}</span></h2>
      <ol>
        <li><button type="button" aria-pressed={current === null} onClick={() => open(null)}>The paper’s arm, free</button></li>
        {exercises.map((exercise, i) => (
          <li key={exercise.id}>
            <button type="button" aria-pressed={exercise === current} onClick={() => open(exercise)}>
              <span class="tick" data-done={solved.includes(exercise.id)}>{solved.includes(exercise.id) ? '✓' : i + 1}</span>
              {exercise.title}
              {solved.includes(exercise.id) && <span class="sr">, done</span>}
            </button>
          </li>
        ))}
      </ol>
      {current && verdict && (
        <div class="task" data-done={verdict.done}>
          <p>{current.task}</p>
          <p class="verdict" role="status" id="verdict"><b>{verdict.done ? 'Done. ' : ''}</b>{verdict.text}</p>
          <details key={current.id}><summary>Hint</summary><p>{current.hint}</p></details>
          <button type="button" class="button quiet" onClick={() => open(current)}><Icon name="reset" />Start again</button>
        </div>
      )}
    </section>
  );
}

function coordinate(value: number): string {
  return value.toFixed(3).replace('-', '−');
}

function subscript(n: number): string {
  return String(n).replace(/\d/g, (digit) => '₀₁₂₃₄₅₆₇₈₉'[Number(digit)]);
}
