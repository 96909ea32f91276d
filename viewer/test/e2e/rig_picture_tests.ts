// Times of a live rig's pictures and plots.
import { readFileSync } from 'node:fs';
import type { Page } from 'playwright-core';
import { beforeAll, expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import { colors_in, type Opened, server_state, until } from './browser';

/** Pictures and pixel values. */
export function picture_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('pictures of the cameras come, and a pixel’s value is the server’s', async () => {
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
    const camera = page.locator('.picture canvas').first();
    expect(await colors_in(page, await camera.screenshot())).toBeGreaterThan(3);
    // At rest, the served lossless picture equals the streamed one.
    await page.keyboard.press('Backspace');
    await until(async () => Math.hypot(...(await server_state(page)).bends) < 1e-6);
    await page.waitForTimeout(800);
    const said = page.locator('.pixel dd');
    const values = new Set<number>();
    const box = (await camera.boundingBox())!;
    for (const part of [0.5, 0.1]) {
      await camera.hover({ position: { x: part * box.width, y: 0.5 * box.height } });
      const u = Math.floor(part * 640);
      await until(async () => new RegExp(`\\((${u - 1}|${u}|${u + 1}), `).test((await said.first().textContent()) ?? ''));
      const place = /\((\d+), (\d+)\)/.exec((await said.first().textContent())!)!;
      const served = await served_pixel(Number(place[1]), Number(place[2]));
      await until(async () => (await said.nth(1).textContent()) === `${served} of 255`, 5000, `the server’s value is ${served}`);
      values.add(served);
    }
    expect(values.size).toBe(2);
    const before = await said.first().textContent();
    await camera.focus();
    await page.keyboard.press('ArrowRight');
    await until(async () => (await said.first().textContent()) !== before);
  });

  /** Returns a pixel of the front camera's lossless picture from the server. */
  const served_pixel = (u: number, v: number): Promise<number> => page.evaluate(async ([x, y]) => {
    const answer = await fetch('image/front.png');
    const bitmap = await createImageBitmap(await answer.blob());
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d')!;
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(x, y, 1, 1).data[0];
  }, [u, v]);

  test('the exact picture can be saved', async () => {
    const [download] = await Promise.all([
      page.waitForEvent('download'), page.getByRole('link', { name: 'Save the exact picture of front' }).click(),
    ]);
    expect(download.suggestedFilename()).toBe('front.png');
    const bytes = readFileSync(await download.path());
    expect([...bytes.subarray(0, 4)]).toEqual([0x89, 0x50, 0x4e, 0x47]);
  });
}

export function plot_tests(opened: Opened, fake: () => FakeServer | null): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('a live plot’s window slides with the time', async () => {
    // The timeline covers the remembered time; the dashed line marks the time under the pointer.
    const now = () => page.locator('#scrub').evaluate((scrub: HTMLInputElement) => ({ from: Number(scrub.min), to: Number(scrub.max) }));
    if (fake()) fake()!.session.time += 25;
    await until(async () => (await now()).to - (await now()).from > 22, 25000, 'no 22 s are remembered');
    const chart = (await page.locator('.chart .u-over').first().boundingBox())!;
    const left_end = async (): Promise<number> => {
      await page.mouse.move(chart.x + 30, chart.y + 30);
      await page.mouse.move(chart.x + 1, chart.y + 30);
      await page.locator('.rail .hover').waitFor({ state: 'attached' });
      const part = await page.locator('.rail .hover').evaluate((line: HTMLElement) => parseFloat(line.style.left) / 100);
      const { from, to } = await now();
      return from + part * (to - from);
    };
    const first = await left_end();
    expect(Math.abs((await now()).to - first - 20)).toBeLessThan(2);
    await page.waitForTimeout(2500);
    expect((await left_end()) - first).toBeGreaterThan(1.5);
    await page.mouse.move(chart.x + 30, chart.y - 200);
  });
}

/** Holding the view and going back in time. */
export function time_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('Space holds the view and says so; the slider of time goes back; Space returns to now', async () => {
    await page.locator('.section .slider input[type="range"]').first().focus();
    await page.keyboard.press('Space');
    await page.waitForSelector('.badge[data-kind="held"]');
    const shown = () => page.locator('#time').textContent();
    const at = await shown();
    expect(await page.locator('.picture .now').count()).toBe(2);
    await page.waitForTimeout(400);
    expect(await shown()).toBe(at);
    await page.locator('.section .slider input[type="range"]').first().blur();
    await page.keyboard.press('Shift+ArrowLeft');
    expect(await shown()).not.toBe(at);
    await page.keyboard.press('Space');
    await page.waitForSelector('.badge[data-kind="live"]');
    expect(await shown()).toContain('now');
  });
}
