import { useEffect, useRef } from 'preact/hooks';
import { help_of } from '../keys/keys';
import { preferences } from '../state/preferences';
import { use_app } from './app';
import { Icon } from './Icon';

const hand = [
  { keys: ['Drag'], what: 'Turn the view' },
  { keys: ['Right drag, Shift drag'], what: 'Move the view' },
  { keys: ['Shift drag on the arm'], what: 'Push an elastic arm at this point (without Shift if Push is switched on, G)' },
  { keys: ['Wheel'], what: 'Nearer or farther' },
  { keys: ['Double click'], what: 'Centre the view on the point' },
  { keys: ['Click on the arm'], what: 'Pick a point of the backbone' },
  { keys: ['Drag the tip’s handle'], what: 'The arm follows by inverse kinematics' },
  { keys: ['Drag a slider'], what: 'Set the slider’s value; with Shift in fine steps' },
  { keys: ['Drag in a plot'], what: 'Zoom in time; a double click shows the whole time' },
  { keys: ['Drag a border'], what: 'Change the size of a panel; a double click restores it' },
  { keys: ['Point at a camera’s picture'], what: 'The pixel’s exact value' },
];

export function Help() {
  const app = use_app();
  const dialog = useRef<HTMLDialogElement>(null);
  const open = app.dialog.value === 'help';
  useEffect(() => {
    if (open) dialog.current?.showModal();
    else dialog.current?.close();
  }, [open]);
  return (
    <dialog ref={dialog} class="help" aria-labelledby="help-title" onClose={() => (app.dialog.value = null)}>
      <header>
        <h2 id="help-title">Keys and mouse</h2>
        <label class="check">
          <input type="checkbox" title="Whether single keys trigger commands" checked={preferences.keys.value}
            onChange={(event) => (preferences.keys.value = event.currentTarget.checked)} />
          Enable keys
        </label>
        <button type="button" class="button quiet square" aria-label="Close" title="Close (Esc)" onClick={() => (app.dialog.value = null)}>
          <Icon name="close" />
        </button>
      </header>
      <div class="help-groups">
        {help_of(app.keys.bindings).map(({ group, rows }) => <Group key={group} title={group} rows={rows} />)}
        <Group title="Mouse" rows={hand} />
      </div>
      <p class="made-of">
        Flexura {app.viewer.hello.value?.version}. Made with three, preact and uPlot (<a href="licences.html" title="The licences of these parts" target="_blank" rel="noopener">licences</a>).
      </p>
    </dialog>
  );
}

function Group({ title, rows }: { title: string; rows: { keys: string[]; what: string }[] }) {
  return (
    <section>
      <h3>{title}</h3>
      <dl>
        {rows.map(({ keys, what }) => (
          <div key={what}><dt>{keys.map((key) => <kbd key={key}>{key}</kbd>)}</dt><dd>{what}</dd></div>
        ))}
      </dl>
    </section>
  );
}
