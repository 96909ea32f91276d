// Region, colour and base of the arm, drawn in the page: on live pictures and on picture files.
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { encode_png } from '../fake/picture';
import { colored, until, type Opened } from './browser';
import { fresh_before_each, started, visit, type Fresh, type Served } from './opened';
import { program } from './program';

const experiment = fileURLToPath(new URL('finder.toml', import.meta.url));
const yellow = '#ffd43b';

/** Returns the place of a picture's pixel on the screen. */
async function place(page: Page, u: number, v: number): Promise<{ x: number; y: number }> {
  return page.locator('.camera[data-enlarged="true"] canvas').evaluate((canvas: HTMLCanvasElement, [left, top]) => {
    const box = canvas.getBoundingClientRect();
    return { x: box.left + ((left + 0.5) / canvas.width) * box.width, y: box.top + ((top + 0.5) / canvas.height) * box.height };
  }, [u, v]);
}

async function drag(page: Page, from: [number, number], to: [number, number]): Promise<void> {
  const [a, b] = [await place(page, ...from), await place(page, ...to)];
  await page.mouse.move(a.x, a.y);
  await page.mouse.down();
  await page.mouse.move((a.x + b.x) / 2, (a.y + b.y) / 2);
  await page.mouse.move(b.x, b.y);
  await page.mouse.up();
}

async function click(page: Page, u: number, v: number): Promise<void> {
  const { x, y } = await place(page, u, v);
  await page.mouse.click(x, y);
}

const tool = (page: Page, name: string) => page.locator('.finder').getByRole('button', { name, exact: true });
const text = async (page: Page, selector: string): Promise<string> => (await page.locator(`.finder ${selector}`).first().textContent()) ?? '';

/** Waits until the axis that the page says is from and to places for which `holds`. */
async function found(page: Page, holds: (from: [number, number], to: [number, number]) => boolean): Promise<void> {
  let said = '';
  await until(async () => {
    said = await text(page, '.result');
    const numbers = /from \((-?\d+), (-?\d+)\) to \((-?\d+), (-?\d+)\)/.exec(said)?.slice(1).map(Number);
    return numbers !== undefined && holds([numbers[0], numbers[1]], [numbers[2], numbers[3]]);
  }, 15000, `another axis was expected: ${said}`).catch((error: Error) => {
    throw new Error(`${error.message}: ${said}`);
  });
}

describe('a live picture', () => {
  let fresh: Fresh;
  fresh_before_each((opened) => (fresh = opened));

  const regions = (): unknown[] => fresh.server.log.filter((request) => request.do === 'measure')
    .map(({ seeing }) => (seeing as { region?: unknown } | undefined)?.region);

  test('is searched in the region that is drawn, also where it is enlarged, and the settings can be taken away', async () => {
    const { page } = fresh;
    await page.getByRole('button', { name: 'Find the arm: front' }).click();
    await until(async () => (await text(page, '.result')).startsWith('Found'));
    await tool(page, 'Rectangle').click();
    await drag(page, [100, 60], [600, 250]);
    await until(() => JSON.stringify(regions().at(-1)) === '[[100,60],[600,250]]', 8000, 'another region was sent');
    await found(page, ([, v], [, w]) => v <= 250 && w <= 250);
    expect(await text(page, 'pre')).toBe('--region 100,60,600,250');
    expect(await page.locator('.finder pre').nth(1).textContent()).toBe('[[seeing]]\ncamera = "front"\nregion = [[100, 60], [600, 250]]');
    // The wheel enlarges a part; the pixels stay the same.
    const { x, y } = await place(page, 320, 240);
    await page.mouse.move(x, y);
    for (let i = 0; i < 3; ++i) await page.mouse.wheel(0, -100);
    await until(async () => (await page.locator('.camera[data-enlarged="true"] canvas').evaluate((canvas) => canvas.getBoundingClientRect().width / canvas.parentElement!.clientWidth)) > 1.9);
    await tool(page, 'Polygon').click();
    for (const [u, v] of [[250, 180], [400, 180], [400, 330]]) await click(page, u, v);
    await page.keyboard.press('Enter');
    await until(() => JSON.stringify(regions().at(-1)) === '[[250,180],[400,180],[400,330]]', 8000, `another region was sent: ${JSON.stringify(regions().at(-1))}`);
    await tool(page, 'Clear').click();
    await until(() => regions().at(-1) === undefined);
    expect(await page.locator('.finder pre').count()).toBe(0);
  });

  test('is measured as before when drawing is cancelled; a double click closes a polygon', async () => {
    const { page } = fresh;
    await page.getByRole('button', { name: 'Find the arm: front' }).click();
    await tool(page, 'Polygon').click();
    await click(page, 100, 100);
    await click(page, 300, 100);
    await page.keyboard.press('Escape');
    expect(await tool(page, 'Polygon').getAttribute('aria-pressed')).toBe('false');
    expect(await page.locator('.finder').count()).toBe(1);
    await tool(page, 'Polygon').click();
    await click(page, 100, 20);
    await click(page, 600, 20);
    const { x, y } = await place(page, 600, 460);
    await page.mouse.dblclick(x, y);
    await until(() => JSON.stringify(regions().at(-1)) === '[[100,20],[600,20],[600,460]]');
    expect(await text(page, '.choices li')).toContain('polygon with 3 corners');
    // Escape closes the tools first, then the picture.
    await page.keyboard.press('Escape');
    expect(await page.locator('.finder').count()).toBe(0);
    await page.keyboard.press('Escape');
    expect(await page.locator('.camera[data-enlarged="true"]').count()).toBe(0);
  });

  test('that is gray has no colour, and the page says what helps', async () => {
    const { page } = fresh;
    await page.getByRole('button', { name: 'Find the arm: front' }).click();
    await tool(page, 'Colour').click();
    expect(await text(page, '.said')).toContain('gray and has no colour');
    await tool(page, 'Base').click();
    await click(page, 320, 400);
    await until(async () => (await text(page, 'pre')) === '--base 320,400');
    expect(await page.locator('.finder pre').count()).toBe(1);
    // On a telephone everything is below the picture, and nothing is wider than the page.
    await page.setViewportSize({ width: 390, height: 780 });
    const wide = await page.evaluate(() => [...document.querySelectorAll('.finder, .finder *')].some((each) => each.getBoundingClientRect().right > innerWidth + 1));
    expect(wide).toBe(false);
  });
});

