import { preferences } from '../state/preferences';
import { use_app } from './app';
import { Icon } from './Icon';

/** For who opens the page for the first time, in a strip of their own; each until it is dismissed. */
export function Hints() {
  const { viewer } = use_app();
  const hello = viewer.hello.value;
  if (!hello) return null;
  const can_move = hello.mode === 'live' && !hello.readonly;
  const { controls } = hello;
  const hints = [
    { id: 'turn', about: 'turning the view', text: 'Drag to turn the view.', shown: true },
    { id: 'run', about: 'running tasks', text: 'Click “Run tasks” at the top to start the tasks.', shown: can_move && controls.tasks.length > 0 },
    {
      id: 'move', about: 'moving the arm', shown: can_move,
      text: controls.push ? 'Move a slider, or push the arm: Shift and drag.' : 'Move a slider: the arm follows.',
    },
  ].filter(({ id, shown }) => shown && !preferences.known_hints.value.includes(id));
  if (!hints.length) return null;
  return (
    <ul class="hints" aria-label="First hints">
      {hints.map(({ id, about, text }) => (
        <li key={id}>
          <span>{text}</span>
          <button type="button" class="button quiet square" aria-label={`Hide the hint about ${about}`} title="Do not show this hint again"
            onClick={() => (preferences.known_hints.value = [...preferences.known_hints.peek(), id])}>
            <Icon name="close" />
          </button>
        </li>
      ))}
    </ul>
  );
}
