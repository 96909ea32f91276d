// Recordings: scrubbing, playback, plots, marks; with the fake server, and with a recording of `flexura run`.
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { beforeAll, describe, expect, test } from 'vitest';
import { planar_rig } from '../fake/rigs';
import type { FakeServer } from '../fake/server';
import { legends, server_state, slide, stage_at_rest, until } from './browser';
import { faked, opened_before, recorded, started, type Served } from './opened';
import { program } from './program';

const file = fileURLToPath(new URL('recording.toml', import.meta.url));
let page: Page;
let complaints: string[];

/** Opens the page of the group, stored in the variables above. */
function on(start: () => Promise<Served>, kind: 'recording' | 'live'): void {
  const opened = opened_before(start, kind);
  beforeAll(() => {
    ({ page, complaints } = opened);
  });
}

const shown_time = () => page.evaluate(() =>
  (globalThis as unknown as { flexura: { shown(): { time: number } } }).flexura.shown().time);
const stage = () => stage_at_rest(page);

/** Returns the first channel of the front camera's lossless picture at a time, from the server. */
async function served_picture(of: Page, at: number): Promise<{ width: number; height: number; values: Buffer }> {
  const { text, ...size } = await of.evaluate(async (time) => {
    const answer = await fetch(`image/front.png?time=${time}`);
    const bitmap = await createImageBitmap(await answer.blob());
    const { width, height } = bitmap;
    const context = new OffscreenCanvas(width, height).getContext('2d')!;
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, width, height);
    // As one text, because an array of numbers is slow to transfer.
    let text = '';
    for (let i = 0; i < data.length; i += 4) text += String.fromCharCode(data[i]);
    return { width, height, text };
  }, at);
  return { ...size, values: Buffer.from(text, 'latin1') };
}

/**
 * Tests for any recording of 6 s whose second task, `back`, starts at 4 s. The shown time is at most `a_state` s before
 * the requested one; `interval` s is one step.
 */
