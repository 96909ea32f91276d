import { use_app } from './app';
import { Icon } from './Icon';

/** Temporary messages. The live regions always exist, so that screen readers announce new content. */
export function NoticeList() {
  const { notices } = use_app().viewer;
  const list = (level: 'error' | 'info') =>
    notices.list.value.filter((notice) => notice.level === level).map(({ id, text, times }) => (
      <div key={id} class="notice" data-level={level}>
        <span>{text}{times > 1 && <b class="times"> ×{times}</b>}</span>
        <button type="button" class="button quiet square" aria-label="Dismiss" title="Dismiss" onClick={() => notices.dismiss(id)}>
          <Icon name="close" />
        </button>
      </div>
    ));
  return (
    <div class="notices">
      <div role="alert">{list('error')}</div>
      <div role="status">{list('info')}</div>
    </div>
  );
}
