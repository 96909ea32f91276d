// Measurements on the pictures and in the 3D view, with the fake server and with the program.
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { beforeAll, describe, expect, test } from 'vitest';
import { colored, slide, stage_at_rest, until } from './browser';
import type { FakeServer } from '../fake/server';
import { faked, opened_before, recorded, started, type Served } from './opened';
import { program } from './program';

const measured = fileURLToPath(new URL('measured.toml', import.meta.url));

const chip = (page: Page, label: string) => page.getByRole('button', { name: new RegExp(`^${label}: `) });

/** Returns the numbers of the first camera's drawn pictures, and of those that were measured, frame by frame. */
const watched_pairs = (page: Page, ms = 2500) => page.evaluate(async (most) => {
  const canvas = document.querySelector<HTMLCanvasElement>('.picture canvas')!;
  const seen: { number: string; measured: string }[] = [];
  const end = performance.now() + most;
  while (performance.now() < end) {
    await new Promise(requestAnimationFrame);
    seen.push({ number: canvas.dataset.number ?? '', measured: canvas.dataset.measured ?? '' });
  }
  return seen;
}, ms);

function measured_tests(start: () => Promise<Served>, is_recording: boolean): void {
  const opened = opened_before(start, is_recording ? 'recording' : 'live');
  let page: Page;

  beforeAll(async () => {
    ({ page } = opened);
    if (is_recording) await slide(page, '#scrub', 2);
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
  });

  test('nothing is drawn before anybody asks', async () => {
    for (const color of ['#69db7c', '#ffd43b', '#ff6b6b', '#4dabf7']) expect((await colored(page, color)).count).toBe(0);
    expect(await page.locator('.chip[aria-pressed="true"]').count()).toBe(0);
  });

  for (const [label, color, least] of [['Edges', '#69db7c', 100], ['Axis', '#ffd43b', 60], ['Marks', '#ff6b6b', 20], ['Circle', '#4dabf7', 50]] as const) {
    test(`${label} are drawn while their switch is on`, async () => {
      await chip(page, label).click();
      await until(async () => (await colored(page, color)).count >= least, 8000, `no ${label}`);
      expect(await chip(page, label).getAttribute('aria-pressed')).toBe('true');
      await chip(page, label).click();
      await until(async () => (await colored(page, color)).count === 0, 8000, `${label} stay`);
    });
  }

  test('the mask tints the arm', async () => {
    const tinted = () => page.locator('.picture canvas').first().evaluate((canvas: HTMLCanvasElement) => {
      const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4) if (data[i + 1] - data[i] > 30 && data[i + 2] - data[i] > 20) ++count;
      return count;
    });
    const before = await tinted();
    await chip(page, 'Mask').click();
    await until(async () => (await tinted()) > before + 300, 8000, 'no mask');
    await chip(page, 'Mask').click();
    await until(async () => (await tinted()) === before, 8000, 'the mask stays');
  });

  test('layers go with the picture', async () => {
    await chip(page, 'Axis').click();
    await until(async () => (await colored(page, '#ffd43b')).count > 60);
    const before = await colored(page, '#ffd43b');
    if (is_recording) await slide(page, '#scrub', 0);
    else for (const i of [0, 1]) await slide(page, `#arm-bends-${i}`, -0.6);
    await until(async () => {
      const { count, u, v } = await colored(page, '#ffd43b');
      return count > 60 && Math.hypot(u - before.u, v - before.v) > 5;
    }, 8000, 'the axis stays where it was');
    await chip(page, 'Axis').click();
  });

  test('while the arm moves, what is drawn upon a picture was measured in it', async () => {
    await chip(page, 'Axis').click();
    await until(async () => (await colored(page, '#ffd43b')).count > 60);
    const pairs = watched_pairs(page);
    if (is_recording) await slide(page, '#scrub', 0);
    if (is_recording) await page.locator('#play').click();
    else for (const [i, to] of [[0, 0.7], [1, 0.5], [0, -0.7], [1, -0.5]]) {
      await slide(page, `#arm-bends-${i}`, to);
      await page.waitForTimeout(500);
    }
    const seen = await pairs;
    expect(new Set(seen.map(({ number }) => number)).size).toBeGreaterThan(1);
    expect(seen.some(({ measured }) => measured !== '')).toBe(true);
    for (const { number, measured } of seen) if (measured !== '') expect(measured).toBe(number);
    if (is_recording && (await page.locator('#play').getAttribute('aria-label')) === 'Pause') await page.locator('#play').click();
    await chip(page, 'Axis').click();
  });

  test('the shape of both pictures stands in the view', async () => {
    const before = await stage_at_rest(page);
    await chip(page, 'Shape').click();
    await until(async () => /^Shape ±[\d.]+ mm, images [\d.]+ px off/.test((await page.locator('.shape-said').textContent()) ?? ''), 15000, 'no shape');
    expect((await stage_at_rest(page)).equals(before)).toBe(false);
    await chip(page, 'Shape').click();
    await until(async () => (await page.locator('.shape-said').count()) === 0);
    expect((await stage_at_rest(page)).equals(before)).toBe(true);
  });

  test('switches are worked by keys, and kept', async () => {
    await chip(page, 'Axis').focus();
    await page.keyboard.press('Enter');
    await until(async () => (await colored(page, '#ffd43b')).count > 60);
    await page.reload();
    await until(async () => (await page.locator('.chip[aria-pressed="true"]').count()) === 1);
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000);
    await until(async () => (await colored(page, '#ffd43b')).count > 60, 15000, 'it is not kept');
    expect(opened.complaints).toEqual([]);
  });
}

