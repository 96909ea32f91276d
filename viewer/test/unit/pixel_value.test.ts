import { signal } from '@preact/signals';
import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { follow_pixel, grace_ms, type Pixel } from '../../src/panels/pixel_value';
import type { PixelResult } from '../../src/protocol/types';

/** Requests that the test answers explicitly. */
function made() {
  const waiting: ((result: PixelResult) => void)[] = [];
  const picture_of = new Map<string, { number: number }>();
  const host = {
    picture_tick: signal(0), epoch: signal(0), picture_of,
    link: { status: signal({ kind: 'open' }), request: () => new Promise<never>((resolve) => waiting.push(resolve as never)) },
  };
  const pixel = signal<Pixel | null>({ camera: 'front', u: 3, v: 4 });
  const value = signal<PixelResult | null>(null);
  return {
    host, pixel, value, waiting, stop: follow_pixel(host, pixel, value),
    show: (number: number): void => {
      picture_of.set('front', { number });
      host.picture_tick.value++;
    },
    answer: async (grey: number, number: number): Promise<void> => {
      waiting.shift()!({ value: [grey], bits: 8, label: '', depth: null, s: null, number });
      await vi.advanceTimersByTimeAsync(0);
    },
  };
}

beforeEach(() => void vi.useFakeTimers());
afterEach(() => void vi.useRealTimers());

test('it is asked for again with each new picture, one request at a time', async () => {
  const { show, answer, value, waiting } = made();
  expect(waiting).toHaveLength(0);
  show(1);
  await answer(10, 1);
  expect(value.value!.value).toEqual([10]);
  show(2);
  show(3);
  expect(waiting).toHaveLength(1);
  await answer(20, 2);
  expect(waiting).toHaveLength(1);
  await answer(30, 3);
  expect(value.value!.value).toEqual([30]);
  expect(waiting).toHaveLength(0);
});

test('a value of another picture than the shown one is not shown', async () => {
  const { show, answer, value } = made();
  show(1);
  await answer(20, 2);
  expect(value.value).toBeNull();
  show(2);
  expect(value.value!.value).toEqual([20]);
  show(3);
  await vi.advanceTimersByTimeAsync(grace_ms + 1);
  expect(value.value).toBeNull();
  await answer(30, 3);
  expect(value.value!.value).toEqual([30]);
});

test('an answer of a picture that never comes is asked for again', async () => {
  const { show, answer, value, waiting } = made();
  show(1);
  await answer(20, 2);
  await vi.advanceTimersByTimeAsync(1000);
  expect(waiting).toHaveLength(1);
  await answer(10, 1);
  expect(value.value!.value).toEqual([10]);
  await vi.advanceTimersByTimeAsync(1000);
  expect(waiting).toHaveLength(0);
});

test('nothing is known without a picture, of another run, or without a connection', async () => {
  const { host, show, answer, value, stop } = made();
  show(1);
  await answer(10, 1);
  host.epoch.value++;
  await vi.advanceTimersByTimeAsync(grace_ms + 1);
  expect(value.value).toBeNull();
  await answer(11, 1);
  expect(value.value!.value).toEqual([11]);
  host.link.status.value = { kind: 'lost' };
  expect(value.value).toBeNull();
  host.link.status.value = { kind: 'open' };
  host.picture_of.clear();
  host.picture_tick.value++;
  expect(value.value).toBeNull();
  stop();
});
