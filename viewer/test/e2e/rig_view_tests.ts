// The 3D view of a live rig and its viewpoints.
import type { Page } from 'playwright-core';
import { beforeAll, expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import {
  colors_in, type Opened, orbit_of, server_state, slide, stage_at_rest, stage_picture, stage_sharpened, tip_on_screen, until,
} from './browser';

/** Orbit, pan and zoom by mouse. */
export function orbit_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  const stage = () => stage_at_rest(page);

  test('the scene is not blank, and changes under orbit, pan and zoom', async () => {
    let picture = await stage();
    let orbit = await orbit_of(page);
    const first = orbit;
    expect(await colors_in(page, picture)).toBeGreaterThan(20);
    const box = (await page.locator('#stage').boundingBox())!;
    const drag = async (button: 'left' | 'right'): Promise<void> => {
      await page.mouse.move(box.x + 60, box.y + box.height - 60);
      await page.mouse.down({ button });
      await page.mouse.move(box.x + 220, box.y + box.height - 120, { steps: 5 });
      await page.mouse.up({ button });
    };
    const changes = async (what: (keyof typeof orbit)[], act: () => Promise<void>): Promise<void> => {
      await act();
      const [now, seen] = [await orbit_of(page), await stage()];
      for (const key of ['azimuth', 'elevation', 'distance', 'target'] as const) {
        if (what.includes(key)) expect(now[key]).not.toEqual(orbit[key]);
        else expect(now[key]).toEqual(orbit[key]);
      }
      expect(seen.equals(picture)).toBe(false);
      [orbit, picture] = [now, seen];
    };
    await changes(['azimuth', 'elevation'], () => drag('left'));
    expect(orbit.azimuth).toBeLessThan(first.azimuth);
    await changes(['target'], () => drag('right'));
    await changes(['distance'], () => page.mouse.wheel(0, 400));
    expect(orbit.distance).toBeGreaterThan(first.distance);
    expect(await colors_in(page, picture)).toBeGreaterThan(20);
  });
}

/** Keys, side views, double click and wheel. */
export function view_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  const stage = () => stage_at_rest(page);

  test('a picture of the 3D view shows nothing else, and stays as it is where nobody touches it', async () => {
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
    const clock = () => page.locator('#clock').textContent();
    const [first, began] = [await stage(), await clock()];
    await until(async () => (await clock()) !== began);
    expect((await stage()).equals(first)).toBe(true);
    const opacity = (value: string) => page.locator('#stage').evaluate((canvas, to) => (canvas.style.opacity = to), value);
    await opacity('0');
    expect(await colors_in(page, await stage_picture(page))).toBeLessThanOrEqual(3);
    await opacity('');
  });

  test('the keys 1, 3, 7 and the brackets change the view', async () => {
    const pictures: Buffer[] = [];
    for (const key of ['1', '3', '7']) {
      await page.keyboard.press(key);
      pictures.push(await stage());
    }
    expect(pictures[0].equals(pictures[1])).toBe(false);
    expect(pictures[1].equals(pictures[2])).toBe(false);
    expect(pictures[2].equals(pictures[0])).toBe(false);
    const pressed = () => page.locator('.view-switch button[aria-pressed="true"]').textContent();
    const names = await page.locator('.view-switch button').allTextContents();
    for (const name of [...names.slice(1), names[0]]) {
      await page.keyboard.press(']');
      expect(await pressed()).toBe(name);
    }
    await page.keyboard.press('[');
    expect(await pressed()).toBe(names.at(-1));
    await page.keyboard.press('Escape');
    expect(await pressed()).toBe(names[0]);
    await page.keyboard.press('0');
  });

  test('the numpad looks from the same sides, and turns the view', async () => {
    const sides = { Numpad1: [0, 0], Numpad3: [-Math.PI / 2, 0], Numpad7: [0, Math.PI / 2] };
    for (const [key, [azimuth, elevation]] of Object.entries(sides)) {
      await page.keyboard.press(key);
      const orbit = await orbit_of(page);
      expect([orbit.azimuth, orbit.elevation]).toEqual([azimuth, elevation]);
    }
    await page.keyboard.press('Numpad1');
    await page.keyboard.press('Numpad6');
    await page.keyboard.press('Numpad8');
    const { azimuth, elevation } = await orbit_of(page);
    expect(azimuth).toBeGreaterThan(0);
    expect(elevation).toBeGreaterThan(0);
    await page.keyboard.press('Numpad0');
  });

  test('a double click looks at what is there, also through the picture of the camera that stands before it', async () => {
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
    await page.keyboard.press('1');
    // The pictures in the view are updated with a delay.
    await page.waitForTimeout(600);
    const at = await tip_on_screen(page, 0.5);
    await page.mouse.dblclick(at.x, at.y);
    const { target } = await orbit_of(page);
    expect(Math.abs(target.x)).toBeLessThan(0.05);
    expect(Math.abs(target.z)).toBeLessThan(0.05);
    expect(Math.abs(target.y - 0.5)).toBeLessThan(0.05);
    await page.waitForTimeout(300);
    const box = (await page.locator('#stage').boundingBox())!;
    const seen = await tip_on_screen(page, target.y);
    expect(Math.hypot(seen.x - box.x - box.width / 2, seen.y - box.y - box.height / 2)).toBeLessThan(20);
    await page.keyboard.press('Escape');
    await page.keyboard.press('0');
  });

  test('the wheel goes neither into a point nor out of sight', async () => {
    const turn = (deltaY: number) => page.locator('#stage').evaluate((canvas, by) => {
      for (let i = 0; i < 80; ++i) canvas.dispatchEvent(new WheelEvent('wheel', { deltaY: by, cancelable: true }));
    }, deltaY);
    await turn(-200);
    const near = (await orbit_of(page)).distance;
    await turn(200);
    const far = (await orbit_of(page)).distance;
    expect(near).toBeCloseTo(0.02 * 0.75, 9);
    expect(far).toBeCloseTo(30 * 0.75, 9);
    await page.keyboard.press('0');
  });
}

