/** How long to wait before the next attempt: a quarter of a second at first, doubled each time up to five. */
export class Backoff {
  private attempts = 0;

  constructor(
    private readonly first = 250,
    private readonly most = 5000,
    private readonly random: () => number = Math.random,
  ) {}

  /** Milliseconds; a fifth of it by chance, so that several pages do not come at once. */
  next(): number {
    const wait = Math.min(this.most, this.first * 2 ** this.attempts++);
    return wait * (0.9 + 0.2 * this.random());
  }

  reset(): void {
    this.attempts = 0;
  }
}
