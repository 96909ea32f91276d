import { preferences, toggle_hidden } from '../state/preferences';
import { use_app } from '../ui/app';
import { Icon } from '../ui/Icon';

/** Visibility of the things in the 3D view. */
export function ScenePanel() {
  const { parts } = use_app();
  const hidden = preferences.hidden.value;
  return (
    <>
      <ul class="things">
        {parts.value.map(({ id, label }) => {
          const shown = !hidden.includes(id);
          return (
            <li key={id}>
              <button type="button" aria-pressed={shown} aria-label={`Show: ${label}`} title={shown ? `Hide: ${label}` : `Show: ${label}`} onClick={() => toggle_hidden(id)}>
                <Icon name={shown ? 'eye' : 'hidden'} />
                <span>{label}</span>
              </button>
            </li>
          );
        })}
      </ul>
      {hidden.length > 0 && (
        <button type="button" class="button quiet" title="Shows all hidden objects again" onClick={() => (preferences.hidden.value = [])}>Show everything</button>
      )}
    </>
  );
}