/** Objects in the scene, and hiding them. */
export function eye_tests(opened: Opened, fake: () => FakeServer | null, whose: { page: boolean }): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  const stage = () => stage_at_rest(page);
  const names = async () => (await page.getByRole('button', { name: /^Show: / })
    .evaluateAll((eyes) => eyes.map((eye) => eye.getAttribute('aria-label')!))).filter((name) => !/Ghosts/.test(name));

  test('each thing that is there has an eye', async () => {
    await page.getByRole('tab', { name: 'Scene' }).click();
    const all = (await names()).join();
    for (const word of ['Arm', 'Trail', 'Camera “front”', 'Screen 1', ...(fake() ? ['Calibration', 'Obstacle “ball”', 'Obstacle “ground”'] : [])]) {
      expect(all).toContain(word);
    }
    await page.getByRole('tab', { name: 'Arm' }).click();
  });

  if (!whose.page) return;

  test('an eye hides each thing that is there', async () => {
    await page.keyboard.press('0');
    // From farther away and obliquely from above, so that cameras, screens and things on the floor are visible.
    for (const key of ['PageDown', 'Alt+ArrowLeft', 'Alt+ArrowUp']) for (let i = 0; i < 6; ++i) await page.keyboard.press(key);
    await slide(page, '.section .slider input[type="range"]', 0.7);
    await until(async () => Math.abs((await server_state(page)).bends[0]) > 0.3);
    await page.getByRole('tab', { name: 'Scene' }).click();
    const first = await stage();
    let picture = first;
    // One camera and one screen are tested as representatives.
    const hidden = (await names()).filter((name) => !/Camera “side”|Screen 2/.test(name));
    for (const name of hidden) {
      const eye = page.getByRole('button', { name, exact: true });
      await eye.click();
      expect(await eye.getAttribute('aria-pressed'), name).toBe('false');
      const now = await stage_sharpened(page);
      expect(now.equals(picture), name).toBe(false);
      picture = now;
    }
    for (const name of hidden) await page.getByRole('button', { name, exact: true }).click();
    expect((await stage()).equals(first)).toBe(true);
    await page.getByRole('tab', { name: 'Arm' }).click();
    await page.keyboard.press('Backspace');
    await page.keyboard.press('0');
  });
}
