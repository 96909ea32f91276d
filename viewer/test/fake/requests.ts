// Replies of the fake rig to each request of the protocol.
import { cord_angles_of, archings_of } from '../../src/math/planar';
import { point_at } from '../../src/math/arc';
import type { Corner, SeeingChoice } from '../../src/protocol/types';
import type { Bends } from './arm';
import type { PointInPicture } from './picture';
import type { FakeSession } from './session';

export interface Client {
  send(text: string): void;
  push(bytes: Buffer): void;
  /** Pictures per second of each camera; 0 for none. */
  rates: Map<string, number>;
  /** Time in the recording, s. */
  time: number;
  /** The last picture sent for each camera. */
  sent: Map<string, SentPicture>;
}

export interface SentPicture {
  number: number;
  pixels: Uint8Array;
  /** Image points of the backbone. */
  points: PointInPicture[];
}

type Request = Record<string, unknown> & { do: string };
type Answer = Record<string, unknown> | Promise<Record<string, unknown>>;

export interface Hub {
  session: FakeSession;
  greet_all(): void;
  broadcast(message: Record<string, unknown>): void;
}

const moving = ['arm', 'tip', 'head', 'stage', 'halt', 'reset', 'run'];

export function answer(hub: Hub, client: Client, request: Request): Answer {
  const { session } = hub;
  if (session.mode === 'recording' && moving.includes(request.do)) throw new Error('this is a recording, in which nothing can be moved');
  const handle = handlers[request.do];
  if (!handle) throw new Error(`no request is called "${request.do}"`);
  return handle(hub, request, client) ?? {};
}

function bends_of(session: FakeSession, request: Request): Bends {
  if (request.bends) return request.bends as Bends;
  if (request.archings) return (request.archings as number[]).map((b) => [-2 * b, 0]);
  if (request.cord_angles) return archings_of(request.cord_angles as number[]).map((b) => [-2 * b, 0]);
  if (request.tendons) return session.arm.from_tendons(request.tendons as number[]);
  throw new Error('one of bends, cord_angles, archings and tendons is needed');
}

function camera_of(session: FakeSession, request: Request): number {
  const i = session.rig.scene.cameras.findIndex(({ name }) => name === request.camera);
  if (i < 0) throw new Error(`no camera is called "${String(request.camera)}"`);
  return i;
}

function layers_of({ pixels, points }: SentPicture, width: number): { id: string; [key: string]: unknown }[] {
  const inside = points.filter(({ u }) => u > 0 && u < width);
  const along = (side: number) => inside.map(({ u, v, radius }) => [u + side * radius, v]);
  const rows = Array.from({ length: pixels.length / width }, (_, v) => {
    const row = Array.from(pixels.subarray(v * width, (v + 1) * width), (value) => value < 128);
    return [v, row.indexOf(true), row.lastIndexOf(true)];
  }).filter(([, from]) => from >= 0);
  const middle = inside[inside.length >> 1] ?? { u: 0, v: 0 };
  return [
    { id: 'mask', kind: 'runs', rows },
    { id: 'silhouette', kind: 'polyline', points: along(1) },
    { id: 'silhouette', kind: 'polyline', points: along(-1) },
    { id: 'axis', kind: 'polyline', points: along(0) },
    { id: 'circle', kind: 'ellipse', center: [middle.u, middle.v], axes: [60, 60], angle: 0 },
    { id: 'markers', kind: 'points', points: along(0).filter((_, i) => i % 50 === 25) },
  ];
}

/** Returns whether a point is within the bounds of a region. */
function is_between({ u, v }: PointInPicture, region: Corner[]): boolean {
  const [us, vs] = [region.map(([x]) => x), region.map(([, y]) => y)];
  return u >= Math.min(...us) && u <= Math.max(...us) && v >= Math.min(...vs) && v <= Math.max(...vs);
}

