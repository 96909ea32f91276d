/**
 * Sends the newest of what is asked and drops what came in between: one request is outstanding at a time, and the last
 * one asked is always sent. For sliders, the tip and the time of a recording.
 */
export class Latest<Value, Result = unknown> {
  private waiting: { value: Value } | null = null;
  private busy = false;

  constructor(
    private readonly send: (value: Value) => Promise<Result>,
    private readonly settled: (result: Result | null, error: Error | null, value: Value) => void = () => {},
  ) {}

  ask(value: Value): void {
    if (this.busy) {
      this.waiting = { value };
      return;
    }
    this.busy = true;
    this.send(value).then(
      (result) => this.done(result, null, value),
      (error: unknown) => this.done(null, error instanceof Error ? error : new Error(String(error)), value),
    );
  }

  /** Forgets what is waiting: for when it has become meaningless. */
  forget(): void {
    this.waiting = null;
  }

  private done(result: Result | null, error: Error | null, value: Value): void {
    this.busy = false;
    const next = this.waiting;
    this.waiting = null;
    if (next) this.ask(next.value);
    this.settled(result, error, value);
  }
}
