import { signal } from '@preact/signals';

/** The camera whose view is shown: null is the free view. */
export class Views {
  readonly current = signal<string | null>(null);

  constructor(private readonly cameras: () => string[]) {}

  free(): void {
    if (this.current.value !== null) this.current.value = null;
  }

  /** Selects the next or the previous view, cyclically. */
  cycle(by: 1 | -1): void {
    const all = [null, ...this.cameras()];
    const place = all.indexOf(this.current.value);
    this.current.value = all[(Math.max(0, place) + by + all.length) % all.length];
  }
}
