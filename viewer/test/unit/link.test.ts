// The link with the fake server, as in a browser: Node provides fetch, and ws replaces the browser's WebSocket.
import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { WebSocket } from 'ws';
import { Link, RequestError, type LinkListener, type Patience } from '../../src/connection/link';
import { decode_state } from '../../src/protocol/state';
import { spatial_rig } from '../fake/rigs';
import { FakeServer } from '../fake/server';

let server: FakeServer;
let link: Link | null = null;
const seen: { hellos: string[]; states: number; closed: number } = { hellos: [], states: 0, closed: 0 };

const listener: LinkListener = {
  text: (message) => message.type === 'hello' && seen.hellos.push(message.session),
  bytes: (message) => {
    decode_state(message);
    seen.states++;
  },
  closed: () => seen.closed++,
  failed: () => {},
};

/** Waits for a condition. The long timeout only affects failing tests. */
const until = (what: () => boolean): Promise<true> => vi.waitUntil(what, { timeout: 40_000, interval: 10 });

/** A link with short timeouts. On a busy machine it may drop the connection and reconnect once more. */
const impatient: Patience = { quiet: 50, stale: 100, dead: 200, entry: 150 };

function connect(token: () => string, patience?: Patience): Link {
  // ws sends the token in a header; a browser would send its cookie.
  class WithToken extends WebSocket {
    constructor(address: string | URL) {
      super(address, { headers: { authorization: `Bearer ${token()}` } });
      // In a browser, a socket that fails or is closed before it is open does not end the program.
      this.on('error', () => {});
    }
  }
  Object.assign(globalThis, { WebSocket: WithToken });
  link = new Link(listener, { base: `http://127.0.0.1:${server.port}/`, token, settle: () => {} }, patience);
  void link.open();
  return link;
}

beforeEach(async () => {
  Object.assign(seen, { hellos: [], states: 0, closed: 0 });
  server = new FakeServer('.', spatial_rig());
  await server.start();
});

afterEach(async () => {
  link?.stop();
  await server.stop();
});

test('it comes in, is greeted, and states come', async () => {
  const open = connect(() => server.token);
  await until(() => seen.states > 3);
  expect(seen.hellos).toHaveLength(1);
  expect(open.status.value.kind).toBe('open');
  expect(open.fresh.value).toBe(true);
});

test('each request gets its own answer, and a refusal is an error with the server’s line', async () => {
  const open = connect(() => server.token);
  await until(() => seen.hellos.length === 1);
  const [point, pong] = await Promise.all([open.request<{ s: number }>('point', { s: 0.25 }), open.request('ping')]);
  expect(point.s).toBe(0.25);
  expect(pong).toEqual({});
  await expect(open.request('dance')).rejects.toThrow('no request is called "dance"');
  await expect(open.request('dance')).rejects.toBeInstanceOf(RequestError);
});

test('it comes back after a restart with the new token, and sees another session', async () => {
  connect(() => server.token);
  await until(() => seen.hellos.length === 1);
  await server.restart();
  await until(() => seen.hellos.length === 2);
  expect(seen.hellos[0]).not.toBe(seen.hellos[1]);
  expect(seen.closed).toBe(1);
});

test('an old token is told as such, and not tried again', async () => {
  const old = server.token;
  const open = connect(() => old);
  await until(() => seen.hellos.length === 1);
  await server.restart();
  await until(() => open.status.value.kind === 'refused');
  expect(open.status.value).toMatchObject({ why: expect.stringMatching(/token/) as string });
});

test('what was asked when the connection went is refused, not forgotten', async () => {
  const open = connect(() => server.token);
  await until(() => seen.hellos.length === 1);
  server.mute = true;
  const answer = open.request('ping');
  void server.stop();
  await expect(answer).rejects.toThrow(/lost/);
  await expect(open.request('ping')).rejects.toThrow(/no connection/);
});

test('a server that says nothing makes what is shown stale, until it speaks again', async () => {
  const open = connect(() => server.token);
  await until(() => open.fresh.value);
  server.mute = true;
  await until(() => !open.fresh.value);
  server.mute = false;
  await until(() => open.fresh.value);
});

test('a network that goes away without a word ends no attempt for good', async () => {
  const open = connect(() => server.token, impatient);
  await until(() => seen.hellos.length >= 1);
  const gone_through: string[] = [];
  open.status.subscribe(({ kind }) => gone_through.push(kind));
  server.mute = server.deaf = true;
  // The connection is dropped, then several attempts remain unanswered.
  await until(() => gone_through.filter((kind) => kind === 'waiting').length >= 3);
  const before = seen.hellos.length;
  server.mute = server.deaf = false;
  await until(() => seen.hellos.length > before && open.status.value.kind === 'open');
});

test('a socket that nobody takes is given up, too', async () => {
  server.takes_sockets = false;
  const open = connect(() => server.token, impatient);
  await until(() => open.status.value.kind === 'waiting');
  server.takes_sockets = true;
  await until(() => seen.hellos.length >= 1);
});

test('of attempts that overlap, the last one alone has a socket', async () => {
  const open = connect(() => server.token);
  for (let i = 0; i < 5; ++i) void open.open();
  await until(() => seen.hellos.length === 1);
  await new Promise((resolve) => setTimeout(resolve, 300));
  expect(server.client_count).toBe(1);
  expect(seen.hellos).toHaveLength(1);
});

test('what is shown is stale within three seconds of the last word', async () => {
  vi.useFakeTimers();
  try {
    const sockets: Record<'onopen' | 'onmessage', (event?: unknown) => void>[] = [];
    class Silent {
      static readonly OPEN = 1;
      readonly readyState = 1;
      constructor() {
        sockets.push(this as never);
      }
      send(): void {}
      close(): void {}
    }
    vi.stubGlobal('WebSocket', Silent);
    vi.stubGlobal('fetch', () => Promise.resolve({ status: 404 }));
    link = new Link(listener, { base: 'http://127.0.0.1:1/', token: () => 'a'.repeat(32), settle: () => {} });
    await link.open();
    sockets[0].onopen();
    await vi.advanceTimersByTimeAsync(1900);
    expect(link.fresh.value).toBe(true);
    await vi.advanceTimersByTimeAsync(1100);
    expect(link.fresh.value).toBe(false);
    expect(link.status.value.kind, 'not taken for dead yet').toBe('open');
    sockets[0].onmessage({ data: '{"type":"hello","session":"1"}' });
    expect(link.fresh.value).toBe(true);
    await vi.advanceTimersByTimeAsync(9000);
    expect(link.status.value.kind, 'dead').not.toBe('open');
  } finally {
    link?.stop();
    vi.unstubAllGlobals();
    vi.useRealTimers();
  }
});