function recording_tests(a_state: number, interval: number, title: string): void {
  test('scrubbing shows the states of the times, forwards and back', async () => {
    const start = await stage();
    for (const time of [3.5, 1.25, 5]) {
      await slide(page, '#scrub', time);
      await until(async () => Math.abs((await shown_time()) - time) < a_state);
      expect(await page.locator('#clock').textContent()).toBeTruthy();
    }
    expect((await stage()).equals(start)).toBe(false);
    await slide(page, '#scrub', 0);
    await until(async () => (await shown_time()) === 0);
  });

  test('it plays at its speed, pauses, and stops at the end', async () => {
    await slide(page, '#scrub', 1);
    await page.keyboard.press('+');
    expect(await page.locator('select[aria-label="Speed"]').inputValue()).toBe('2');
    await page.keyboard.press('Space');
    await until(async () => (await shown_time()) > 1.5);
    await page.keyboard.press('Space');
    await until(async () => (await page.getByRole('button', { name: 'Play', exact: true }).count()) === 1);
    // States on their way when it was paused still come.
    await until(async () => {
      const before = await shown_time();
      await page.waitForTimeout(300);
      return (await shown_time()) === before;
    });
    await slide(page, '#scrub', 5.6);
    await page.keyboard.press('Space');
    await until(async () => (await page.getByRole('button', { name: 'Play', exact: true }).count()) === 1 && (await shown_time()) === 6);
  });

  test('steps go both ways', async () => {
    await slide(page, '#scrub', 2);
    await until(async () => Math.abs((await shown_time()) - 2) < a_state);
    const before = await shown_time();
    await page.keyboard.press('ArrowRight');
    await until(async () => Math.abs((await shown_time()) - before - interval) < 1e-6);
    await page.keyboard.press('ArrowLeft');
    await until(async () => (await shown_time()) === before);
  });

  test('pictures follow the time', async () => {
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000);
    await slide(page, '#scrub', 0);
    const camera = page.locator('.picture canvas').first();
    const said = page.locator('.camera figcaption span').first();
    await until(async () => (await said.textContent()) === '0.00 s');
    const before = await camera.screenshot();
    await slide(page, '#scrub', 4);
    await until(async () => (await said.textContent()) === '4.00 s');
    expect((await camera.screenshot()).equals(before)).toBe(false);
  });

  test('under a pointer that rests, the pixel’s value goes with the picture', async () => {
    await slide(page, '#scrub', 0);
    const [first, second] = await Promise.all([0, 4].map((time) => served_picture(page, time)));
    const differs = (u: number, v: number): boolean => {
      const i = v * first.width + u;
      return Math.abs((first.values[i] ?? 0) - (second.values[i] ?? 0)) > 40;
    };
    const camera = page.locator('.picture canvas').first();
    const box = (await camera.boundingBox())!;
    // The neighbours must differ as well, because the pointer position is coarser than the picture's pixels.
    const reach = Math.floor(first.width / box.width);
    const around = [-reach, 0, reach];
    const places = Array.from(first.values, (_, i) => [i % first.width, Math.floor(i / first.width)]);
    const place = places.find(([u, v]) => around.every((du) => around.every((dv) => differs(u + du, v + dv))))!;
    await page.mouse.move(box.x + ((place[0] + 0.5) / first.width) * box.width, box.y + ((place[1] + 0.5) / first.height) * box.height);
    const said = page.locator('.pixel dd');
    const [, u, v] = /\((\d+), (\d+)\)/.exec((await said.first().textContent())!)!.map(Number);
    const values = new Set<string>();
    for (const { time, picture } of [{ time: 0, picture: first }, { time: 4, picture: second }, { time: 0, picture: first }]) {
      await slide(page, '#scrub', time);
      const wanted = `${picture.values[v * picture.width + u]} of 255`;
      await until(async () => (await said.nth(1).textContent()) === wanted, 8000, `at ${time} s it is ${wanted}`);
      values.add(wanted);
    }
    expect(values.size).toBe(2);
    await page.mouse.move(box.x - 200, box.y);
  });

  test('no label lies upon a band of the timeline, or upon another', async () => {
    const rects = (selector: string) => page.locator(selector).evaluateAll((marks) => marks.map((mark) => {
      const { left, right, top, bottom } = mark.getBoundingClientRect();
      return { left, right, top, bottom };
    }));
    const labels = await rects('.mark[data-level="info"]');
    const bands = await rects('.mark:not([data-level="info"])');
    expect(labels.length).toBeGreaterThan(1);
    labels.forEach((one, i) => labels.slice(i + 1).forEach((other) =>
      expect(one.right <= other.left + 0.5 || other.right <= one.left + 0.5, 'two labels').toBe(true)));
    for (const band of bands) {
      for (const label of labels) expect(label.top >= band.bottom || band.top >= label.bottom).toBe(true);
      expect(band.bottom).toBeLessThanOrEqual(720);
      expect(band.right - band.left).toBeGreaterThanOrEqual(5);
    }
    if (title !== 'A recording') expect(bands.length).toBeGreaterThan(0);
  });

  test('marks stand on the timeline and go to their time', async () => {
    const mark = page.locator('.mark').filter({ hasText: 'back' });
    await mark.click();
    await until(async () => Math.abs((await shown_time()) - 4) < a_state);
    const [mark_box, rail] = [(await mark.boundingBox())!, (await page.locator('.rail').boundingBox())!];
    expect((mark_box.x - rail.x) / rail.width).toBeCloseTo(4 / 6, 1);
  });

  test('nothing moves here: the sliders are off', async () => {
    expect(await page.locator('.section .slider input').first().isDisabled()).toBe(true);
    expect(await page.getByRole('button', { name: 'Run tasks' }).count()).toBe(0);
  });

  test('the report opens from the page', async () => {
    const [opened] = await Promise.all([page.context().waitForEvent('page'), page.getByRole('link', { name: 'Report' }).click()]);
    await opened.waitForLoadState();
    expect(await opened.title()).toContain(title);
    await opened.close();
  });

  test('the browser had nothing to complain of', () => {
    expect(complaints).toEqual([]);
  });
}

