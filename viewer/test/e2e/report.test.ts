// The report's view in three dimensions: opened from a file, as a user does.
import { fileURLToPath } from 'node:url';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, test } from 'vitest';
import { colors_in, launch, open_page, slide, until } from './browser';
import { program, Program } from './program';

const file = fileURLToPath(new URL('recording.toml', import.meta.url));

describe.skipIf(!program)('the report in three dimensions', () => {
  const made = new Program();
  let report: string;
  let browser: Browser;
  let page: Page;
  let complaints: string[];

  const open = async (options: Parameters<typeof open_page>[2] = {}, before?: () => void): Promise<void> => {
    ({ page, complaints } = await open_page(browser, 'about:blank', options));
    if (before) await page.addInitScript(before);
    page.on('request', (request) => {
      if (!request.url().startsWith('file:') && !request.url().startsWith('data:')) complaints.push(request.url());
    });
    await page.goto(report);
    await page.locator('#space').scrollIntoViewIfNeeded();
  };
  const data = (name: string) => page.locator('#room').getAttribute(`data-${name}`);
  const opened = async (...options: Parameters<typeof open>): Promise<void> => {
    await open(...options);
    await until(async () => (await data('view')) !== null);
  };
  const picture = () => page.locator('#room').screenshot();
  const tip = async () => (await data('tip'))!.split(' ').map(Number);
  const summary = async (name: string) => {
    const text = await page.locator('.summary div', { hasText: name }).locator('dd').textContent();
    return text!.match(/-?\d+\.\d+/g)!.map(Number);
  };
  const is_near = (a: number[], b: number[]) => a.every((value, i) => Math.abs(value - b[i]) < 2e-3);

  beforeAll(async () => {
    report = `file://${made.record(file)}/report.html`;
    browser = await launch();
  });

  afterEach(async () => {
    expect(complaints).toEqual([]);
    await page.context().close();
  });

  afterAll(async () => {
    await browser.close();
    await made.stop();
  });

  test('shows the final state, and the state of the slider', async () => {
    await opened();
    const [start, end] = [await summary('start'), await summary('end')];
    await until(async () => is_near(await tip(), end));
    const before = await picture();
    await slide(page, '#space-scrub', 0);
    await until(async () => is_near(await tip(), start));
    expect((await picture()).equals(before)).toBe(false);
    // Both times of the page are one.
    expect(await page.locator('#time').textContent()).toBe(await page.locator('#space-time').textContent());
    await slide(page, '#scrub', 6);
    await until(async () => is_near(await tip(), end));
  });

  test('shows what a task aims at until the arm is commanded there', async () => {
    await opened();
    expect(await page.locator('#space-state').textContent()).toBe('target: back, as commanded');
    await slide(page, '#scrub', 2);
    await until(async () => (await page.locator('#space-state').textContent()) === 'target: reach');
    const before = await picture();
    await page.getByLabel('target').uncheck();
    await until(async () => !(await picture()).equals(before));
  });

  test('turns by dragging and by keys, zooms, and goes back to its opening view', async () => {
    await opened();
    const first = await data('view');
    const before = await picture();
    const box = (await page.locator('#room').boundingBox())!;
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width / 2 + 80, box.y + box.height / 2 + 30, { steps: 4 });
    await page.mouse.up();
    await until(async () => (await data('view')) !== first);
    expect((await picture()).equals(before)).toBe(false);
    const dragged = (await data('view'))!.split(' ').map(Number);
    await page.locator('#room').focus();
    await page.keyboard.press('ArrowLeft');
    await page.keyboard.press('+');
    await until(async () => {
      const [azimuth, , distance] = (await data('view'))!.split(' ').map(Number);
      return azimuth < dragged[0] - 0.05 && distance < dragged[2];
    });
    await page.getByRole('button', { name: 'Opening view' }).click();
    await until(async () => (await data('view')) === first);
  });

  test('names the cameras, and hides them and the floor', async () => {
    await opened();
    expect(await page.locator('#room-names .camera').allTextContents()).toContain('front');
    await page.getByLabel('cameras').uncheck();
    await until(async () => (await page.locator('#room-names .camera').count()) === 0);
    await page.getByLabel('floor').uncheck();
    await until(async () => (await page.locator('#room-names .size').count()) === 0);
    expect(await colors_in(page, await picture())).toBeGreaterThan(10);
  });

  test('is drawn in both themes, at every width', async () => {
    for (const dark of [false, true]) {
      for (const width of [1280, 390]) {
        await opened({ width, dark });
        expect(await colors_in(page, await picture())).toBeGreaterThan(20);
        const corner = await page.evaluate(() => {
          const canvas = document.querySelector<HTMLCanvasElement>('#room-canvas')!;
          const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d')!;
          copy.drawImage(canvas, 0, 0);
          return copy.getImageData(2, 2, 1, 1).data[0];
        });
        expect(corner < 60).toBe(dark);
        expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(width);
        expect(complaints).toEqual([]);
        if (!dark || width !== 390) await page.context().close();
      }
    }
  });

  test('without WebGL a sentence says so, and the player works', async () => {
    await open({}, () => {
      const context = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, ...rest: unknown[]) {
        return kind.startsWith('webgl') ? null : (context as (...all: unknown[]) => unknown).call(this, kind, ...rest);
      } as typeof context;
    });
    expect(await page.locator('#space-missing').isVisible()).toBe(true);
    expect(await page.locator('#space-view').isVisible()).toBe(false);
    await slide(page, '#scrub', 6);
    expect(await page.locator('#time').textContent()).toBe('t = 6.000 s');
  });
});
