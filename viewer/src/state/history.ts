import type { State } from '../protocol/state';

/** The states of the last seconds, for looking back while the rig continues. */
export class History {
  private states: State[] = [];
  /** When each state's time was received first, ms of this page's clock. */
  private came: number[] = [];
  private from = 0;

  constructor(readonly seconds = 60) {}

  /** Adds the newest state, received at `now`. Drops old states, and all of them if time went back (a reset). */
  add(state: State, now = performance.now()): void {
    const last = this.newest;
    if (last && state.time < last.time) this.clear();
    if (last && state.time === last.time) this.states.pop();
    else this.came.push(now);
    this.states.push(state);
    while (this.states[this.from].time < state.time - this.seconds) ++this.from;
    // Dropped in bulk: shifting an array with every state would copy it sixty times a second.
    if (this.from > 1000) {
      this.states.splice(0, this.from);
      this.came.splice(0, this.from);
      this.from = 0;
    }
  }

  clear(): void {
    this.states = [];
    this.came = [];
    this.from = 0;
  }

  get newest(): State | undefined {
    return this.states[this.states.length - 1];
  }

  get oldest(): State | undefined {
    return this.states[this.from];
  }

  get count(): number {
    return this.states.length - this.from;
  }

  at_index(i: number): State {
    return this.states[this.from + i];
  }

  /** Returns the index of the last state that is not after the time; 0 if all are. */
  index_at(time: number): number {
    let low = 0;
    let high = this.count - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.at_index(middle).time <= time) low = middle;
      else high = middle - 1;
    }
    return Math.max(0, low);
  }

  /**
   * Returns how long ago, s, the first state after `time` was received; 0 if there is none. Runs may be faster than the
   * clock.
   */
  outdated_for(time: number, now = performance.now()): number {
    const place = this.index_at(time);
    const next = this.count && this.at_index(place).time > time ? place : place + 1;
    return next < this.count ? (now - this.came[this.from + next]) / 1000 : 0;
  }

  at(time: number): State | undefined {
    return this.count ? this.at_index(this.index_at(time)) : undefined;
  }
}
