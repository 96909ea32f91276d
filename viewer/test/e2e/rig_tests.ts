// What one does with a live rig that has an arm with tendons and two cameras: the fake one, or the program's.
import { readFileSync } from 'node:fs';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import {
  colors_in, launch, open_page, orbit_of, server_state, slide, stage_at_rest, stage_picture, tip_on_screen, until,
} from './browser';

export interface Served {
  readonly url: string;
  stop(): Promise<void>;
}

/** The tests of a live rig; `fake`, where it is that one, can be looked into. */
export function rig_tests(start: () => Promise<Served>, fake: () => FakeServer | null = () => null): void {
  let browser: Browser;
  let served: Served;
  let page: Page;
  let complaints: string[];

  beforeAll(async () => {
    browser = await launch();
    served = await start();
    ({ page, complaints } = await open_page(browser, served.url));
    await page.waitForSelector('.badge[data-kind="live"]');
    await page.waitForSelector('.section .slider');
  });

  afterAll(async () => {
    await browser?.close();
    await served?.stop();
  });

  const stage = () => stage_at_rest(page);

  test('the token leaves the address', () => {
    expect(page.url()).not.toContain('token');
  });

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
    expect(azimuth).toBeLessThan(0);
    expect(elevation).toBeGreaterThan(0);
    await page.keyboard.press('Numpad0');
  });

  test('a double click looks at what is there, also through the picture of the camera that stands before it', async () => {
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
    await page.keyboard.press('1');
    // The pictures hang in the view a moment later.
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

  test('the arrow keys move a slider that has the focus, and do not step the time', async () => {
    const slider = page.locator('.section .slider input[type="range"]').first();
    await slider.focus();
    const before = Number(await slider.inputValue());
    await page.keyboard.press('ArrowLeft');
    await until(async () => Number(await slider.inputValue()) < before);
    expect(await page.locator('.badge[data-kind="live"]').count()).toBe(1);
    await slider.blur();
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
    await page.waitForTimeout(1500);
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
    // A bend towards y leaves less of the same limit towards x.
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
    if (fake()) {
      const tips = fake()!.log.filter((request) => request.do === 'tip');
      expect(tips.length).toBeGreaterThan(0);
      const { tip } = await server_state(page);
      const asked = tips.at(-1)!.position as number[];
      await until(async () => Math.hypot(...(await server_state(page)).tip.map((p, i) => p - asked[i])) < 0.01);
      expect(Math.hypot(...tip)).toBeGreaterThan(0);
    }
  });

  test('a click on the arm picks a point of the backbone and says what is true of it', async () => {
    await page.keyboard.press('0');
    await page.waitForTimeout(600);
    // The base is in the middle of the view, a little way below: from there up to find the arm's foot.
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
    await tab_to('button[aria-label="Pick nothing"], .picked button');
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

  test('pictures of the cameras come, and a pixel’s value is the server’s', async () => {
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
    const camera = page.locator('.picture canvas').first();
    expect(await colors_in(page, await camera.screenshot())).toBeGreaterThan(3);
    // A rig at rest: the picture that is served shows what the page was sent.
    await page.keyboard.press('Backspace');
    await until(async () => Math.hypot(...(await server_state(page)).bends) < 1e-6);
    await page.waitForTimeout(800);
    const said = page.locator('.pixel dd');
    const values = new Set<number>();
    const box = (await camera.boundingBox())!;
    for (const part of [0.5, 0.1]) {
      await camera.hover({ position: { x: part * box.width, y: 0.5 * box.height } });
      const u = Math.floor(part * 640);
      await until(async () => new RegExp(`\\((${u - 1}|${u}|${u + 1}), `).test((await said.first().textContent()) ?? ''));
      const place = /\((\d+), (\d+)\)/.exec((await said.first().textContent())!)!;
      const served = await served_pixel(Number(place[1]), Number(place[2]));
      await until(async () => (await said.nth(1).textContent()) === `${served} of 255`, 5000, `the server’s value is ${served}`);
      values.add(served);
    }
    expect(values.size).toBe(2);
    const before = await said.first().textContent();
    await camera.focus();
    await page.keyboard.press('ArrowRight');
    await until(async () => (await said.first().textContent()) !== before);
  });

  /** Of the front camera's picture, as the server gives it losslessly. */
  const served_pixel = (u: number, v: number): Promise<number> => page.evaluate(async ([x, y]) => {
    const answer = await fetch('image/front.png');
    const bitmap = await createImageBitmap(await answer.blob());
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d')!;
    context.drawImage(bitmap, 0, 0);
    return context.getImageData(x, y, 1, 1).data[0];
  }, [u, v]);

  test('the exact picture can be saved', async () => {
    const [download] = await Promise.all([
      page.waitForEvent('download'), page.getByRole('link', { name: 'Save the exact picture of front' }).click(),
    ]);
    expect(download.suggestedFilename()).toBe('front.png');
    const bytes = readFileSync(await download.path());
    expect([...bytes.subarray(0, 4)]).toEqual([0x89, 0x50, 0x4e, 0x47]);
  });

  test('a live plot’s window slides with the time', async () => {
    // The line of time goes over what is remembered; the dashed line says where in it the pointer’s instant is.
    const now = () => page.locator('#scrub').evaluate((scrub: HTMLInputElement) => ({ from: Number(scrub.min), to: Number(scrub.max) }));
    if (fake()) fake()!.session.time += 25;
    await until(async () => (await now()).to - (await now()).from > 22, 25000, 'no 22 s are remembered');
    const chart = (await page.locator('.chart .u-over').first().boundingBox())!;
    const left_end = async (): Promise<number> => {
      await page.mouse.move(chart.x + 30, chart.y + 30);
      await page.mouse.move(chart.x + 1, chart.y + 30);
      await page.locator('.rail .hover').waitFor({ state: 'attached' });
      const part = await page.locator('.rail .hover').evaluate((line: HTMLElement) => parseFloat(line.style.left) / 100);
      const { from, to } = await now();
      return from + part * (to - from);
    };
    const first = await left_end();
    expect(Math.abs((await now()).to - first - 20)).toBeLessThan(2);
    await page.waitForTimeout(2500);
    expect((await left_end()) - first).toBeGreaterThan(1.5);
    await page.mouse.move(chart.x + 30, chart.y - 200);
  });

  test('an eye hides each thing that is there', async () => {
    await page.keyboard.press('0');
    // From farther away and aside, so that cameras and screens are in sight.
    for (const key of ['PageDown', 'Alt+ArrowRight']) for (let i = 0; i < 6; ++i) await page.keyboard.press(key);
    await slide(page, '.section .slider input[type="range"]', 0.7);
    await until(async () => Math.abs((await server_state(page)).bends[0]) > 0.3);
    await page.getByRole('tab', { name: 'Scene' }).click();
    const first = await stage();
    let picture = first;
    const eyes = page.getByRole('button', { name: /^Show: / });
    const names = (await eyes.evaluateAll((all) => all.map((eye) => eye.getAttribute('aria-label')!))).filter((name) => !/Ghosts/.test(name));
    for (const word of ['Arm', 'Trail', 'Camera “front”', 'Screen 1', ...(fake() ? ['Calibration', 'Obstacle “ball”', 'Obstacle “ground”'] : [])]) {
      expect(names.join()).toContain(word);
    }
    // The program shows the same page: of its things two are enough.
    const hidden = fake() ? names : names.filter((name) => /Arm|Trail/.test(name));
    for (const name of hidden) {
      const eye = page.getByRole('button', { name, exact: true });
      await eye.click();
      expect(await eye.getAttribute('aria-pressed'), name).toBe('false');
      const now = await stage();
      expect(now.equals(picture), name).toBe(false);
      picture = now;
    }
    for (const name of hidden) await page.getByRole('button', { name, exact: true }).click();
    expect((await stage()).equals(first)).toBe(true);
    await page.getByRole('tab', { name: 'Arm' }).click();
    await page.keyboard.press('Backspace');
    await page.keyboard.press('0');
  });

  test('Space holds the view and says so; the slider of time goes back; Space returns to now', async () => {
    await page.locator('.section .slider input[type="range"]').first().focus();
    await page.keyboard.press('Space');
    await page.waitForSelector('.badge[data-kind="held"]');
    const shown = () => page.locator('#time').textContent();
    const at = await shown();
    expect(await page.locator('.picture .now').count()).toBe(2);
    await page.waitForTimeout(400);
    expect(await shown()).toBe(at);
    await page.locator('.section .slider input[type="range"]').first().blur();
    await page.keyboard.press('Shift+ArrowLeft');
    expect(await shown()).not.toBe(at);
    await page.keyboard.press('Space');
    await page.waitForSelector('.badge[data-kind="live"]');
    expect(await shown()).toContain('now');
  });

  test('light and dark', async () => {
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const before = await ground();
    await page.keyboard.press('l');
    await until(async () => (await ground()) !== before);
    expect(await page.locator('html').getAttribute('data-theme')).toBe('light');
    await page.keyboard.press('l');
    expect(await ground()).toBe(before);
  });

  test('help lists the keys; switched off, they do nothing', async () => {
    await page.keyboard.press('F1');
    await page.waitForSelector('dialog.help[open]');
    const help = (await page.locator('dialog.help').textContent())!;
    for (const word of ['Space', 'F1', 'Esc', 'Backspace', '[', ']', 'Halt', 'Drag']) expect(help).toContain(word);
    const box = page.getByLabel('Keys are on');
    await box.uncheck();
    await page.keyboard.press('Escape');
    await until(async () => (await page.locator('dialog.help[open]').count()) === 0);
    await page.locator('.section .slider input[type="range"]').first().focus();
    for (const key of ['Space', 'l', 'F1', ']']) await page.keyboard.press(key);
    expect(await page.locator('.badge[data-kind="live"]').count()).toBe(1);
    expect(await page.locator('html').getAttribute('data-theme')).toBe('dark');
    expect(await page.locator('dialog.help[open]').count()).toBe(0);
    await page.getByRole('button', { name: 'Help and keys' }).click();
    await box.check();
    await page.keyboard.press('Escape');
  });

  test('every control has a name', async () => {
    const unnamed = await page.evaluate(() =>
      [...document.querySelectorAll<HTMLElement>('button, input, select, a, canvas[tabindex]')]
        .filter((element) => {
          const label = element.id && document.querySelector(`label[for="${CSS.escape(element.id)}"]`);
          return !(element.getAttribute('aria-label') || element.textContent?.trim() || label || element.closest('label') || element.ariaHidden);
        })
        .map((element) => element.outerHTML.slice(0, 120)));
    expect(unnamed).toEqual([]);
  });

  test('nothing lies outside of the window at 1280 by 720', async () => {
    await page.setViewportSize({ width: 1280, height: 720 });
    await page.waitForTimeout(300);
    const over = await page.evaluate(() => ({
      page: [document.documentElement.scrollWidth, document.documentElement.scrollHeight],
      right: (() => {
        const right = document.querySelector('.right')!;
        return right.scrollHeight - right.clientHeight;
      })(),
      header: (() => {
        const last = document.querySelector('.header .tools:last-child')!.getBoundingClientRect();
        return last.right;
      })(),
    }));
    expect(over.page).toEqual([1280, 720]);
    expect(over.right).toBeLessThanOrEqual(0);
    expect(over.header).toBeLessThanOrEqual(1280);
  });

  test('on a projector, the page enlarged, nothing lies upon another in the cameras’ column', async () => {
    await page.setViewportSize({ width: 853, height: 480 });
    await page.waitForTimeout(300);
    const { boxes, over } = await page.evaluate(() => ({
      boxes: [...document.querySelectorAll('.right .picture, .right figcaption, .right .pixel')].map((part) => {
        const { top, bottom } = part.getBoundingClientRect();
        return { top, bottom };
      }),
      over: (({ scrollHeight, clientHeight }) => scrollHeight - clientHeight)(document.querySelector('.right')!),
    }));
    expect(boxes).toHaveLength(5);
    for (let i = 1; i < boxes.length; ++i) expect(boxes[i].top).toBeGreaterThanOrEqual(boxes[i - 1].bottom - 0.5);
    expect(over).toBeGreaterThan(0);
  });

  test('the browser had nothing to complain of, the security policy neither', () => {
    expect(complaints).toEqual([]);
  });
}
