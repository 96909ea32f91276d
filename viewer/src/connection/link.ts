// A WebSocket that reconnects by itself. The messages are interpreted in state/.
import { signal } from '@preact/signals';
import type { Reply, TextMessage } from '../protocol/types';
import { Backoff } from './backoff';
import { enter, type Entry } from './entry';

export type LinkStatus =
  | { kind: 'connecting' }
  | { kind: 'open' }
  /** Lost, or never connected; `at` is the time of the next attempt (performance.now). */
  | { kind: 'waiting'; at: number; why: string }
  /** The server is reachable but refuses access. */
  | { kind: 'refused'; why: string };

export interface LinkListener {
  text(message: TextMessage): void;
  bytes(message: ArrayBuffer): void;
  closed(): void;
  /** An error that belongs to no request. */
  failed(why: string): void;
}

export class RequestError extends Error {}

interface Waiting {
  resolve(result: unknown): void;
  reject(error: Error): void;
  timer: ReturnType<typeof setTimeout>;
}

/** Timeouts of the link, ms. */
export interface Patience {
  /** Without messages for this long, a ping is sent. */
  quiet: number;
  /** Without an answer for this long, the shown state is stale. */
  stale: number;
  /** Without messages for this long, the connection counts as lost, for example if the network failed silently. */
  dead: number;
  /** Timeout of the authentication and of opening the socket. */
  entry: number;
}

const usual_patience: Patience = { quiet: 700, stale: 2000, dead: 8000, entry: 5000 };
const request_ms = 15000;

export class Link {
  readonly status = signal<LinkStatus>({ kind: 'connecting' });
  /** The server answers: the shown state is current. */
  readonly fresh = signal(false);
  /** Time of the last message (performance.now), 0 before the first. */
  last_word = 0;
  private socket: WebSocket | null = null;
  private readonly waiting = new Map<number, Waiting>();
  private readonly backoff = new Backoff();
  private next_id = 1;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private pinging = false;
  /** Number of the connection attempt; results of earlier attempts are ignored. */
  private attempt = 0;
  private readonly watcher: ReturnType<typeof setInterval>;

  constructor(
    private readonly listener: LinkListener,
    private readonly entry: Entry,
    private readonly patience = usual_patience,
  ) {
    this.watcher = setInterval(() => this.watch(), 250);
  }

  /** Connects now, without waiting for the next attempt. */
  async open(): Promise<void> {
    const attempt = this.begin_anew();
    this.status.value = { kind: 'connecting' };
    const outcome = await enter(this.entry, this.patience.entry);
    if (attempt !== this.attempt) return;
    if (outcome.kind === 'refused') {
      this.status.value = { kind: 'refused', why: outcome.why };
      return;
    }
    if (outcome.kind === 'unreachable') return this.wait('The program does not answer.');
    this.dial();
  }

  /** Closes the connection for good. */
  stop(): void {
    clearInterval(this.watcher);
    this.begin_anew();
  }

  private begin_anew(): number {
    clearTimeout(this.timer);
    this.drop();
    return ++this.attempt;
  }

  /**
   * Sends a request and resolves with its result. Rejects with a RequestError with the server's message if it is
   * refused.
   */
  request<Result = unknown>(what: string, values: Record<string, unknown> = {}): Promise<Result> {
    const socket = this.socket;
    if (!socket || socket.readyState !== WebSocket.OPEN) {
      return Promise.reject(new RequestError('There is no connection to the program.'));
    }
    const id = this.next_id++;
    socket.send(JSON.stringify({ id, do: what, ...values }));
    return new Promise<Result>((resolve, reject) => {
      const timer = setTimeout(() => {
        this.waiting.delete(id);
        reject(new RequestError(`No answer to "${what}".`));
      }, request_ms);
      this.waiting.set(id, { resolve: resolve as (result: unknown) => void, reject, timer });
    });
  }

  /** Sends a message without a reply. */
  tell(what: string, values: Record<string, unknown>): void {
    if (this.socket?.readyState === WebSocket.OPEN) {
      this.socket.send(JSON.stringify({ id: this.next_id++, do: what, ...values }));
    }
  }

  private dial(): void {
    const address = new URL('socket', this.entry.base);
    address.protocol = address.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(address);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    let opened = false;
    this.timer = setTimeout(() => {
      this.drop();
      this.wait('The program does not answer.');
    }, this.patience.entry);
    socket.onopen = () => {
      opened = true;
      clearTimeout(this.timer);
      this.heard();
      this.status.value = { kind: 'open' };
    };
    socket.onmessage = ({ data }) => {
      this.heard();
      this.backoff.reset();
      if (typeof data === 'string') this.text(data);
      else this.listener.bytes(data as ArrayBuffer);
    };
    socket.onclose = ({ reason }) => {
      if (this.socket !== socket) return;
      this.drop();
      const lost = reason ? `The program closed the connection: ${reason}` : 'The connection was lost.';
      this.wait(opened ? lost : 'The program did not accept the connection.');
    };
  }

  private text(data: string): void {
    const message = JSON.parse(data) as TextMessage;
    if (message.type === 'reply') this.reply(message);
    else this.listener.text(message);
  }

  private reply({ id, result, error }: Reply): void {
    if (id === null) return this.listener.failed(error ?? 'Something failed.');
    const waiting = this.waiting.get(id);
    if (!waiting) return;
    this.waiting.delete(id);
    clearTimeout(waiting.timer);
    if (error !== undefined) waiting.reject(new RequestError(error));
    else waiting.resolve(result);
  }

  private heard(): void {
    this.last_word = performance.now();
    if (!this.fresh.value) this.fresh.value = true;
  }

  /** Without messages the rig may just be at rest: only an unanswered ping makes the shown state stale. */
  private watch(): void {
    if (this.status.value.kind !== 'open') return;
    const silence = performance.now() - this.last_word;
    if (silence > this.patience.dead) {
      this.drop();
      this.wait('No message from the program for several seconds.');
      return;
    }
    if (silence > this.patience.stale) this.fresh.value = false;
    if (silence > this.patience.quiet && !this.pinging) {
      this.pinging = true;
      this.request('ping').catch(() => {}).finally(() => (this.pinging = false));
    }
  }

  private wait(why: string): void {
    clearTimeout(this.timer);
    const delay = this.backoff.next();
    this.status.value = { kind: 'waiting', at: performance.now() + delay, why };
    this.timer = setTimeout(() => void this.open(), delay);
  }

  private drop(): void {
    const socket = this.socket;
    this.socket = null;
    this.fresh.value = false;
    this.pinging = false;
    if (socket) {
      socket.onclose = socket.onmessage = socket.onopen = null;
      socket.close();
      this.listener.closed();
    }
    for (const { reject, timer } of this.waiting.values()) {
      clearTimeout(timer);
      reject(new RequestError('The connection was lost before the answer came.'));
    }
    this.waiting.clear();
  }
}
