// A live rig that starts in an instant of a recording.
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { beforeAll, describe, expect, test } from 'vitest';
import { server_state, slide, until } from './browser';
import { opened_before, recorded } from './opened';
import { program } from './program';

const file = fileURLToPath(new URL('recording.toml', import.meta.url));

describe.skipIf(!program)('a recording', () => {
  const opened = opened_before(() => recorded(file), 'recording');
  let page: Page;

  beforeAll(() => {
    ({ page } = opened);
  });

  const shown = () => page.evaluate(() =>
    (globalThis as unknown as { flexura: { shown(): { time: number; bends: Float32Array } } }).flexura.shown());
  const bends = async () => Object.values((await shown()).bends);
  const is_at = async (wanted: number[]) => (await bends()).every((value, i) => Math.abs(value - wanted[i]) < 1e-3);

  test('says first what came of the run', async () => {
    expect(await page.locator('.headline').textContent()).toBe('2 of 2 motions done');
  });

  test('is continued from the shown instant', async () => {
    await slide(page, '#scrub', 2);
    await until(async () => Math.abs((await shown()).time - 2) < 0.1);
    const start = await bends();
    expect(start[0]).toBeLessThan(-0.3);
    await page.getByRole('button', { name: 'Start here' }).click();
    await page.waitForSelector('.badge[data-kind="live"]');
    expect(await page.locator('.title').textContent()).toBe('A recording (from 2 s)');
    await until(() => is_at(start));
    expect((await server_state(page)).is_moving).toBe(false);
  });

  test('lets the rig move from there, and be put back there', async () => {
    const start = await bends();
    await slide(page, '.section .slider input[type="range"]', 0.2);
    await until(async () => !(await is_at(start)));
    await page.getByRole('button', { name: 'Reset' }).click();
    await until(() => is_at(start));
  });

  test('runs the tasks from there, and stays to be opened again', async () => {
    await page.getByLabel('Speed of the tasks').selectOption('0');
    await page.getByRole('button', { name: 'Replay' }).click();
    await page.waitForSelector('.badge[data-kind="recording"]');
    expect(await page.locator('.title').textContent()).toBe('A recording');
    await page.getByRole('button', { name: 'To the rig' }).click();
    await page.waitForSelector('.badge[data-kind="live"]');
    await page.getByRole('button', { name: 'Run tasks' }).click();
    await page.waitForSelector('.badge[data-kind="done"]');
    await page.getByText('2 of 2 motions done').first().waitFor();
    await until(() => is_at([-0.4, 0.2, 0.2, 0.4]));
    expect(opened.complaints).toEqual([]);
  });
});
