import { signal } from '@preact/signals';
import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { picture_grace_ms, Measured } from '../../src/state/measured';
import { Seeing } from '../../src/state/seeing';

interface Asked {
  what: string;
  values: Record<string, unknown>;
  resolve(result: unknown): void;
  reject(error: Error): void;
}

/** Requests that the test answers explicitly. */
function made(cameras = ['front', 'side'], wanted: string[] = ['axis']) {
  const waiting: Asked[] = [];
  const picture_of = new Map<string, { number: number }>();
  const host = {
    picture_tick: signal(0), epoch: signal(0), picture_of,
    scene: signal<{ cameras: { name: string }[] } | null>({ cameras: cameras.map((name) => ({ name })) }),
    link: {
      status: signal({ kind: 'open' }),
      request: (what: string, values: Record<string, unknown>) =>
        new Promise<never>((resolve, reject) => waiting.push({ what, values, resolve: resolve as never, reject })),
    },
  };
  const overlays = signal(wanted);
  const measured = new Measured();
  const seeing = new Seeing();
  const finding = signal<string | null>(null);
  const stop = measured.start(host, overlays, seeing, finding);
  return {
    seeing, finding, host, overlays, measured, waiting, stop,
    show: (camera: string, number: number): void => {
      picture_of.set(camera, { number });
      host.picture_tick.value++;
    },
    answer: async (values: Record<string, unknown>): Promise<void> => {
      waiting.shift()!.resolve({ found: true, reason: '', notes: [], layers: [], ...values });
      await vi.advanceTimersByTimeAsync(0);
    },
    of: (camera: string) => measured.pictures.value[camera].value,
  };
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

test('each picture is measured for what is to be seen, the newest only', async () => {
  const { show, waiting, answer, of } = made();
  expect(waiting).toHaveLength(0);
  show('front', 1);
  expect(waiting.map(({ what, values }) => [what, values])).toEqual([['measure', { camera: 'front', layers: ['axis'] }]]);
  show('front', 2);
  show('front', 3);
  expect(waiting).toHaveLength(1);
  await answer({ number: 1 });
  expect(of('front')?.number).toBe(1);
  expect(waiting).toHaveLength(1);
  await answer({ number: 3 });
  expect(of('front')?.number).toBe(3);
  expect(waiting).toHaveLength(0);
  await vi.advanceTimersByTimeAsync(10 * picture_grace_ms);
  expect(of('front')?.number).toBe(3);
  expect(of('side')).toBeNull();
});

test('nothing is asked where nothing is to be seen, and nothing stays where it was', async () => {
  const { show, waiting, answer, overlays, of } = made(['front'], []);
  show('front', 1);
  expect(waiting).toHaveLength(0);
  overlays.value = ['mask', 'axis'];
  expect(waiting[0].values.layers).toEqual(['mask', 'axis']);
  await answer({ number: 1 });
  expect(of('front')).not.toBeNull();
  overlays.value = [];
  expect(of('front')).toBeNull();
});

test('what was measured in an older picture does not stay', async () => {
  const { show, answer, of, waiting } = made();
  show('front', 1);
  await answer({ number: 1 });
  show('front', 2);
  expect(of('front')?.number).toBe(1);
  await vi.advanceTimersByTimeAsync(picture_grace_ms + 1);
  expect(of('front')).toBeNull();
  waiting.shift()!.reject(new Error('no'));
  await vi.advanceTimersByTimeAsync(0);
  expect(of('front')).toBeNull();
});

test('of another run, or without a connection, nothing is known', async () => {
  const { host, show, answer, of } = made();
  show('front', 1);
  host.epoch.value++;
  await answer({ number: 1 });
  expect(of('front')).toBeNull();
  await answer({ number: 1 });
  expect(of('front')).not.toBeNull();
  host.link.status.value = { kind: 'lost' };
  expect(of('front')).toBeNull();
});

test('the shape needs the pictures of both cameras', async () => {
  const { show, waiting, answer, measured, stop } = made(['front', 'side'], ['shape']);
  show('front', 1);
  expect(waiting).toHaveLength(0);
  show('side', 7);
  expect(waiting.map(({ what }) => what)).toEqual(['shape']);
  await answer({ numbers: [1, 7], poses: [] });
  expect(measured.shape.value?.numbers).toEqual([1, 7]);
  stop();
  expect(measured.shape.value).toBeNull();
  const alone = made(['front'], ['shape']);
  alone.show('front', 1);
  expect(alone.waiting).toHaveLength(0);
});

test('a changed region is measured at once, in the same picture', async () => {
  const { show, waiting, answer, seeing, of } = made(['front', 'side'], ['axis', 'shape']);
  show('front', 1);
  show('side', 1);
  await answer({ number: 1 });
  seeing.set('front', { region: [[0, 0], [9, 9]] });
  const asked = waiting.filter(({ what }) => what === 'measure');
  expect(asked.at(-1)!.values).toEqual({ camera: 'front', layers: ['axis'], seeing: { region: [[0, 0], [9, 9]] } });
  for (const one of waiting.splice(0)) one.resolve({ found: false, reason: 'nothing', notes: [], number: 1, layers: [] });
  await vi.advanceTimersByTimeAsync(0);
  expect(of('front')?.reason).toBe('nothing');
  expect(waiting.filter(({ what }) => what === 'shape').map(({ values }) => values)).toEqual([{ seeing: [{ camera: 'front', region: [[0, 0], [9, 9]] }] }]);
});

test('whoever says where the arm is sees its axis', () => {
  const { show, waiting, finding } = made(['front'], []);
  show('front', 1);
  expect(waiting).toHaveLength(0);
  finding.value = 'front';
  expect(waiting.map(({ values }) => values)).toEqual([{ camera: 'front', layers: ['axis'] }]);
});