describe.skipIf(!program)('with the program', () => {
  let folder: string;
  let served: Served;
  let opened: Opened;

  /** A red tube at u = 200 and a larger blue one at u = 460, before a bright wall. */
  function two_tubes(): Buffer {
    const [width, height] = [640, 480];
    const pixels = new Uint8Array(3 * width * height);
    for (let v = 0; v < height; ++v) {
      for (let u = 0; u < width; ++u) {
        const [is_red, is_blue] = [Math.abs(u - 200) < 16 && v > 60, Math.abs(u - 460) < 24 && v > 30];
        pixels.set(is_red ? [170, 30, 30] : is_blue ? [30, 30, 150] : [220, 220, 220], 3 * (v * width + u));
      }
    }
    return encode_png(width, height, pixels, 3);
  }

  const open = async (what: string[]): Promise<Page> => {
    served = await started(['view', ...what]);
    opened = await visit(served.url);
    return opened.page;
  };

  beforeAll(() => {
    folder = mkdtempSync(join(tmpdir(), 'flexura-finder-'));
    for (const name of ['tubes.png', 'other.png']) writeFileSync(join(folder, name), two_tubes());
  });

  afterAll(() => rmSync(folder, { recursive: true, force: true }));

  test('a picture file fills the page, and the arm is where region or colour say', async () => {
    const page = await open([join(folder, 'tubes.png')]);
    try {
      await page.waitForSelector('.badge[data-kind="pictures"]');
      await found(page, ([u]) => Math.abs(u - 460) < 3);
      await until(async () => Math.abs((await colored(page, yellow)).u - 460) < 4, 8000, 'the axis is not drawn');
      await tool(page, 'Colour').click();
      await click(page, 200, 300);
      await found(page, ([u], [w]) => Math.abs(u - 200) < 3 && Math.abs(w - 200) < 3);
      await until(async () => Math.abs((await colored(page, yellow)).u - 200) < 4, 8000, 'the axis is not drawn');
      expect(await text(page, 'pre')).toBe('flexura measure tubes.png --color 170,30,30');
      await tool(page, 'Clear').click();
      await found(page, ([u]) => Math.abs(u - 460) < 3);
      await tool(page, 'Rectangle').click();
      await drag(page, [120, 20], [300, 400]);
      await found(page, ([u, v]) => Math.abs(u - 200) < 3 && v <= 401);
      // Where nothing is, the reason is said at once.
      await tool(page, 'Rectangle').click();
      await drag(page, [4, 4], [100, 200]);
      await until(async () => (await text(page, '.result')).startsWith('Not found: '));
      await tool(page, 'Remove: region').click();
      await tool(page, 'Base').click();
      await click(page, 200, 470);
      await found(page, ([u]) => Math.abs(u - 200) < 3);
      expect(opened.complaints).toEqual([]);
    } finally {
      await served.stop();
    }
  });

  test('several picture files are shown side by side', async () => {
    const page = await open([join(folder, 'tubes.png'), join(folder, 'other.png')]);
    try {
      await until(async () => (await page.locator('.picture canvas').count()) === 2 && (await page.locator('.picture .none').count()) === 0);
      await page.getByRole('button', { name: 'Find the arm: other.png' }).click();
      await found(page, ([u]) => Math.abs(u - 460) < 3);
      expect(opened.complaints).toEqual([]);
    } finally {
      await served.stop();
    }
  });

  test('a live picture in colour has another axis as soon as region or colour are chosen', async () => {
    const page = await open([experiment]);
    try {
      await page.waitForSelector('.badge[data-kind="live"]');
      await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
      await page.getByRole('button', { name: 'Find the arm: front' }).click();
      await until(async () => (await text(page, '.result')).startsWith('Found'), 15000);
      // The arm begins in the middle, at the bottom.
      await tool(page, 'Rectangle').click();
      await drag(page, [5, 120], [315, 235]);
      await found(page, ([, v], [, w]) => v >= 119 && w >= 119);
      await tool(page, 'Clear').click();
      await found(page, (_, [, w]) => w < 119);
      const base = await text(page, '.result');
      const [, u, v] = /from \((\d+), (\d+)\)/.exec(base)!.map(Number);
      await tool(page, 'Colour').click();
      await click(page, u, v - 10);
      await until(async () => /--color \d+,\d+,\d+/.test(await text(page, 'pre')));
      const [, red, green] = /--color (\d+),(\d+),/.exec(await text(page, 'pre'))!.map(Number);
      expect(red).toBeGreaterThan(green + 20);
      await found(page, (_, [, w]) => w < 119);
      expect(await page.locator('.finder pre').nth(1).textContent()).toMatch(/^\[\[seeing\]\]\ncamera = "front"\ncolor = \[/);
      expect(opened.complaints).toEqual([]);
    } finally {
      await served.stop();
    }
  });
});
