// The shown time. Live it is the present, or a held time of the last seconds. A recording uses the page's clock and
// requests states from the program (one request outstanding).
import { computed, signal } from '@preact/signals';
import { Latest } from '../connection/latest';
import type { State } from '../protocol/state';
import type { Mode } from '../protocol/types';
import type { History } from './history';

export interface PlaybackHost {
  history: History;
  ask_at(time: number): Promise<unknown>;
  show(state: State): void;
  failed(error: Error): void;
}

export const speeds = [0.1, 0.25, 0.5, 1, 2, 4, 8];
/** Live step: a sixtieth of a second, the rate of states. */
const live_step_s = 1 / 60;

export class Playback {
  readonly mode = signal<Mode>('live');
  readonly duration = signal(0);
  /** Step of time, s: for a recording the time between two of its states. */
  step_s = live_step_s;
  /** A recording is being played. */
  readonly playing = signal(false);
  readonly speed = signal(1);
  /** Time in the recording; live: the held time, null for the present. */
  readonly time = signal(0);
  readonly held = signal<number | null>(null);
  readonly running = computed(() => (this.mode.value === 'live' ? this.held.value === null : this.playing.value));
  private readonly asker: Latest<number>;
  private frame = 0;
  private before = 0;

  constructor(private readonly host: PlaybackHost) {
    this.asker = new Latest<number>((time) => host.ask_at(time), (_, error) => {
      // Errors of requests from before the rig replaced the recording are ignored.
      if (!error || this.mode.value !== 'recording') return;
      this.playing.value = false;
      host.failed(error);
    });
  }

  /** Starts at the beginning of another run or rig. */
  start(mode: Mode, duration: number, interval: number): void {
    this.pause();
    this.asker.forget();
    this.mode.value = mode;
    this.duration.value = duration;
    this.step_s = mode === 'recording' && interval > 0 ? interval : live_step_s;
    this.held.value = null;
    this.time.value = 0;
    if (mode === 'recording') this.asker.ask(0);
  }

  /** Requests the current time again after reconnecting. */
  again(): void {
    if (this.mode.value === 'recording') this.asker.ask(this.time.value);
  }

  toggle(): void {
    if (this.running.value) this.pause();
    else this.play();
  }

  play(): void {
    if (this.mode.value === 'live') return this.go_live();
    if (this.mode.value === 'pictures') return;
    if (this.time.value >= this.duration.value) this.time.value = 0;
    this.playing.value = true;
    this.before = performance.now();
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame(this.advance);
  }

  pause(): void {
    if (this.mode.value === 'live') {
      const newest = this.host.history.newest;
      if (newest && this.held.value === null) this.held.value = newest.time;
      return;
    }
    this.playing.value = false;
  }

  go_live(): void {
    this.held.value = null;
    const newest = this.host.history.newest;
    if (newest) this.host.show(newest);
  }

  /** Seeks to a time; live times are limited to the remembered ones. */
  seek(time: number): void {
    if (this.mode.value === 'live') return this.hold(time);
    if (this.mode.value === 'pictures') return;
    this.time.value = Math.min(this.duration.value, Math.max(0, time));
    this.asker.ask(this.time.value);
  }

  step(count: number): void {
    this.skip(count * this.step_s);
  }

  /** Pauses and moves by some seconds, forwards or back. */
  skip(seconds: number): void {
    this.pause();
    const now = this.mode.value === 'live' ? (this.held.value ?? 0) : this.time.value;
    this.seek(now + seconds);
  }

  faster(by: number): void {
    const place = speeds.indexOf(this.speed.value) + by;
    this.speed.value = speeds[Math.min(speeds.length - 1, Math.max(0, place))];
  }

  private hold(time: number): void {
    const { history } = this.host;
    const oldest = history.oldest;
    const newest = history.newest;
    if (!oldest || !newest) return;
    const drawn = Math.min(newest.time, Math.max(oldest.time, time));
    this.held.value = drawn;
    const state = history.at(drawn);
    if (state) this.host.show(state);
  }

  private advance = (now: number): void => {
    if (!this.playing.value) return;
    const time = this.time.value + ((now - this.before) / 1000) * this.speed.value;
    this.before = now;
    this.seek(time);
    if (time >= this.duration.value) this.playing.value = false;
    else this.frame = requestAnimationFrame(this.advance);
  };
}
