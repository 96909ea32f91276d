// A run of tasks that a terminal has started and watches: its time is its own, faster than the clock or slower.
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { server_state, until } from './browser';
import { visit } from './opened';
import { Program, program } from './program';

const rig = fileURLToPath(new URL('watched.toml', import.meta.url));

describe.skipIf(!program)('a watched run', () => {
  // By the pictures that the run itself takes: a hundred times as fast as the clock, and slower. Both are left early.
  describe.each([
    ['fast', ['task.0.duration=6000', 'record.cameras=true']],
    ['slow', ['task.0.duration=20', 'record.cameras=true', 'camera.0.sensor.frame_rate=10000']],
  ])('that is %s', (_, settings) => {
    let served: Program;

    beforeAll(async () => {
      served = new Program(['run', rig, ...settings.flatMap((each) => ['--set', each]), '--view']);
      await served.start();
    });

    afterAll(() => served.stop());

    test('its pictures are of the states that are shown, and none is darkened as old', async () => {
      const { page, complaints } = await visit(served.url);
      await page.waitForSelector('.badge[data-kind="live"]');
      await until(async () => (await page.locator('.picture .none').count()) === 0, 20000, 'no picture came');
      const seconds = async (): Promise<number> => {
        const text = (await page.locator('.camera figcaption span').first().textContent())!;
        const [minutes, rest] = text.includes(':') ? text.split(':').map(Number) : [0, parseFloat(text)];
        return 60 * minutes + rest;
      };
      let looks = 0;
      const end = Date.now() + 2500;
      while (Date.now() < end && (await page.locator('.badge[data-kind="live"]').count()) === 1) {
        expect(await page.locator('.camera[data-old="true"]').count()).toBe(0);
        // Of the run's time, which the page's own clock knows nothing of.
        expect(await seconds()).toBeLessThanOrEqual((await server_state(page)).time + 0.01);
        ++looks;
      }
      expect(looks).toBeGreaterThan(3);
      expect(complaints).toEqual([]);
    });
  });
});
