// Placement of the labels of the timeline's marks.
import type { Mark } from '../protocol/types';

/** Label of one event, or of several that are too close to be distinguished. */
export interface Label {
  time: number;
  /** End of the longest event; equal to its time if it has no duration. */
  end: number;
  /** Right end of the label: the start of the next one. */
  until: number;
  marks: Mark[];
}

/** Smallest distance of labels, as a share of the line: the width of a mark on the narrowest line. */
const nearest = 0.012;

/** Returns labels that do not overlap. */
export function labels_of(marks: Mark[], from: number, to: number): Label[] {
  const near = nearest * (to - from);
  const labels: Label[] = [];
  for (const mark of [...marks].sort((a, b) => a.time - b.time)) {
    // Events that began earlier are placed at the start of the line.
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
