/**
 * Sends the newest request and drops those in between: one request is outstanding at a time, and the last one is always
 * sent. Used for sliders, the tip and the time of a recording.
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

  /** Drops the waiting request because it is obsolete. */
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
