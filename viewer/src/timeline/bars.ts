// Bars of the tasks on the timeline, with what happens in each.
import type { Mark } from '../protocol/types';
import type { History } from '../state/history';
import { flag_running } from '../protocol/state';
import { labels_of, type Label } from './labels';

export interface Bar {
  name: string;
  /** Its kind; "" if it says no more than the name. */
  kind: string;
  start: number;
  end: number;
  ticks: Label[];
}

export interface Lane {
  bars: Bar[];
  /** What belongs to no task. */
  labels: Label[];
}

/** What the program says where a task starts: its kind comes before it (flexura/experiment/player.cc). */
const starts_text = / starts$/;
/** Name of the event that ends a run. */
const run_end = 'run';

/**
 * Returns the tasks of the marks with their times. Where a task's mark does not know its end, the task ends with the
 * next one, with the run, or at `end_of`.
 */
export function bars_of(marks: Mark[], end_of: (start: number) => number): Bar[] {
  const sorted = [...marks].sort((a, b) => a.time - b.time);
  const starts = sorted.filter(({ time, end, text }) => end > time || starts_text.test(text));
  return starts.map(({ name, time, end, text }, i) => {
    const kind = text.replace(starts_text, '');
    const next = starts[i + 1]?.time ?? Infinity;
    const over = sorted.find((mark) => mark.name === run_end && mark.time >= time)?.time ?? Infinity;
    return { name, kind: kind === name ? '' : kind, start: time, end: end > time ? end : Math.max(time, Math.min(next, over, end_of(time))), ticks: [] };
  });
}

/** Returns the bars with their ticks, and labels for the rest, for the times from `from` to `to`. */
export function lane_of(marks: Mark[], end_of: (start: number) => number, from: number, to: number): Lane {
  const bars = bars_of(marks, end_of).filter(({ start, end }) => end >= from && start <= to);
  const rest = marks.filter(({ time, end }) => end >= from && time <= to);
  const within = (bar: Bar): Mark[] => rest.filter((mark) => bar === bar_at(bars, mark.time) && !(mark.name === bar.name && mark.time === bar.start));
  for (const bar of bars) bar.ticks = labels_of(within(bar), from, to);
  const labels = labels_of(rest.filter(({ time }) => !bar_at(bars, time)), from, to);
  for (const label of labels) {
    const next = bars.find(({ start }) => start > label.time);
    label.until = Math.min(label.until, next?.start ?? to);
  }
  return { bars, labels };
}

/** Returns the task at a time; at the border of two, the later one. */
function bar_at(bars: Bar[], time: number): Bar | undefined {
  return bars.filter(({ start, end }) => start <= time && time <= end).at(-1);
}

/** Returns when the rig stopped running what began at `start`, as its states say; the newest time while it runs. */
export function run_end_in(history: History, start: number): number {
  const newest = history.newest?.time ?? start;
  let has_run = false;
  for (let i = history.index_at(start); i < history.count; ++i) {
    const { flags, time } = history.at_index(i);
    const runs = (flags & flag_running) !== 0;
    if (has_run && !runs) return time;
    has_run ||= runs && time >= start;
  }
  return newest;
}
