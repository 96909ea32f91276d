import { signal } from '@preact/signals';

/** Through whose eyes one looks: null is the free view. */
export class Views {
  readonly current = signal<string | null>(null);

  constructor(private readonly cameras: () => string[]) {}

  free(): void {
    if (this.current.value !== null) this.current.value = null;
  }

  /** The next or the one before, round and round. */
  cycle(by: 1 | -1): void {
    const all = [null, ...this.cameras()];
    const place = all.indexOf(this.current.value);
    this.current.value = all[(Math.max(0, place) + by + all.length) % all.length];
  }
}
