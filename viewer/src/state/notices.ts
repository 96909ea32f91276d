import { signal } from '@preact/signals';

export interface Notice {
  id: number;
  level: 'info' | 'error';
  text: string;
  /** Number of consecutive repetitions. */
  times: number;
}

const shown_ms = { info: 4000, error: 9000 };

/** Temporary messages, mainly about refused requests. */
export class Notices {
  readonly list = signal<Notice[]>([]);
  private next = 1;
  private readonly timers = new Map<number, ReturnType<typeof setTimeout>>();

  error(what: unknown): void {
    this.say('error', what instanceof Error ? what.message : String(what));
  }

  info(text: string): void {
    this.say('info', text);
  }

  dismiss(id: number): void {
    clearTimeout(this.timers.get(id));
    this.timers.delete(id);
    this.list.value = this.list.value.filter((notice) => notice.id !== id);
  }

  private say(level: Notice['level'], text: string): void {
    // Without this a slider at a limit would fill the screen with one message.
    const same = this.list.value.find((notice) => notice.text === text && notice.level === level);
    if (same) {
      this.list.value = this.list.value.map((notice) =>
        notice === same ? { ...notice, times: notice.times + 1 } : notice,
      );
      return this.expire(same.id, level);
    }
    const id = this.next++;
    this.list.value = [...this.list.value.slice(-3), { id, level, text, times: 1 }];
    this.expire(id, level);
  }

  private expire(id: number, level: Notice['level']): void {
    clearTimeout(this.timers.get(id));
    this.timers.set(id, setTimeout(() => this.dismiss(id), shown_ms[level]));
  }
}
