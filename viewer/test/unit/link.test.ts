// The link against the fake server, as in a browser: Node has fetch, and ws stands in for the browser's WebSocket.
import { afterEach, beforeEach, expect, test } from 'vitest';
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

async function until(what: () => boolean, ms = 6000): Promise<void> {
  const end = Date.now() + ms;
  while (!what()) {
    if (Date.now() > end) throw new Error('it did not happen');
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
}

function connect(token: () => string, patience?: Patience): Link {
  // ws takes the header that a browser's cookie would be.
  class WithToken extends WebSocket {
    constructor(address: string | URL) {
      super(address, { headers: { authorization: `Bearer ${token()}` } });
      // A browser's socket that fails, or is closed before it is open, ends nobody's program.
      this.on('error', () => {});
    }
  }
  Object.assign(globalThis, { WebSocket: WithToken });
  link = new Link(listener, { base: `http://127.0.0.1:${server.port}/`, token }, patience);
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

test('it comes back by itself after a restart, and sees another session', async () => {
  connect(() => server.token);
  await until(() => seen.hellos.length === 1);
  await server.restart(true);
  await until(() => seen.hellos.length === 2);
  expect(seen.hellos[0]).not.toBe(seen.hellos[1]);
  expect(seen.closed).toBe(1);
});

test('an old token is told as such, and not tried again', async () => {
  const old = server.token;
  const open = connect(() => old);
  await until(() => seen.hellos.length === 1);
  await server.restart(false);
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

test('a server that says nothing makes what is shown stale, within three seconds', async () => {
  const open = connect(() => server.token);
  await until(() => open.fresh.value);
  server.mute = true;
  await until(() => !open.fresh.value, 3000);
  server.mute = false;
  await until(() => open.fresh.value, 2000);
});

test('a network that goes away without a word ends no attempt for good', async () => {
  const open = connect(() => server.token, { quiet: 50, stale: 100, dead: 200, entry: 150 });
  await until(() => seen.hellos.length === 1);
  server.mute = server.deaf = true;
  // The connection is given up, then one attempt after the other that nobody answers.
  await until(() => open.status.value.kind === 'waiting');
  await until(() => open.status.value.kind === 'connecting');
  await until(() => open.status.value.kind === 'waiting', 2000);
  server.mute = server.deaf = false;
  await until(() => seen.hellos.length === 2);
  expect(open.status.value.kind).toBe('open');
});

test('a socket that nobody takes is given up, too', async () => {
  server.takes_sockets = false;
  const open = connect(() => server.token, { quiet: 50, stale: 100, dead: 200, entry: 150 });
  await until(() => open.status.value.kind === 'waiting', 2000);
  server.takes_sockets = true;
  await until(() => seen.hellos.length === 1);
});

test('of attempts that overlap, the last one alone has a socket', async () => {
  const open = connect(() => server.token);
  for (let i = 0; i < 5; ++i) void open.open();
  await until(() => seen.hellos.length === 1);
  await new Promise((resolve) => setTimeout(resolve, 300));
  expect(server.client_count).toBe(1);
  expect(seen.hellos).toHaveLength(1);
});
