import { useEffect, useRef } from 'preact/hooks';
import { useSignal } from '@preact/signals';
import { save_file } from '../plots/csv';
import type { TextProblem } from '../protocol/types';
import { use_app } from './app';
import { changed_at, offset_of } from './experiment_text';
import { Icon } from './Icon';

/** Pause in typing after which the text is checked, ms. */
const pause_ms = 400;
/** The program takes no longer message; some room is for what goes with the text. */
const most_bytes = 60_000;

/** The text of the experiment: to look at, to edit, and to save as a new file. */
export function Experiment() {
  const app = use_app();
  const { viewer, editing } = app;
  const dialog = useRef<HTMLDialogElement>(null);
  const area = useRef<HTMLTextAreaElement>(null);
  const gutter = useRef<HTMLDivElement>(null);
  const text = useSignal<string | null>(null);
  const name = useSignal('');
  const folder = useSignal('');
  const problems = useSignal<TextProblem[] | null>(null);
  const saved = useSignal('');
  const timer = useRef<ReturnType<typeof setTimeout> | undefined>(undefined);
  const open = app.dialog.value === 'experiment';

  const check = async (checked: string): Promise<void> => {
    try {
      const found = await viewer.commander.check(checked);
      if (area.current?.value === checked) problems.value = found;
    } catch (error) {
      viewer.notices.error(error);
    }
  };
  const load = async (): Promise<void> => {
    text.value = problems.value = null;
    saved.value = '';
    try {
      const [before, got] = await Promise.all([
        editing.value.add ? viewer.commander.experiment({}) : null, viewer.commander.experiment(editing.value),
      ]);
      text.value = got.text;
      name.value = got.name;
      folder.value = got.folder;
      problems.value = [];
      const at = before ? changed_at(before.text, got.text) : null;
      // After the text is in its field.
      requestAnimationFrame(() => (at ? select(at.from, at.to) : area.current?.focus()));
    } catch (error) {
      viewer.notices.error(error);
      app.dialog.value = null;
    }
  };
  useEffect(() => {
    if (!open) return dialog.current?.close();
    dialog.current?.showModal();
    void load();
  }, [open]);

  const select = (from: number, to: number): void => {
    const field = area.current!;
    field.focus();
    field.setSelectionRange(from, to);
    const line = field.value.slice(0, from).split('\n').length - 1;
    const height = field.scrollHeight / Math.max(1, field.value.split('\n').length);
    field.scrollTop = Math.max(0, line * height - field.clientHeight / 3);
    field.scrollLeft = 0;
  };
  const edited = (value: string): void => {
    text.value = value;
    saved.value = '';
    problems.value = null;
    clearTimeout(timer.current);
    timer.current = setTimeout(() => void check(value), pause_ms);
  };
  const save = async (): Promise<void> => {
    if (text.value === null) return;
    try {
      const { problems: found, file } = await viewer.commander.save_experiment(text.value, name.value);
      problems.value = found;
      saved.value = file ?? '';
    } catch (error) {
      viewer.notices.error(error);
    }
  };
  const bytes = text.value === null ? 0 : new Blob([JSON.stringify(text.value)]).size;
  const is_long = bytes > most_bytes;
  const lines = text.value?.split('\n').length ?? 1;
  const faulty = new Set(problems.value?.map(({ line }) => line));
  return (
    <dialog ref={dialog} class="experiment" aria-labelledby="experiment-title" onClose={() => (app.dialog.value = null)}>
      <header>
        <h2 id="experiment-title">The experiment</h2>
        <button type="button" class="button quiet square" aria-label="Close" title="Close (Esc)" onClick={() => (app.dialog.value = null)}>
          <Icon name="close" />
        </button>
      </header>
      <div class="text">
        <div class="gutter" ref={gutter} aria-hidden="true">
          {Array.from({ length: lines }, (_, i) => <span key={i} data-faulty={faulty.has(i + 1)}>{i + 1}</span>)}
        </div>
        <textarea ref={area} aria-label="Text of the experiment" title="The experiment as a file: it can be edited here" wrap="off" spellcheck={false}
          disabled={text.value === null} value={text.value ?? ''} onInput={(event) => edited(event.currentTarget.value)}
          onScroll={() => (gutter.current!.scrollTop = area.current!.scrollTop)} />
      </div>
      <div class="problems" role="status">
        {is_long && <p class="fault">This text is longer than 60 kB, which is too long to check and save it here. Download it, and check it with <code>flexura check</code>.</p>}
        {!is_long && problems.value === null && <p>Checking …</p>}
        {!is_long && problems.value?.length === 0 && !saved.value && <p>A valid experiment.</p>}
        {saved.value && <p>Saved: <code>{saved.value}</code>. To open it: <code>flexura view {saved.value}</code></p>}
        {problems.value && problems.value.length > 0 && (
          <ul>
            {problems.value.map(({ line, column, text: what }, i) => (
              <li key={i}>
                {line > 0 && (
                  <button type="button" class="button quiet" title="Goes to this place in the text"
                    onClick={() => { const at = offset_of(text.value ?? '', line, column); select(at, at); }}>
                    {line}:{column}
                  </button>
                )}
                <span>{what}</span>
              </li>
            ))}
          </ul>
        )}
      </div>
      <form onSubmit={(event) => { event.preventDefault(); void save(); }}>
        <label title={`A new file in ${folder.value}; none is overwritten`}>
          New file <input type="text" value={name.value} spellcheck={false} onInput={(event) => (name.value = event.currentTarget.value)} />
        </label>
        <button type="submit" class="button primary" title="Saves the text as a new file, if the experiment is valid"
          disabled={text.value === null || is_long || (problems.value?.length ?? 0) > 0}><Icon name="save" />Save</button>
        <button type="button" class="button" title="Downloads the text as a file" disabled={text.value === null}
          onClick={() => save_file(name.value || 'experiment.toml', text.value ?? '', 'application/toml')}>Download</button>
        <button type="button" class="button quiet" title="Back to the text of the experiment" onClick={() => { editing.value = {}; void load(); }}>
          <Icon name="reset" />Start over
        </button>
      </form>
    </dialog>
  );
}
