// Measurements on the pictures and in the 3D view, with the fake server and with the program.
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { beforeAll, describe, expect, test } from 'vitest';
import { colored, slide, stage_at_rest, until } from './browser';
import { faked, opened_before, recorded, started, type Served } from './opened';
import { program } from './program';

const measured = fileURLToPath(new URL('measured.toml', import.meta.url));

const chip = (page: Page, label: string) => page.getByRole('button', { name: new RegExp(`^${label}: `) });

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
