// Moving a live rig: sliders, keys, tasks, and dragging the tip.
import type { Page } from 'playwright-core';
import { beforeAll, expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import { ask_server, type Opened, server_state, slide, tip_on_screen, until } from './browser';

/** The arm follows the sliders. */
export function slider_tests(opened: Opened, fake: () => FakeServer | null): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('a slider moves the arm, as another client sees', async () => {
    const before = await server_state(page);
    const slider = page.locator('.section .slider input[type="range"]').first();
    const max = Number(await slider.getAttribute('max'));
    await slide(page, `#${await slider.getAttribute('id')}`, 0.3 * max);
    await until(async () => {
      const { bends } = await server_state(page);
      return Math.abs(bends[0] - before.bends[0]) > 0.1;
    });
    if (fake()) await until(async () => Math.abs((await server_state(page)).bends[0] - 0.3 * max) < 0.01);
  });
}

/** Keys, and the focused slider. */
export function focus_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('the arrow keys move a slider that has the focus, and do not step the time', async () => {
    const slider = page.locator('.section .slider input[type="range"]').first();
    await slider.focus();
    const before = Number(await slider.inputValue());
    await page.keyboard.press('ArrowLeft');
    await until(async () => Number(await slider.inputValue()) < before);
    expect(await page.locator('.badge[data-kind="live"]').count()).toBe(1);
    await slider.blur();
  });
}

/** Everything moved by sliders, keys and tasks. */
export function steer_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('a tendon’s slider stays where it was put, and takes the others along', async () => {
    await page.keyboard.press('Backspace');
    await until(async () => Math.hypot(...(await server_state(page)).bends) < 1e-3);
    await page.getByRole('button', { name: 'Tendons' }).click();
    const slider = page.locator('#arm-tendons-0');
    await until(async () => Math.abs(Number(await slider.inputValue())) < 1e-4);
    await slide(page, '#arm-tendons-0', 0.006);
    await until(async () => Math.abs((await server_state(page)).displacements[0] - 0.006) < 1e-4);
    const { displacements } = await server_state(page);
    expect(displacements[1]).toBeCloseTo(-0.003, 3);
    expect(displacements[2]).toBeCloseTo(-0.003, 3);
    expect(Math.abs(displacements[3])).toBeGreaterThan(1e-3);
    await page.waitForTimeout(1000);
    expect(Number(await slider.inputValue())).toBeCloseTo(0.006, 3);
    expect(Number(await page.locator('#arm-tendons-1').inputValue())).toBeCloseTo(-0.003, 3);
    await page.getByRole('button', { name: 'Bends' }).click();
  });

  test('H stops the arm on its way; Backspace brings everything back, and so does Reset', async () => {
    const bend = async () => (await server_state(page)).bends[0];
    for (const reset of [() => page.keyboard.press('Backspace'), () => page.getByRole('button', { name: 'Reset' }).click()]) {
      await slide(page, '.section .slider input[type="range"]', -1.8);
      await until(async () => Math.abs(await bend()) > 0.02);
      await page.keyboard.press('h');
      await page.waitForTimeout(300);
      const stopped = await bend();
      expect(stopped).toBeGreaterThan(-1.7);
      await page.waitForTimeout(400);
      expect(await bend()).toBeCloseTo(stopped, 5);
      await reset();
      await until(async () => Math.abs(await bend()) < 1e-6);
    }
  });

  test('a run of tasks keeps hands off, and Halt ends it', async () => {
    await page.keyboard.press('r');
    await until(async () => (await server_state(page)).is_running);
    await until(() => page.locator('.section .slider input').first().isDisabled());
    expect(await page.getByLabel('Tip’s X, m').isDisabled()).toBe(true);
    await page.getByRole('tab', { name: 'Cameras' }).click();
    expect(await page.locator('input[id^="head-"]').first().isDisabled()).toBe(true);
    await page.getByRole('tab', { name: 'Arm' }).click();
    await page.getByRole('button', { name: 'Halt' }).click();
    await until(async () => !(await server_state(page)).is_running);
    await until(async () => !(await page.locator('.section .slider input').first().isDisabled()));
    await page.getByRole('button', { name: 'Dismiss' }).first().click();
    await page.keyboard.press('Backspace');
  });

  test('a camera’s head turns, tilts and zooms by its sliders', async () => {
    await page.getByRole('tab', { name: 'Cameras' }).click();
    const places = { pan: 7, tilt: 8, zoom: 9 };
    const goes_to = async (axis: keyof typeof places, value: number): Promise<void> => {
      await slide(page, `[id="head-front-${axis}"]`, value);
      await until(async () => Math.abs((await server_state(page)).camera[places[axis]] - value) < 0.02);
    };
    const focal = async () => (await server_state(page)).camera[13];
    const before = await focal();
    for (const [axis, value] of [['pan', 0.1], ['tilt', -0.08], ['zoom', 1.5]] as const) await goes_to(axis, value);
    expect((await focal()) / before).toBeCloseTo(1.5, 1);
    for (const [axis, value] of [['pan', 0], ['tilt', 0], ['zoom', 1]] as const) await goes_to(axis, value);
  });

  test('limits are marked, and what lies beyond them is shaded', async () => {
    await page.getByRole('tab', { name: 'Arm' }).click();
    const slider = page.locator('.section .slider').first();
    const shaded = () => slider.locator('.unreachable').evaluateAll((all) => all.map((each) => each.getBoundingClientRect().width));
    await until(async () => Math.abs((await shaded())[0] - (await shaded())[1]) < 2);
    const [before] = await shaded();
    expect(before).toBeGreaterThan(2);
    expect(await slider.locator('.limit').count()).toBe(2);
    // A bend towards y reduces the remaining range towards x.
    const other = page.locator('.section .slider input[type="range"]').nth(1);
    await slide(page, `#${await other.getAttribute('id')}`, 1.9);
    await until(async () => (await shaded())[0] > 1.5 * before);
    await page.keyboard.press('Backspace');
    await until(async () => Math.abs((await shaded())[0] - before) < 1);
    await page.getByRole('tab', { name: 'Cameras' }).click();
  });

  test('a camera’s stage moves by its slider', async () => {
    await slide(page, '[id="stage-front-x"]', 0.1);
    await until(async () => Math.abs((await server_state(page)).camera[10] - 0.1) < 1e-3);
    await slide(page, '[id="stage-front-x"]', 0);
    await until(async () => Math.abs((await server_state(page)).camera[10]) < 1e-3);
  });
}

