import type { ComponentChildren } from 'preact';
import { useSignal } from '@preact/signals';
import type { MeasureResult, SceneCamera, SeeingChoice } from '../protocol/types';
import { lines_of, options_of, quoted } from '../state/seeing';
import { copy_text } from '../ui/clipboard';
import { use_app } from '../ui/app';
import { Icon } from '../ui/Icon';
import { found_text, no_color, type Finder, type Tool } from './finder';
import { MeasurePanel } from './MeasurePanel';

const tools: { id: Tool; label: string; title: string }[] = [
  { id: 'rectangle', label: 'Rectangle', title: 'Draw a rectangle: the arm is searched only inside' },
  { id: 'polygon', label: 'Polygon', title: 'Draw a polygon: the arm is searched only inside' },
  { id: 'color', label: 'Colour', title: 'Click a pixel of the arm: only pixels of about its colour are the arm' },
  { id: 'base', label: 'Base', title: 'Click the base of the arm: of several figures the nearest is the arm' },
];

/** Says where the arm is in a camera's pictures, and what was found. */
export function FinderPanel({ camera, finder, result }: { camera: SceneCamera; finder: Finder; result: MeasureResult | null }) {
  const { viewer } = use_app();
  const { seeing } = viewer;
  const choice = seeing.choice_of(camera.name);
  const is_file = viewer.hello.value?.mode === 'pictures';
  const background = camera.seeing?.background;
  const options = options_of(choice, background);
  const set = (change: SeeingChoice): void => seeing.set(camera.name, change);
  return (
    <section class="finder" aria-label={`Find the arm in the pictures of ${camera.name}`}>
      <h2>Find the arm</h2>
      <div class="chips" role="group" aria-label="Tools">
        {tools.map(({ id, label, title }) => (
          <button key={id} type="button" class="chip" aria-pressed={finder.tool.value === id}
            title={id === 'color' && camera.channels === 1 ? no_color : title} onClick={() => finder.choose(id)}>{label}</button>
        ))}
      </div>
      <p class="said" role="status">{finder.said.value}</p>
      <ul class="choices">
        <Value label="Region" none="the whole picture" clear={() => set({ region: undefined })}>
          {choice.region && (choice.region.length === 2 ? 'rectangle' : `polygon with ${choice.region.length} corners`)}
        </Value>
        <Value label="Colour" none={camera.channels === 1 ? 'none: the picture is gray' : 'any'} clear={() => set({ color: undefined })}>
          {choice.color && <><span class="swatch" style={{ background: `rgb(${choice.color.join()})` }} />{choice.color.join(', ')}</>}
        </Value>
        <Value label="Base" none={is_file ? 'chosen by the program' : 'where the model has it'} clear={() => set({ base: undefined })}>
          {choice.base && `(${choice.base.join(', ')})`}
        </Value>
        {background && <li><b>Background</b> {background}</li>}
      </ul>
      <div class="row">
        <button type="button" class="button" disabled={!Object.keys(choice).length} title="Removes region, colour and base"
          onClick={() => (finder.cancel(), seeing.clear(camera.name))}>Clear</button>
        {camera.seeing && seeing.is_changed(camera.name) && (
          <button type="button" class="button" title="Uses the region and the colour of the experiment again"
            onClick={() => (finder.cancel(), seeing.restore(camera.name))}>As in the experiment</button>
        )}
      </div>
      <MeasurePanel cameras={1} always="axis" />
      <p class="result" role="status" data-found={result?.found ?? ''}>{found_text(result)}</p>
      {result && result.notes.length > 0 && <ul class="notes">{result.notes.map((note) => <li key={note}>{note}</li>)}</ul>}
      {options && <Taken label="On the command line"
        text={is_file ? `flexura measure ${quoted(camera.name)} ${options}` : options} />}
      {!is_file && lines_of(camera.name, choice, background) && (
        <Taken label="In the experiment file" text={lines_of(camera.name, choice, background)} />
      )}
    </section>
  );
}

/** A value with a button that removes it. */
function Value({ label, none, clear, children }: { label: string; none: string; clear(): void; children?: ComponentChildren }) {
  return (
    <li>
      <b>{label}</b> {children ?? <span class="quiet">{none}</span>}
      {children && (
        <button type="button" class="icon-button" title={`Remove: ${label.toLowerCase()}`} aria-label={`Remove: ${label.toLowerCase()}`}
          onClick={clear}><Icon name="close" /></button>
      )}
    </li>
  );
}

/** A text to take away. */
function Taken({ label, text }: { label: string; text: string }) {
  const copied = useSignal('');
  return (
    <div class="taken">
      <div class="row">
        <b>{label}</b>
        <button type="button" class="button quiet" title="Copies the text to the clipboard" aria-label={`Copy: ${label}`}
          onClick={async () => (copied.value = (await copy_text(text)) ? text : '')}>
          <Icon name="copy" />{copied.value === text ? 'Copied' : 'Copy'}
        </button>
      </div>
      <pre>{text}</pre>
    </div>
  );
}
