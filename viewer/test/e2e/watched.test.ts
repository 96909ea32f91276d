// Runs started in a terminal and watched by the page. Their time may be faster or slower than real time.
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { server_state, until } from './browser';
import { visit } from './opened';
import { Program, program } from './program';

const rig = fileURLToPath(new URL('watched.toml', import.meta.url));

describe.skipIf(!program)('a watched run', () => {
  // The recorded pictures set the pace: a hundred times faster than real time, or slower. Both runs are ended early.
  describe.each([
    ['fast', ['task.0.duration=6000', 'record.cameras=true']],
    ['slow', ['task.0.duration=20', 'record.cameras=true', 'camera.0.sensor.frame_rate=10000']],
  ])('that is %s', (_, settings) => {
    let served: Program;

    beforeAll(async () => {
      served = new Program(['run', rig, ...settings.flatMap((each) => ['--set', each]), '--view', '--speed', '0']);
      await served.start();
    });

    afterAll(() => served.stop());

    test('its pictures are of the states that are shown, and none stays darkened as old', async () => {
      const { page, complaints } = await visit(served.url);
      await page.waitForSelector('.badge[data-kind="live"]');
      await until(async () => (await page.locator('.picture .none').count()) === 0, 20000, 'no picture came');
      const seconds = async (): Promise<number> => {
        const text = (await page.locator('.camera figcaption span').first().textContent())!;
        const [minutes, rest] = text.includes(':') ? text.split(':').map(parseFloat) : [0, parseFloat(text)];
        return 60 * minutes + rest;
      };
      let looks = 0;
      const end = Date.now() + 2500;
      while (Date.now() < end && (await page.locator('.badge[data-kind="live"]').count()) === 1) {
        // A picture may be late where the machine is busy, but then a new one comes.
        await until(async () => (await page.locator('.camera[data-old="true"]').count()) === 0, 20000, 'the pictures stay old');
        // The run's time, which is independent of the page's clock.
        expect(await seconds()).toBeLessThanOrEqual((await server_state(page)).time + 0.01);
        ++looks;
      }
      expect(looks).toBeGreaterThan(0);
      expect(complaints).toEqual([]);
    });
  });
});

describe.skipIf(!program)('a watched run at its usual speed', () => {
  let served: Program;

  beforeAll(async () => {
    served = new Program(['run', rig, '--set', 'task.0.duration=600', '--view']);
    await served.start();
  });

  afterAll(() => served.stop());

  test('plays in real time, and as fast as the page wants', async () => {
    const { page, complaints } = await visit(served.url);
    await page.waitForSelector('.badge[data-kind="live"]');
    const speed = page.getByLabel('Speed of the tasks');
    expect(await speed.inputValue()).toBe('1');
    await until(async () => (await server_state(page)).time > 0.5);
    const before = await page.evaluate(() => performance.now());
    const { time } = await server_state(page);
    await until(async () => (await server_state(page)).time > time + 1);
    // Never faster than the clock, but for what the messages take; slower on a busy machine.
    const passed = (await page.evaluate(() => performance.now()) - before) / 1000;
    expect((await server_state(page)).time - time).toBeLessThan(passed + 1.5);
    await speed.selectOption('0');
    await page.waitForSelector('.badge[data-kind="recording"]');
    expect(Number(await page.locator('#scrub').getAttribute('max'))).toBeCloseTo(600, 6);
    expect(complaints).toEqual([]);
  });
});
