// The page of `flexura compare`, opened from a file, as a user does.
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { colors_in, launch, open_page } from './browser';
import { program, Program } from './program';

const file = fileURLToPath(new URL('recording.toml', import.meta.url));

describe.skipIf(!program)('the page of two compared runs', () => {
  const made = new Program();
  let browser: Browser;
  let address: string;

  beforeAll(async () => {
    const run = (name: string, ...sets: string[]): string => {
      const results = join(made.folder, name);
      const words = ['run', file, '--out', results, ...sets.flatMap((set) => ['--set', set])];
      expect(spawnSync(program!, words, { stdio: 'ignore' }).status).toBe(0);
      return results;
    };
    const page = join(made.folder, 'compared.html');
    const [a, b] = [run('a'), run('b', 'arm.section.0.length=0.45')];
    const ended = spawnSync(program!, ['compare', a, b, '--out', page], { encoding: 'utf8' });
    // 1: the results differ, or 0.
    expect(ended.stdout).toContain(`page: ${page}`);
    address = `file://${page}`;
    browser = await launch();
  });

  afterAll(async () => {
    await browser.close();
    await made.stop();
  });

  test('shows the differences and the plots of both, in both themes and at every width', async () => {
    for (const dark of [false, true]) {
      for (const width of [1280, 390]) {
        const { page, complaints } = await open_page(browser, 'about:blank', { width, dark });
        page.on('request', (request) => {
          if (!request.url().startsWith('file:') && !request.url().startsWith('data:')) complaints.push(request.url());
        });
        await page.goto(address);
        expect(await page.locator('td', { hasText: 'tip.position' }).count()).toBeGreaterThan(0);
        const plot = page.locator('#picture-tip-x');
        await plot.scrollIntoViewIfNeeded();
        const box = (await plot.boundingBox())!;
        expect(box.width).toBeGreaterThan(200);
        expect(box.x + box.width).toBeLessThanOrEqual(width + 1);
        // Axes, and a line of each run.
        expect(await colors_in(page, await plot.screenshot())).toBeGreaterThan(4);
        expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(width);
        expect(complaints).toEqual([]);
        await page.context().close();
      }
    }
  });
});