if (program) {
  describe('the program’s rig', () => measured_tests(() => started(measured), false));
  describe('a recording that was filmed', () => measured_tests(() => recorded(measured), true));
} else {
  // Fallback without the program. The shape is redrawn with each picture. A low picture rate would make the view
  // alternate between both resolutions.
  describe('a rig', () => measured_tests(async () => Object.assign(await faked(), { resting_rate: 8 }), false));
}

// The fake rig's measurement takes longer than the next picture, and its axis is the middle of what it draws.
describe('a live rig that moves fast and is measured late', () => {
  let server: FakeServer;
  const opened = opened_before(async () => Object.assign(server = await faked(), { measure_delay_ms: 160 }), 'live');

  test('the axis lies in the middle of the arm on every picture', async () => {
    const { page, complaints } = opened;
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
    await chip(page, 'Axis').click();
    await until(async () => (await colored(page, '#ffd43b')).count > 60);
    const watching = page.evaluate(async () => {
      const canvas = document.querySelector<HTMLCanvasElement>('.picture canvas')!;
      const context = canvas.getContext('2d')!;
      const offs: number[] = [];
      const places = new Set<number>();
      const end = performance.now() + 5000;
      while (performance.now() < end) {
        await new Promise(requestAnimationFrame);
        const { width, height, data } = context.getImageData(0, 0, canvas.width, canvas.height);
        let [sum, count] = [0, 0];
        for (let v = 0; v < height; v += 4) {
          let [left, right, axis, yellow] = [-1, -1, 0, 0];
          for (let u = 0; u < width; ++u) {
            const at = 4 * (v * width + u);
            const is_axis = data[at] > 180 && data[at + 1] > 140 && data[at + 2] < 130;
            if (is_axis) axis += u, ++yellow;
            if (!is_axis && data[at] > 120) continue;
            if (left < 0) left = u;
            right = u;
          }
          // Where it lies across, a row says nothing.
          if (!yellow || right - left > 60) continue;
          sum += Math.abs(axis / yellow - (left + right) / 2);
          ++count;
          places.add(Math.round(axis / yellow));
        }
        if (count > 5) offs.push(sum / count);
      }
      return { offs, places: places.size };
    });
    for (const sign of [1, -1, 1, -1]) {
      server.session.arm.command(server.session.arm.bends.map(() => [0.5 * sign, 0.4 * sign]));
      await page.waitForTimeout(1000);
    }
    const { offs, places } = await watching;
    expect(offs.length).toBeGreaterThan(4);
    expect(places).toBeGreaterThan(20);
    expect(Math.max(...offs)).toBeLessThan(2.5);
    expect(complaints).toEqual([]);
  });
});
