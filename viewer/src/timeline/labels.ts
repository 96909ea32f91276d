// Where the words of the timeline's marks stand.
import type { Mark } from '../protocol/types';

/** Words for what happened at one instant, or too near to it to be told apart on the line. */
export interface Label {
  time: number;
  /** Of what lasts, its end; else the same. */
  end: number;
  /** Where its words must end: where the next label begins. */
  until: number;
  marks: Mark[];
}

/** A share of the line: on the narrowest, as many pixels as a mark is wide. */
const nearest = 0.012;

/** No label's words lie upon another's. */
export function labels_of(marks: Mark[], from: number, to: number): Label[] {
  const near = nearest * (to - from);
  const labels: Label[] = [];
  for (const mark of [...marks].sort((a, b) => a.time - b.time)) {
    // What began before the line does stands at its start.
    const time = Math.max(from, mark.time);
    const last = labels.at(-1);
    if (last && time - last.time <= near) {
      last.marks.push(mark);
      last.end = Math.max(last.end, mark.end);
    } else {
      labels.push({ time, end: mark.end, until: to, marks: [mark] });
    }
  }
  labels.forEach((label, i) => (label.until = labels[i + 1]?.time ?? to));
  return labels;
}

export function name_of({ marks }: Label): string {
  return [...new Set(marks.map(({ name }) => name))].join(', ');
}