const handlers: Record<string, (hub: Hub, request: Request, client: Client) => Answer | void> = {
  arm: ({ session }, request) => session.arm.command(bends_of(session, request), request.stretches as number[] | undefined),
  tip: ({ session }, request) => {
    const result = session.arm.inverse(request.position as number[]);
    session.arm.command(result.bends);
    return { ...result };
  },
  head: ({ session }, request) => {
    const head = session.heads[camera_of(session, request)];
    for (const axis of ['pan', 'tilt', 'zoom'] as const) if (typeof request[axis] === 'number') head[axis] = request[axis];
  },
  stage: ({ session }, request) => {
    camera_of(session, request);
    ['x', 'y', 'z'].forEach((axis, i) => typeof request[axis] === 'number' && (session.stage[i] = request[axis] as number));
  },
  halt: ({ session }) => session.halt(),
  reset: ({ session }) => session.reset(),
  run: (hub) => {
    const { session } = hub;
    if (session.running) throw new Error('a run of tasks is active');
    session.reset();
    session.running = session.time;
    const timer = setInterval(() => {
      if (!session.running) {
        clearInterval(timer);
        return hub.broadcast({ type: 'progress', done: true, outcome: 'cancelled', text: 'it was stopped at 1 s' });
      }
      hub.broadcast({ type: 'progress', what: session.rig.controls.tasks[0].name, fraction: session.share() });
      if (session.share() < 1) return;
      clearInterval(timer);
      session.running = 0;
      session.has_recording = true;
      hub.broadcast({ type: 'event', time: session.time, level: 'info', name: 'done', text: 'the tasks are done' });
      hub.broadcast({ type: 'progress', done: true, outcome: 'done', text: 'The tasks are done.' });
    }, 100);
    return { folder: 'results/0001' };
  },
  cancel: ({ session }) => session.halt(),
  open: (hub) => {
    hub.session.mode = 'recording';
    hub.greet_all();
  },
  live: (hub) => {
    hub.session.mode = 'live';
    hub.greet_all();
  },
  at: ({ session }, request, client) => {
    const time = Math.min(session.duration, Math.max(0, request.time as number));
    if (session.mode !== 'recording') throw new Error('only a recording can be asked for a time');
    client.time = time;
    client.push(session.state(time));
    return { time };
  },
  images: ({ session }, request, client) => {
    camera_of(session, request);
    client.rates.set(request.camera as string, request.rate as number);
  },
  pixel: ({ session }, request, client) => {
    const { width } = session.rig.scene.cameras[camera_of(session, request)];
    const sent = client.sent.get(request.camera as string);
    if (!sent) throw new Error('no picture was sent yet');
    const value = sent.pixels[(request.v as number) * width + (request.u as number)];
    return { value: [value], bits: 8, label: 'section 2', depth: 2.58, s: 0.41, number: sent.number };
  },
  measure: ({ session }, request, client) => {
    const { width } = session.rig.scene.cameras[camera_of(session, request)];
    const sent = client.sent.get(request.camera as string);
    if (!sent) throw new Error('no picture was sent yet');
    const wanted = request.layers as string[];
    const { region } = (request.seeing ?? {}) as SeeingChoice;
    const shown = region ? { ...sent, points: sent.points.filter((point) => is_between(point, region)) } : sent;
    if (!shown.points.length) return { found: false, reason: 'the region shows no arm', notes: [], number: sent.number, layers: [] };
    return {
      found: true, reason: '', notes: [], number: sent.number,
      layers: layers_of(shown, width).filter(({ id }) => wanted.includes(id)),
    };
  },
  color: ({ session }, request) => {
    if (session.rig.scene.cameras[camera_of(session, request)].channels === 1) throw new Error('the picture is gray and has no colour');
    return { color: [52, 52, 52], number: 0 };
  },
  shape: ({ session }, _, client) => {
    const rows = Array.from(session.arm.samples());
    return {
      found: true, reason: '', notes: ['one camera sees little of the arm'], numbers: [...client.sent.values()].map(({ number }) => number),
      poses: Array.from({ length: rows.length / 8 }, (_row, i) => rows.slice(8 * i + 1, 8 * i + 8)), sigma: 1.2e-4, rms_px: 0.08,
    };
  },
  point: ({ session }, request) => {
    const { plane, ...point } = point_at(session.arm.samples(), request.s as number);
    let end = 0;
    const section = session.rig.scene.arm.sections.findIndex(({ length }) => point.s <= (end += length));
    return { ...point, bending_plane: plane, section };
  },
  backbone: ({ session }, request) => ({ poses: session.arm.samples(request.bends as Bends) }),
  ping: () => ({}),
  // For tests only: the rig's state and its cord angles.
  test_state: ({ session }) => ({
    time: session.time, bends: session.arm.bends, target: session.arm.target,
    cord_angles: cord_angles_of(session.arm.bends.map(([x]) => -x / 2)),
    heads: session.heads, tip: session.arm.tip(session.arm.bends),
  }),
};
