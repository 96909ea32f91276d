// Pushing elastic arms in the 3D view and by numbers.
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { describe, expect, test } from 'vitest';
import { ask_server, server_state, slide, tip_on_screen, until } from './browser';
import { opened_before, recorded, started } from './opened';
import { program } from './program';

const file = fileURLToPath(new URL('push.toml', import.meta.url));
const example = (name: string): string => fileURLToPath(new URL(`../../../examples/${name}/experiment.toml`, import.meta.url));

const distance = (a: number[], b: number[]): number => Math.hypot(...a.map((x, i) => x - b[i]));

/** Returns the screen position of the arm's point at s, once the view no longer changes: layout and view point move it. */
async function resting_place(page: Page, s: number): Promise<{ x: number; y: number }> {
  let last = await tip_on_screen(page, s);
  for (let still = 0; still < 5;) {
    await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => setTimeout(done, 50))));
    const now = await tip_on_screen(page, s);
    still = Math.hypot(now.x - last.x, now.y - last.y) < 0.5 ? still + 1 : 0;
    last = now;
  }
  return last;
}

/** Drags the arm's point at s by some pixels and holds it there. */
async function drag(page: Page, s: number, dx: number, dy = 0): Promise<void> {
  const { x, y } = await resting_place(page, s);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= 5; ++i) await page.mouse.move(x + (dx * i) / 5, y + (dy * i) / 5);
}

/** Front view: right is along x. */
async function from_front(page: Page): Promise<void> {
  await page.locator('#stage').focus();
  await page.keyboard.press('1');
}

const released = async (page: Page): Promise<boolean> => !(await server_state(page)).push.length;

describe.skipIf(!program)('an arm in motion', () => {
  const opened = opened_before(() => started(file), 'live');

  test('moves when it is dragged with Shift, and swings and settles after that', async () => {
    const { page, complaints } = opened;
    await until(async () => !(await server_state(page)).is_moving);
    const rest = await server_state(page);
    expect(rest.energy).toHaveLength(3);
    await from_front(page);
    await page.keyboard.down('Shift');
    await drag(page, 0.35, -90);
    await page.keyboard.up('Shift');
    await until(async () => distance((await server_state(page)).tip, rest.tip) > 0.02, 20000, 'the arm does not move');
    const pushed = await server_state(page);
    expect(pushed.push[0]).toBeGreaterThan(0.3);
    expect(pushed.push[1]).toBeLessThan(rest.tip[0]);
    expect(pushed.is_moving).toBe(true);
    await until(async () => /^\d.* N$/.test(await page.locator('#push-label').textContent() ?? ''), 8000, 'no force is shown');
    await page.mouse.up();
    await until(() => released(page), 8000, 'it is not released');
    expect(await page.locator('#push-label').count()).toBe(0);
    // Its elastic energy is converted to motion, which is damped.
    await until(async () => (await server_state(page)).energy[0] > 1e-5, 8000, 'it does not swing');
    await until(async () => !(await server_state(page)).is_moving, 60000, 'it does not come to rest');
    expect(distance((await server_state(page)).tip, rest.tip)).toBeLessThan(2e-3);
    expect(complaints).toEqual([]);
  }, 120000);

  test('is pushed by the tool, against a post whose contacts are listed', async () => {
    const { page, complaints } = opened;
    await page.getByRole('tab', { name: 'Forces' }).click();
    await page.getByText('No contacts.').waitFor();
    await from_front(page);
    await page.keyboard.press('g');
    expect(await page.locator('.push-tool').getAttribute('aria-pressed')).toBe('true');
    await page.getByText('Push: drag a point of the arm').waitFor();
    await drag(page, 0.4, 220);
    await page.locator('#contacts tbody tr').first().waitFor({ timeout: 30000 });
    const { contacts } = await server_state(page);
    expect(contacts.length).toBeGreaterThan(0);
    expect(contacts[0][0]).toBe(0);
    expect(contacts[0][5]).toBeLessThan(0);
    expect(await page.locator('#contacts tbody th').first().textContent()).toBe('post');
    await until(async () => /slides|sticks/.test(await page.locator('#contacts tbody tr').first().textContent() ?? ''));
    await page.mouse.up();
    await page.getByText('No contacts.').waitFor({ timeout: 30000 });
    await page.keyboard.press('Escape');
    await until(async () => (await page.locator('.push-tool').getAttribute('aria-pressed')) === 'false');
    expect(complaints).toEqual([]);
  }, 120000);

  test('is pushed by numbers, and shows its energy', async () => {
    const { page, complaints } = opened;
    await until(async () => !(await server_state(page)).is_moving, 60000, 'it does not come to rest');
    const rest = await server_state(page);
    await slide(page, '#push-s', 0.4);
    await page.getByLabel('Force along Z, N').fill('0.1');
    await page.getByLabel('Force along Z, N').press('Enter');
    await page.getByLabel('Force along X, N').fill('0');
    await page.getByLabel('Force along X, N').press('Enter');
    await page.locator('#push-apply').click();
    await until(async () => (await server_state(page)).tip[2] > rest.tip[2] + 5e-3, 20000, 'it does not move');
    const { push } = await server_state(page);
    expect(push[4]).toBeCloseTo(0, 6);
    expect(push[6]).toBeCloseTo(0.1, 6);
    await page.getByText(/^Pushed by 0\.10 N at s = 0\.4000 m$/).waitFor();
    expect(await page.locator('#energy').textContent()).toMatch(/Kinetic.*J.*Elastic.*J.*Gravity.*J.*Total.*J/);
    await page.getByLabel('Plot 1 shows').selectOption('energy');
    await page.locator('.plot').first().getByText('kinetic').waitFor();
    await page.locator('#push-release').click();
    await until(() => released(page));
    expect(complaints).toEqual([]);
  }, 120000);

  test('refuses a bad push in one line', async () => {
    const { page } = opened;
    const refused = (request: Record<string, unknown>): Promise<string> =>
      ask_server(page, { do: 'push', ...request }).then(() => 'taken', (error: Error) => error.message);
    expect(await refused({ s: 3, force: [0, 0, 0.1] })).toMatch(/s = 3: expected 0 to 0.4 m/);
    expect(await refused({ s: 0.2, force: [0, 0, 1e6] })).toMatch(/force: 1e\+06 N: expected at most .* N/);
    expect(await refused({ s: 0.2, force: [0, 0, null] })).toMatch(/force\[2\]/);
    expect(await refused({ s: 0.2 })).toMatch(/expected one of to .* and force/);
    expect(await refused({ s: 0.2, to: [0, 0, 0], stiffness: -1 })).toMatch(/stiffness = -1/);
    expect(await released(page)).toBe(true);
  });
});

