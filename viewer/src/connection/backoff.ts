/** Delay before the next attempt: a quarter of a second at first, doubled each time up to five seconds. */
export class Backoff {
  private attempts = 0;

  constructor(
    private readonly first = 250,
    private readonly most = 5000,
    private readonly random: () => number = Math.random,
  ) {}

  /** Returns the delay, ms; a fifth of it is random, so that several pages do not reconnect at once. */
  next(): number {
    const wait = Math.min(this.most, this.first * 2 ** this.attempts++);
    return wait * (0.9 + 0.2 * this.random());
  }

  reset(): void {
    this.attempts = 0;
  }
}
