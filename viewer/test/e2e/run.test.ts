// Tasks as a person sees them: at the speed of the clock, and the arm stays where they end.
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { server_state, until } from './browser';
import { opened_before, started } from './opened';
import { program } from './program';

const file = fileURLToPath(new URL('run.toml', import.meta.url));
const goal = 0.8;

describe.skipIf(!program)('tasks', () => {
  const opened = opened_before(() => started(['view', file]), 'live');
  const bend = async () => (await server_state(opened.page)).bends[0];
  const end = () => opened.page.waitForSelector('.running', { state: 'detached', timeout: 60_000 });

  test('play in real time, and stay where they end', async () => {
    const { page } = opened;
    expect(await page.getByLabel('Speed of the tasks').inputValue()).toBe('1');
    const begun = Date.now();
    await page.getByRole('button', { name: 'Run tasks' }).click();
    await page.waitForSelector('.running');
    await until(async () => (await bend()) > 0.05, 15_000, 'the arm does not move');
    expect(await bend()).toBeLessThan(0.7 * goal);
    await end();
    // The task lasts 4 s.
    expect(Date.now() - begun).toBeGreaterThan(3500);
    await page.waitForTimeout(500);
    expect(await bend()).toBeCloseTo(goal, 5);
  });

  test('go back by Reset, and are played again by one click', async () => {
    const { page } = opened;
    await page.getByRole('button', { name: 'Reset' }).click();
    await until(async () => Math.abs(await bend()) < 1e-6);
    await page.getByRole('button', { name: 'Replay' }).click();
    await page.waitForSelector('.badge[data-kind="recording"]');
    const time = async () => Number(await page.locator('#scrub').inputValue());
    await until(async () => (await time()) > 0.3);
    expect(await page.locator('#play').getAttribute('aria-label')).toBe('Pause');
    await page.getByRole('button', { name: 'To the rig' }).click();
    await page.waitForSelector('.badge[data-kind="live"]');
  });

  test('are halted where they are', async () => {
    const { page } = opened;
    await page.getByRole('button', { name: 'Run tasks' }).click();
    await page.waitForSelector('.running');
    await until(async () => (await bend()) > 0.05, 15_000);
    await page.getByRole('button', { name: 'Halt' }).click();
    await end();
    const halted = await bend();
    expect(halted).toBeLessThan(0.9 * goal);
    await page.waitForTimeout(700);
    expect(await bend()).toBeCloseTo(halted, 5);
  });

  test('play as fast as possible when that is chosen, also while they run', async () => {
    const { page, complaints } = opened;
    const speed = page.getByLabel('Speed of the tasks');
    await speed.selectOption({ label: '0.25 ×' });
    await page.getByRole('button', { name: 'Run tasks' }).click();
    await page.waitForSelector('.running');
    await page.waitForTimeout(1000);
    expect(await page.locator('.running').count()).toBe(1);
    const chosen = Date.now();
    await speed.selectOption({ label: 'As fast as possible' });
    await end();
    // At the former speed, 15 s were left.
    expect(Date.now() - chosen).toBeLessThan(13000);
    await until(async () => Math.abs((await bend()) - goal) < 1e-5);
    await speed.selectOption({ label: '1 × real time' });
    expect(complaints).toEqual([]);
  });
});
