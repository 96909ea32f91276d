// Measures the speed of the page: `npm run speed`, on an otherwise idle machine. Results are printed without a verdict.
// With FLEXURA_PROGRAM the start of the program is included.
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { fileURLToPath } from 'node:url';
import { spatial_rig } from '../fake/rigs';
import { FakeServer } from '../fake/server';
import { dist, launch, open_page } from '../e2e/browser';
import { Program, program } from '../e2e/program';

let browser: Browser;

beforeAll(async () => {
  browser = await launch();
});

afterAll(async () => {
  await browser?.close();
});

interface Counters {
  flexura?: { drawn(): number; shown(): unknown };
}

const drawn = (page: Page) => page.evaluate(() => (globalThis as unknown as Counters).flexura!.drawn());

test('pictures a second at 1440 by 900, while the arm moves and two cameras send', async () => {
  const server = new FakeServer(dist, spatial_rig());
  await server.start();
  const { page } = await open_page(browser, server.url, { width: 1440, height: 900 });
  await page.waitForSelector('.badge[data-kind="live"]');
  await page.waitForTimeout(1500);
  const wave = setInterval(() => {
    const t = server.session.time;
    server.session.arm.command([[Math.sin(t), Math.cos(t)], [Math.cos(2 * t), 0.5], [0.3, Math.sin(3 * t)]]);
  }, 50);
  const before = await drawn(page);
  const start = performance.now();
  await page.waitForTimeout(5000);
  const rate = (1000 * ((await drawn(page)) - before)) / (performance.now() - start);
  clearInterval(wave);
  console.log(`drawn: ${rate.toFixed(1)} pictures a second`);
  await page.context().close();
  await server.stop();
  expect(rate).toBeGreaterThan(0);
});

test.skipIf(!program)('from the program’s start to its address, and from there to the first picture', async () => {
  const served = new Program(fileURLToPath(new URL('../e2e/rig.toml', import.meta.url)));
  const start = performance.now();
  await served.start();
  const printed = performance.now();
  const { page } = await open_page(browser, served.url, { width: 1440, height: 900 });
  await page.waitForFunction(() => {
    const { flexura } = globalThis as unknown as Counters;
    return flexura?.shown() && flexura.drawn() > 0;
  });
  const first = performance.now();
  console.log(`start: ${(printed - start).toFixed(0)} ms to the address, ${(first - printed).toFixed(0)} ms to the first picture`);
  await served.stop();
  expect(first).toBeGreaterThan(printed);
});
