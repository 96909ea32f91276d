import { use_app } from '../ui/app';
import { format_time } from '../ui/format';
import type { Level } from '../protocol/types';

const words: Record<Level, string> = { info: 'Note', warning: 'Warning', error: 'Error' };

/** List of events, newest first; a click seeks to the event. */
export function EventPanel() {
  const { viewer } = use_app();
  const marks = viewer.hello.value?.marks ?? [];
  const all = [...marks, ...viewer.events.value].sort((a, b) => b.time - a.time);
  if (!all.length) return <p class="empty">No events.</p>;
  return (
    <ol class="events">
      {all.map(({ time, level, name, text }, i) => (
        <li key={`${time} ${name} ${i}`} data-level={level}>
          <button type="button" title={`Shows ${format_time(time)}`} onClick={() => viewer.playback.seek(time)}>
            <time>{format_time(time)}</time>
            <span class="sr">{words[level]}:</span>
            <b>{name}</b>
            <span>{text}</span>
          </button>
        </li>
      ))}
    </ol>
  );
}
