import { expect, test, vi } from 'vitest';
import type { State } from '../../src/protocol/state';
import { History } from '../../src/state/history';
import { Playback, speeds } from '../../src/state/playback';

/** A playback, its requested times, and a function that answers the outstanding request. */
function made() {
  const asked: number[] = [];
  const shown: State[] = [];
  const failed = vi.fn();
  const ends: { settle: (value?: unknown) => void; fail: (error: Error) => void }[] = [];
  const history = new History();
  const playback = new Playback({
    history,
    ask_at: (time) => {
      asked.push(time);
      return new Promise((settle, fail) => ends.push({ settle, fail }));
    },
    show: (state) => shown.push(state),
    failed,
  });
  const answered = async () => {
    ends.pop()!.settle();
    await Promise.resolve();
    await Promise.resolve();
  };
  const refused = async () => {
    ends.pop()!.fail(new Error('no such time'));
    await Promise.resolve();
    await Promise.resolve();
  };
  return { playback, history, asked, shown, failed, answered, refused };
}

test('of a recording the newest time is asked for, within its length', async () => {
  const { playback, asked, answered } = made();
  playback.start('recording', 10, 0.1);
  playback.seek(4);
  playback.seek(12);
  expect(playback.time.value).toBe(10);
  await answered();
  expect(asked).toEqual([0, 10]);
  playback.step(-2);
  expect(playback.time.value).toBeCloseTo(9.8, 12);
});

test('what was still to be asked of a recording is forgotten when the rig takes its place', async () => {
  const { playback, asked, answered } = made();
  playback.start('recording', 10, 0.1);
  playback.seek(4);
  playback.start('live', 0, 0);
  await answered();
  expect(asked).toEqual([0]);
});

test('a time that is refused pauses the recording that is shown, and no other', async () => {
  const { playback, failed, refused } = made();
  playback.start('recording', 10, 0.1);
  playback.playing.value = true;
  await refused();
  expect(playback.playing.value).toBe(false);
  expect(failed).toHaveBeenCalledTimes(1);
  playback.seek(4);
  playback.start('live', 0, 0);
  await refused();
  expect(failed).toHaveBeenCalledTimes(1);
});

test('live, an instant of those that are remembered is held, until it goes on', () => {
  const { playback, history, shown } = made();
  playback.start('live', 0, 0);
  for (let i = 0; i <= 60; ++i) history.add({ time: i / 60 } as State);
  playback.pause();
  expect(playback.held.value).toBe(1);
  playback.seek(0.5);
  expect(shown.at(-1)!.time).toBe(0.5);
  playback.seek(-3);
  expect(playback.held.value).toBe(0);
  playback.toggle();
  expect(playback.held.value).toBe(null);
  expect(shown.at(-1)!.time).toBe(1);
});

test('speeds end at the slowest and the fastest', () => {
  const { playback } = made();
  playback.faster(-100);
  expect(playback.speed.value).toBe(speeds[0]);
  playback.faster(100);
  expect(playback.speed.value).toBe(speeds.at(-1));
});
