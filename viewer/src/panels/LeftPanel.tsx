import type { ComponentChildren } from 'preact';
import { useSignal } from '@preact/signals';
import { use_app } from '../ui/app';
import { left_tabs } from './registry';

export function LeftPanel() {
  // The first tab that is shown, until the user chooses.
  const open = useSignal('');
  const { viewer } = use_app();
  const bad = viewer.events.value.filter(({ level }) => level !== 'info').length;
  const tabs = left_tabs.filter(({ shown }) => shown?.(viewer.hello.value) ?? true);
  const tab = tabs.find(({ id }) => id === open.value) ?? tabs[0];
  const move = (by: number): void => {
    const place = tabs.indexOf(tab);
    open.value = tabs[(place + by + tabs.length) % tabs.length].id;
    document.getElementById(`tab-${open.value}`)?.focus();
  };
  return (
    <aside class="left" aria-label="Controls">
      <div class="tabs" role="tablist" aria-label="Controls">
        {tabs.map(({ id, label, title }) => (
          <button
            key={id} id={`tab-${id}`} title={title} type="button" role="tab" aria-selected={id === tab.id}
            aria-controls="left-panel" tabIndex={id === tab.id ? 0 : -1}
            onClick={() => (open.value = id)}
            onKeyDown={(event) => {
              // With Alt, arrow keys rotate the view.
              if (event.altKey) return;
              if (event.key === 'ArrowRight') move(1);
              if (event.key === 'ArrowLeft') move(-1);
            }}
          >
            {label}
            {id === 'events' && bad > 0 && <span class="count">{bad}</span>}
          </button>
        ))}
      </div>
      <div class="panel" id="left-panel" role="tabpanel" aria-labelledby={`tab-${tab.id}`}>
        {(<tab.Panel />) as ComponentChildren}
      </div>
    </aside>
  );
}