describe('a recording', () => {
  const a_state = 1e-6;
  let server: FakeServer;
  on(async () => (server = await faked(planar_rig(), 'recording')), 'recording');

  test('one request for a time is outstanding at a time, and the last time asked for is reached', async () => {
    server.log.length = 0;
    server.delay_ms = 600;
    server.most_outstanding = 0;
    for (let i = 0; i < 30; ++i) await slide(page, '#scrub', (6 * i) / 29);
    await until(async () => Math.abs((await shown_time()) - 6) < 1e-6);
    server.delay_ms = 0;
    const asked = server.log.filter((request) => request.do === 'at').map((request) => request.time as number);
    expect(server.most_outstanding).toBe(1);
    expect(asked.length).toBeLessThan(30);
    expect(asked.at(-1)).toBe(6);
  });

  test('plots show what the recording knows, with one cursor for both', async () => {
    const legend = page.locator('.legend').first();
    await until(async () => /x .*\d/.test((await legend.textContent()) ?? ''));
    const before = await legend.textContent();
    const box = (await page.locator('.chart .u-over').first().boundingBox())!;
    await page.mouse.move(box.x + 20, box.y + 30);
    await until(async () => (await legend.textContent()) !== before);
    expect(await page.locator('.rail .hover').count()).toBe(1);
    const other = page.locator('.chart .u-cursor-x').nth(1);
    await until(async () => (await other.boundingBox()) !== null);
    await page.mouse.click(box.x + box.width / 2, box.y + 30);
    await until(async () => Math.abs((await shown_time()) - 3) < 0.1);
  });

  test('the legends show every name, those of eight sections too', async () => {
    const shown = await legends(page);
    expect(Math.max(...shown.map(({ names }) => names))).toBe(8);
    for (const { names, seen } of shown) expect(seen).toBe(names);
  });

  test('to the rig there is a way where there is a rig', async () => {
    const to_the_rig = page.getByRole('button', { name: 'To the rig' });
    expect(await to_the_rig.count()).toBe(1);
    server.session.has_rig = false;
    server.greet_all();
    await until(async () => (await to_the_rig.count()) === 0);
    server.session.has_rig = true;
    server.greet_all();
    await until(async () => (await to_the_rig.count()) === 1);
  });

  test('a band is as long as what it tells of; what takes no time is a tick', async () => {
    const of = async (level: string) => {
      const mark = page.locator(`.mark[data-level="${level}"]`);
      const { x, width } = (await mark.boundingBox())!;
      return { mark, x, width, color: await mark.evaluate((button) => getComputedStyle(button).backgroundColor) };
    };
    const line = (await page.locator('.line').boundingBox())!;
    const [warning, error] = [await of('warning'), await of('error')];
    expect(warning.x).toBeCloseTo(line.x + (2.5 / 6) * line.width, 0);
    expect(warning.width).toBeCloseTo((0.2 / 6) * line.width, 0);
    expect(error.x).toBeCloseTo(line.x + (5 / 6) * line.width, 0);
    expect(error.width).toBe(5);
    expect(error.color).not.toBe(warning.color);
    for (const [{ mark }, time] of [[warning, 2.5], [error, 5]] as const) {
      await mark.click();
      await until(async () => Math.abs((await shown_time()) - time) < a_state);
    }
    await slide(page, '#scrub', 0);
    await until(async () => (await shown_time()) === 0);
  });

  recording_tests(a_state, 1 / 60, 'Report');
});

describe.skipIf(!program)('what the program ran', () => {
  on(() => recorded(file), 'recording');

  recording_tests(0.02, 0.02, 'A recording');
});