/** Dragging the tip. */
export function drag_tests(opened: Opened, fake: () => FakeServer | null): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('the tip follows the hand by inverse kinematics', async () => {
    await page.getByRole('tab', { name: 'Arm' }).click();
    await page.keyboard.press('Escape');
    await page.keyboard.press('1');
    await page.waitForTimeout(600);
    const from = await tip_on_screen(page);
    const before = (await server_state(page)).tip;
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    await page.mouse.move(from.x - 50, from.y + 30, { steps: 8 });
    await page.waitForSelector('#tip-note');
    await page.waitForTimeout(400);
    await page.mouse.up();
    expect(await page.locator('#tip-note').count()).toBe(0);
    await until(async () => {
      const { tip } = await server_state(page);
      return tip[0] < before[0] - 0.01 && tip[1] < before[1];
    });
    // The release position, in the plane that faced the viewer.
    const wanted = { x: from.x - 50, y: from.y + 30 };
    await until(async () => {
      const at = await tip_on_screen(page);
      return Math.hypot(at.x - wanted.x, at.y - wanted.y) < 3;
    }, 8000, 'the tip is not where it was dragged to');
    expect(Math.abs((await server_state(page)).tip[2] - before[2])).toBeLessThan(0.01);
    if (fake()) {
      const tips = fake()!.log.filter((request) => request.do === 'tip');
      expect(tips.length).toBeGreaterThan(0);
      const { tip } = await server_state(page);
      const asked = tips.at(-1)!.position as number[];
      await until(async () => Math.hypot(...(await server_state(page)).tip.map((p, i) => p - asked[i])) < 0.01);
      expect(Math.hypot(...tip)).toBeGreaterThan(0);
    }
  });
}

