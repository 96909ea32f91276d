import { useEffect, useRef } from 'preact/hooks';
import { effect } from '@preact/signals';
import { use_app } from './app';
import { Icon } from './Icon';

/** Examples offered by a program that was started without a file. Opens by itself on the first visit. */
export function Examples() {
  const app = use_app();
  const { viewer } = app;
  const dialog = useRef<HTMLDialogElement>(null);
  const asked = useRef<string | null>(null);
  const open = app.dialog.value === 'examples';
  useEffect(() => {
    if (open) dialog.current?.showModal();
    else dialog.current?.close();
  }, [open]);
  useEffect(() => effect(() => {
    const hello = viewer.hello.value;
    if (!hello || asked.current === hello.session) return;
    asked.current = hello.session;
    if (hello.examples?.length && app.route.value === 'viewer') app.dialog.value = 'examples';
  }), []);
  const examples = viewer.hello.value?.examples ?? [];
  const choose = (name: string) => () => {
    app.dialog.value = null;
    void viewer.commander.open_example(name);
  };
  return (
    <dialog ref={dialog} class="examples" aria-labelledby="examples-title" onClose={() => (app.dialog.value = null)}>
      <header>
        <h2 id="examples-title">Open an example</h2>
        <button type="button" class="button quiet square" aria-label="Close" title="Close (Esc)" onClick={() => (app.dialog.value = null)}>
          <Icon name="close" />
        </button>
      </header>
      <ol>
        {examples.map(({ name, title }) => (
          <li key={name}>
            <button type="button" class="button" title={`Opens ${name}`} onClick={choose(name)}>
              <span>{title}</span><small>{name}</small>
            </button>
          </li>
        ))}
      </ol>
      <p>
        To see an experiment of your own: <code>flexura new servo</code>, then <code>flexura view servo.toml</code>.
      </p>
    </dialog>
  );
}