describe.skipIf(!program)('the program’s rig, its refusals and its run', () => {
  on(() => started(file), 'live');

  test('a way into an obstacle is refused where screen readers hear it', async () => {
    await slide(page, '#arm-bends-0', 2);
    await until(async () => (await page.locator('[role="alert"]').textContent())!.includes('ball'));
    expect(Math.abs((await server_state(page)).bends[0])).toBeLessThan(0.1);
  });

  test('its tasks run, and what they leave can be opened and left', async () => {
    await page.keyboard.press('r');
    await page.getByRole('button', { name: 'Replay' }).click({ timeout: 25000 });
    await page.waitForSelector('.badge[data-kind="recording"]');
    await slide(page, '#scrub', 4);
    await until(async () => Math.abs((await shown_time()) - 4) < 0.02);
    expect((await server_state(page)).bends[0]).toBeCloseTo(0, 1);
    await page.getByRole('button', { name: 'To the rig' }).click();
    await page.waitForSelector('.badge[data-kind="live"]');
    expect(complaints).toEqual([]);
  });
});

describe.skipIf(!program)('a run that is watched', () => {
  /** Simulated duration, s; running it takes a few seconds. */
  const watched_s = 8000;

  on(() => started(['run', file, '--out', 'watched', '--set', `task.0.duration=${watched_s}`, '--view', '--speed', '0']), 'live');

  test('it is shown as it goes on, is not to be cancelled here, and is a recording when it is over', async () => {
    const { time } = await server_state(page);
    expect(time).toBeLessThan(watched_s);
    await until(async () => (await server_state(page)).time > time);
    const cancel = page.getByRole('button', { name: 'Cancel' });
    expect(await cancel.isDisabled()).toBe(true);
    expect(await cancel.getAttribute('title')).toContain('Only the terminal that started');
    await page.keyboard.press('c');
    await page.waitForSelector('.badge[data-kind="recording"]', { timeout: 240_000 });
    // The run reached its end and was not stopped early.
    expect(Number(await page.locator('#scrub').getAttribute('max'))).toBeCloseTo(watched_s + 2, 6);
    expect(await page.getByRole('button', { name: 'To the rig' }).count()).toBe(0);
    expect(complaints).toEqual([]);
  }, 300_000);
});

describe.skipIf(!program)('a calibration, when it is over', () => {
  const calibration = fileURLToPath(new URL('../../../examples/05_calibration/experiment.toml', import.meta.url));

  on(() => recorded(calibration), 'recording');

  /** Returns position, pan, tilt and stage of the front camera from the page's state. */
  const front = () => page.evaluate(() => {
    const { cameras } = (globalThis as unknown as { flexura: { shown(): { cameras: Float32Array } } }).flexura.shown();
    return { position: [...cameras.subarray(0, 3)], head: [...cameras.subarray(7, 9)], stage: [...cameras.subarray(10, 13)] };
  });

  test('its cameras stand and look where it drove them', async () => {
    await slide(page, '#scrub', 0);
    await until(async () => (await shown_time()) === 0);
    // The first picture comes a little after the start.
    const first = await page.evaluate(async () => {
      for (let time = 0; time < 60; time += 0.1) if ((await fetch(`image/front.png?time=${time}`)).ok) return time;
      throw new Error('no picture in a minute');
    });
    complaints.length = 0;  // Of the answers before that.
    const [start, picture] = [await front(), await served_picture(page, first)];
    expect(start.head).toEqual([0, 0]);
    expect(start.stage).toEqual([0, 0, 0]);
    const end_time = Number(await page.locator('#scrub').getAttribute('max'));
    await slide(page, '#scrub', end_time);
    await until(async () => Math.abs((await shown_time()) - end_time) < 0.1);
    const end = await front();
    // The cameras started ten degrees and half a metre off; the stage moves along its own axes.
    expect(Math.hypot(...end.head)).toBeGreaterThan(0.05);
    const way = Math.hypot(...end.position.map((x, i) => x - start.position[i]));
    expect(way).toBeGreaterThan(0.05);
    expect(way).toBeCloseTo(Math.hypot(...end.stage), 1);
    const { values } = await served_picture(page, end_time);
    expect(values.filter((value, i) => Math.abs(value - picture.values[i]) > 40).length).toBeGreaterThan(1000);
    expect(complaints).toEqual([]);
  });
});
