// Shape representations of a planar arm: with the fake server, and with the program for the paper's arm.
import type { Page } from 'playwright-core';
import { beforeAll, describe, expect, test } from 'vitest';
import { planar_rig } from '../fake/rigs';
import { colors_in, server_state, slide, stage_at_rest, tip_on_screen, until } from './browser';
import { fileURLToPath } from 'node:url';
import { faked, opened_before, started, type Served } from './opened';
import { program } from './program';

function planar_tests(start: () => Promise<Served>): void {
  const opened = opened_before(start, 'live');
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  const pressed = () => page.locator('.segmented button[aria-pressed="true"]').textContent();

  test('its sliders are archings first, and one of them bends its section the other way by twice as much', async () => {
    expect(await pressed()).toBe('Archings');
    await slide(page, '#arm-archings-0', 0.15);
    await until(async () => Math.abs((await server_state(page)).bends[0] + 0.3) < 0.005);
    expect(Math.abs((await server_state(page)).bends[2])).toBeLessThan(1e-6);
  });

  test('a cord angle bends its own section, and turns back those after it', async () => {
    await page.getByRole('button', { name: 'Cord angles' }).click();
    const angle = async (i: number) => Number(await page.locator(`#arm-cord_angles-${i}`).inputValue());
    await until(async () => Math.abs((await angle(0)) - Math.PI / 2 - 0.15) < 0.01);
    const [third] = [await angle(2)];
    const wanted = (await angle(1)) + 0.1;
    await slide(page, '#arm-cord_angles-1', wanted);
    // The arching of section 2 is its cord angle minus the tangent angle at its start, 90° plus twice the first
    // arching.
    const arching = wanted - Math.PI / 2 - 0.3;
    await until(async () => Math.abs((await server_state(page)).bends[2] + 2 * arching) < 0.02);
    await until(async () => Math.abs((await angle(2)) - third) < 0.02);
    expect(await pressed()).toBe('Cord angles');
  });

  test('from the front and from the side a double click finds the arm from its foot to its end', async () => {
    await page.keyboard.press('Backspace');
    await until(async () => Math.hypot(...(await server_state(page)).bends) < 1e-3);
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
    for (const key of ['1', '3']) {
      await page.keyboard.press(key);
      await stage_at_rest(page);
      for (const s of [0.2, 0.4, 0.6, 0.8]) {
        const total = await page.locator('.section .slider').count();
        expect(total).toBe(8);
        const { x, y } = await tip_on_screen(page, 16 * s);
        await page.mouse.dblclick(x, y);
        const target = await page.evaluate(() => (globalThis as unknown as { flexura: { orbit(): { target: { x: number; y: number; z: number } } } }).flexura.orbit().target);
        expect(Math.hypot(target.x, target.z)).toBeLessThan(0.5);
        expect(Math.abs(target.y - 16 * s)).toBeLessThan(0.5);
        await page.keyboard.press('0');
        await page.waitForTimeout(100);
      }
    }
    expect(await colors_in(page, await stage_at_rest(page))).toBeGreaterThan(10);
    expect(opened.complaints).toEqual([]);
  });
}

// The fake server is used without the program.
const paper_arm = fileURLToPath(new URL('../../../examples/01_paper_arm/experiment.toml', import.meta.url));
if (program) describe('the paper’s arm, before the cameras that stand there without a word', () => planar_tests(() => started(paper_arm)));
else describe('a planar arm', () => planar_tests(() => faked(planar_rig())));
