// Places in the text of an experiment.

/** Returns what differs in `after`: from the first character that differs to the last. */
export function changed_at(before: string, after: string): { from: number; to: number } {
  const most = Math.min(before.length, after.length);
  let from = 0;
  while (from < most && before[from] === after[from]) ++from;
  let same = 0;
  while (same < most - from && before[before.length - 1 - same] === after[after.length - 1 - same]) ++same;
  return { from, to: after.length - same };
}

/** Returns the index of a character given by its line and column, both from 1. Columns count code points. */
export function offset_of(text: string, line: number, column: number): number {
  const lines = text.split('\n');
  const start = lines.slice(0, line - 1).reduce((sum, each) => sum + each.length + 1, 0);
  const before = Array.from(lines[line - 1] ?? '').slice(0, Math.max(0, column - 1)).join('');
  return Math.min(text.length, start + before.length);
}