/** Points of the backbone are picked with and without a mouse. */
export function pick_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('a click on the arm picks a point of the backbone and says what is true of it', async () => {
    await page.keyboard.press('0');
    await page.waitForTimeout(600);
    // The base is slightly below the middle of the view: the arm's foot is above it.
    const base = await tip_on_screen(page, 0);
    await page.mouse.click(base.x, base.y - 3);
    await page.waitForSelector('.picked', { timeout: 5000 });
    const text = await page.locator('.picked').textContent();
    for (const word of ['Curvature', 'Bending plane', 'Position', 'section']) expect(text).toContain(word);
    const before = await page.locator('.picked dd').first().textContent();
    await slide(page, '#picked-s', 0.1);
    expect(await page.locator('.picked dd').first().textContent()).not.toBe(before);
    await page.keyboard.press('Escape');
    expect(await page.locator('.picked').count()).toBe(0);
  });

  test('without a mouse: K picks the tip, the rest is Tab, Enter and arrows', async () => {
    const tab_to = async (selector: string): Promise<void> => {
      for (let i = 0; i < 150; ++i) {
        await page.keyboard.press('Tab');
        if (await page.evaluate((wanted) => document.activeElement?.matches(wanted) ?? false, selector)) return;
      }
      throw new Error(`Tab does not come to ${selector}`);
    };
    await page.keyboard.press('k');
    const s = page.locator('.picked dd').first();
    const at_tip = await s.textContent();
    expect(at_tip).toContain('section 3');
    await tab_to('#picked-s');
    for (let i = 0; i < 3; ++i) await page.keyboard.press('PageDown');
    await until(async () => (await s.textContent()) !== at_tip);
    await tab_to('button[aria-label="Clear selection"], .picked button');
    await page.keyboard.press('Enter');
    expect(await page.locator('.picked').count()).toBe(0);
    await page.keyboard.press('k');
    await page.keyboard.press('k');
    expect(await page.locator('.picked').count()).toBe(0);
    await tab_to('.view-switch button:nth-child(2)');
    await page.keyboard.press('Enter');
    expect(await page.locator('.view-switch button[aria-pressed="true"]').textContent()).toBe('front');
    await page.keyboard.press('Escape');
    await tab_to('.section .slider input[type="range"]');
    const before = (await server_state(page)).bends[0];
    await page.keyboard.press('ArrowRight');
    await until(async () => (await server_state(page)).bends[0] > before + 0.01);
    await page.evaluate(() => (document.activeElement as HTMLElement).blur());
    await page.keyboard.press('Backspace');
  });
}

/** Values of a picked point. */
export function point_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  test('what is said of a picked point is what the server says of it', async () => {
    const wanted = [[0.4, 0.25], [-0.3, 0.35], [0.15, -0.4]];
    await ask_server(page, { do: 'arm', bends: wanted });
    // At rest: two consecutive states are equal.
    let before: number[] = [];
    await until(async () => {
      const { bends } = await server_state(page);
      const is_there = bends.every((bend, i) => Math.abs(bend - wanted.flat()[i]) < 0.05 && bend === before[i]);
      before = bends;
      return is_there;
    }, 15000, 'the arm does not come to rest where it was sent');
    await page.keyboard.press('k');
    const span = Number(await page.locator('#picked-s').getAttribute('max'));
    const numbers = (text: string | null): number[] => (text!.replaceAll('−', '-').match(/-?\d+\.?\d*/g) ?? []).map(Number);
    const sections = new Set<number>();
    for (const share of [0.05, 0.2, 0.45, 0.6, 0.8, 1]) {
      await slide(page, '#picked-s', share * span);
      const s = Number(await page.locator('#picked-s').inputValue());
      const point = await ask_server<{ position: number[]; tangent: number[]; curvature: number; bending_plane: number; section: number }>(
        page, { do: 'point', s });
      const said = async (name: string) =>
        numbers(await page.locator('.picked dl div').filter({ has: page.locator('dt', { hasText: new RegExp(`^${name}$`) }) }).locator('dd').textContent());
      const [at, section] = await said('s');
      expect(at).toBeCloseTo(s, 3);
      expect(section).toBe(point.section + 1);
      sections.add(section);
      const [curvature, , radius] = await said('Curvature');  // "1.6 1/m (radius 0.6 m)"
      expect(Math.abs(curvature - point.curvature), `curvature at ${s}`).toBeLessThan(0.002);
      expect(Math.abs(radius * point.curvature - 1)).toBeLessThan(0.002);
      const [plane] = await said('Bending plane');
      const off = plane - (point.bending_plane * 180) / Math.PI;
      expect(Math.abs(off - 360 * Math.round(off / 360)), `plane at ${s}`).toBeLessThan(0.2);
      (await said('Position')).forEach((p, i) => expect(Math.abs(p - point.position[i]), `position at ${s}`).toBeLessThan(2e-4));
      (await said('Tangent')).forEach((t, i) => expect(Math.abs(t - point.tangent[i])).toBeLessThan(0.002));
    }
    expect(sections.size).toBe(3);
    await page.keyboard.press('Escape');
    await page.keyboard.press('Backspace');
    await until(async () => (await server_state(page)).bends.every((bend) => Math.abs(bend) < 1e-3), 15000);
  });
}