describe.skipIf(!program)('an arm at rest', () => {
  const opened = opened_before(() => started(example('09_tendon_statics')), 'live');

  test('goes to the equilibrium under a push, and returns', async () => {
    const { page, complaints } = opened;
    const rest = await server_state(page);
    await from_front(page);
    await page.keyboard.press('g');
    await drag(page, 0.2, 80);
    await until(async () => distance((await server_state(page)).tip, rest.tip) > 1e-3, 20000, 'the arm does not move');
    const pushed = await server_state(page);
    expect(pushed.energy).toEqual([]);
    expect(Math.hypot(...pushed.push.slice(4))).toBeGreaterThan(0);
    await page.mouse.up();
    await until(async () => distance((await server_state(page)).tip, rest.tip) < 1e-4, 8000, 'it does not return');
    expect(complaints).toEqual([]);
  });
});

describe.skipIf(!program)('a recording of an arm that grasps', () => {
  const opened = opened_before(() => recorded(example('13_grasp')), 'recording');

  test('shows its energy and what it touches', async () => {
    const { page, complaints } = opened;
    await page.getByRole('tab', { name: 'Forces' }).click();
    await page.getByText('No contacts.').waitFor();
    await slide(page, '#scrub', 3.9);
    await page.locator('#contacts tbody tr').first().waitFor();
    expect(await page.locator('#contacts tbody th').first().textContent()).toBe('post');
    expect(await page.locator('#energy').textContent()).toMatch(/Elastic[\d.]+ J/);
    expect(await page.locator('#push-apply').count()).toBe(0);
    const options = await page.getByLabel('Plot 1 shows').locator('option').allTextContents();
    expect(options).toContain('Energy, J');
    expect(options).toContain('Contact force, N');
    expect(options).toContain('Tension, N');
    expect(complaints).toEqual([]);
  });
});
