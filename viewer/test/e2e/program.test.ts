// The page against the program itself.
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import type { Browser } from 'playwright-core';
import { launch, open_page, until } from './browser';
import { started } from './opened';
import { Program, program } from './program';
import { rig_tests } from './rig_tests';

const rig = fileURLToPath(new URL('rig.toml', import.meta.url));

describe.skipIf(!program)('the program', () => {
  describe('with its rig', () => {
    rig_tests(() => started(rig));
  });

  describe('started again', () => {
    const served = new Program(rig);
    let browser: Browser;

    beforeAll(async () => {
      browser = await launch();
    });

    afterAll(async () => {
      await browser?.close();
      await served.stop();
    });

    test('the page comes in again by itself, and starts afresh', async () => {
      // The first start finds a free port; a token is kept for one that was asked for.
      await served.start();
      await served.end();
      await served.start(served.port);
      const { page, complaints } = await open_page(browser, served.url);
      const badge = () => page.locator('.badge').first().getAttribute('data-kind');
      await until(async () => (await badge()) === 'live');
      await served.end();
      await until(async () => (await badge()) === 'lost');
      await served.start(served.port);
      await until(async () => (await badge()) === 'live', 20000, 'the page did not come back');
      await until(async () => /started again/.test((await page.locator('.notices').textContent()) ?? ''));
      expect(await page.locator('.entrance').count()).toBe(0);
      expect(complaints).toEqual([]);
    });
  });
});
