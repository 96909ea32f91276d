// Each picture of a recording is of the time that it says, and none of the future.
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { slide, until } from './browser';
import { opened_before, recorded } from './opened';
import { program } from './program';

const file = fileURLToPath(new URL('pictures.toml', import.meta.url));
const late = 0.5;

describe.skipIf(!program)('late pictures of a recording', () => {
  const opened = opened_before(() => recorded(file), 'recording');
  const captions = () => opened.page.locator('.picture-time').allTextContents();
  const shown = (): Promise<number> => opened.page.evaluate(() => (globalThis as unknown as { flexura: { shown(): { time: number } } }).flexura.shown().time);

  test('are not there before the first has come', async () => {
    const { page } = opened;
    await until(async () => (await page.locator('.picture .none').count()) === 2, 8000, 'pictures of the future');
    expect(await page.locator('.picture .none').first().textContent()).toBe('No picture yet at this time');
    const status = await page.evaluate(async () => (await fetch('image/front.png?time=0')).status);
    expect(status).toBe(404);
  });

  test('say of when they are, and how far that is from what is shown', async () => {
    const { page } = opened;
    await slide(page, '#scrub', 2);
    await until(async () => (await page.locator('.picture .none').count()) === 0, 8000, 'no picture came');
    await until(async () => Math.abs((await shown()) - 2) < 0.02);
    await until(async () => (await captions()).every((text) => /earlier/.test(text)), 8000, 'they do not say that they are late');
    for (const caption of await captions()) {
      const [, time, lag] = /^\s*([\d.]+) s, ([\d.]+) s earlier/.exec(caption)!.map(Number);
      expect(lag).toBeGreaterThan(late - 0.02);
      expect(lag).toBeLessThan(late + 0.1);
      expect(Math.abs(time + lag - (await shown()))).toBeLessThan(0.02);
    }
  });

  test('are gone again before the first', async () => {
    const { page, complaints } = opened;
    await slide(page, '#scrub', 0.3);
    await until(async () => (await page.locator('.picture .none').count()) === 2);
    await slide(page, '#scrub', 3);
    await until(async () => (await page.locator('.picture .none').count()) === 0);
    // The browser complains of the answer 404 above.
    expect(complaints.filter((line) => !line.includes('404'))).toEqual([]);
  });
});
