import { useEffect, useRef } from 'preact/hooks';
import { preferences } from '../state/preferences';
import { use_app } from './app';
import { Icon } from './Icon';

const hand = [
  ['Drag', 'Turn the view'],
  ['Right drag, Shift drag', 'Move the view'],
  ['Wheel', 'Nearer or farther'],
  ['Double click', 'Look at what is there'],
  ['Click on the arm', 'Pick a point of the backbone'],
  ['Drag the tip’s handle', 'The arm follows by inverse kinematics'],
  ['Point at a camera’s picture', 'The pixel’s exact value'],
];

export function Help() {
  const app = use_app();
  const dialog = useRef<HTMLDialogElement>(null);
  const open = app.dialog.value === 'help';
  useEffect(() => {
    if (open) dialog.current?.showModal();
    else dialog.current?.close();
  }, [open]);
  const groups = [...new Set(app.keys.bindings.map(({ group }) => group))];
  return (
    <dialog ref={dialog} class="help" aria-labelledby="help-title" onClose={() => (app.dialog.value = null)}>
      <header>
        <h2 id="help-title">Keys and mouse</h2>
        <label class="check">
          <input type="checkbox" checked={preferences.keys.value}
            onChange={(event) => (preferences.keys.value = event.currentTarget.checked)} />
          Keys are on
        </label>
        <button type="button" class="button quiet square" aria-label="Close" onClick={() => (app.dialog.value = null)}>
          <Icon name="close" />
        </button>
      </header>
      <div class="help-groups">
        {groups.map((group) => (
          <Group key={group} title={group}
            rows={app.keys.bindings.filter((binding) => binding.group === group).map(({ shown, what }) => [shown, what])} />
        ))}
        <Group title="Mouse" rows={hand} />
      </div>
      <p class="made-of">
        Flexura {app.viewer.hello.value?.version}. Made with three, preact and uPlot (<a href="licences.html" target="_blank" rel="noopener">licences</a>).
      </p>
    </dialog>
  );
}

function Group({ title, rows }: { title: string; rows: string[][] }) {
  return (
    <section>
      <h3>{title}</h3>
      <dl>
        {rows.map(([key, what]) => (
          <div key={key}><dt><kbd>{key}</kbd></dt><dd>{what}</dd></div>
        ))}
      </dl>
    </section>
  );
}
