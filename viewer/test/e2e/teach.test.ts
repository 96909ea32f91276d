// The teaching page, which needs no rig.
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { planar_rig } from '../fake/rigs';
import type { FakeServer } from '../fake/server';
import { legends, slide, until } from './browser';
import { faked, visit } from './opened';

let server: FakeServer;
let page: Page;
let complaints: string[];
const degree = Math.PI / 180;

beforeAll(async () => {
  server = await faked(planar_rig());
  ({ page, complaints } = await visit(`http://127.0.0.1:${server.port}/#/teach`, { dark: false }));
  await page.waitForSelector('.plane');
});

afterAll(() => server.stop());

const effector = () => page.locator('#effector').textContent();
const open = (name: string) => page.getByRole('button', { name }).first().click();
const done = (name: string) => until(async () => /Done/.test((await page.locator('#verdict').textContent()) ?? ''), 4000, name);
const set = (i: number, degrees: number) => slide(page, `#arching-${i}`, degrees * degree);

test('it starts with the paper’s arm in the paper’s place', async () => {
  expect(await effector()).toContain('(−10.738, 5.201)');
  expect(await page.locator('.recurrence tbody tr').count()).toBe(8);
  expect(await page.locator('math').count()).toBeGreaterThan(3);
});

test('values follow the hand', async () => {
  const joint = (await page.locator('.joint[data-tip="true"]').boundingBox())!;
  const before = await effector();
  await page.mouse.move(joint.x + joint.width / 2, joint.y + joint.height / 2);
  await page.mouse.down();
  await page.mouse.move(joint.x + 80, joint.y - 60, { steps: 6 });
  await page.mouse.up();
  expect(await effector()).not.toBe(before);
});

/** Computes an arm with these archings in small straight steps, independent of the page's formulas. */
function walked(lengths: number[], archings: number[]) {
  const steps = 20000;
  let [x, y, tangent] = [0, 0, Math.PI / 2];
  return lengths.map((length, i) => {
    const row = { tangent, x, y, cord: 0, cord_angle: 0, end_x: 0, end_y: 0 };
    for (let k = 0; k < steps; ++k) {
      const angle = tangent + (2 * archings[i] * (k + 0.5)) / steps;
      x += (length / steps) * Math.cos(angle);
      y += (length / steps) * Math.sin(angle);
    }
    tangent += 2 * archings[i];
    return { ...row, cord: Math.hypot(x - row.x, y - row.y), cord_angle: Math.atan2(y - row.y, x - row.x), end_x: x, end_y: y };
  });
}

test('the live values are those of the arm, whoever computes them', async () => {
  await open('The paper’s arm, free');
  const number = (text: string | null): number => Number(text!.replace('−', '-').replace('°', ''));
  const archings: number[] = [];
  for (const [i, degrees] of [20, -35, 80, 0, -10.5, 60, -75, 12].entries()) {
    await set(i, degrees);
    // Sliders are quantised.
    archings.push(Number(await page.locator(`#arching-${i}`).inputValue()));
    expect(Math.abs(archings[i] / degree - degrees)).toBeLessThan(0.2);
  }
  const rows = walked([2, 3, 1, 2, 4, 2, 1, 1], archings);
  const last = rows.at(-1)!;
  const [x, y] = /\((.+), (.+)\)/.exec((await effector())!)!.slice(1).map(number);
  expect(Math.hypot(x - last.end_x, y - last.end_y)).toBeLessThan(1e-3);
  for (const [i, row] of rows.entries()) {
    const line = page.locator('.recurrence tbody tr').nth(i);
    const cells = (await line.locator('td').allTextContents()).map(number);
    const wanted = [row.tangent / degree, archings[i] / degree, row.cord_angle / degree, row.cord, row.end_x, row.end_y];
    // Angles may differ by whole turns.
    wanted.forEach((value, k) => {
      const off = k < 3 ? ((((cells[k] - value + 180) % 360) + 360) % 360) - 180 : cells[k] - value;
      expect(Math.abs(off), `section ${i + 1}, column ${k + 1}`).toBeLessThan(k < 3 ? 0.051 : 6e-4);
    });
    await line.click();
    const ends = await page.locator('.equation').evaluateAll((all) => all.map((each) => [...each.querySelectorAll('mn')].at(-1)!.textContent));
    const shown = ends.map(number);
    [archings[i] / degree, row.cord, cells[2], row.end_x, row.end_y].forEach((value, k) =>
      expect(Math.abs(shown[k] - value), `section ${i + 1}, equation ${k + 1}`).toBeLessThan(k % 2 === 0 && k < 4 ? 0.051 : 6e-4));
  }
  await open('The paper’s arm, free');
});

test('between the lines of an equation there is room', async () => {
  const overlaps = () => page.evaluate(() => [...document.querySelectorAll('.equation')].flatMap((equation) => {
    // The rendered extent: content of a formula may extend beyond its box.
    const lines = [...equation.querySelectorAll('p, math')].map((line) => {
      const parts = [...line.querySelectorAll('mi, mn, mo')].map((part) => part.getBoundingClientRect());
      const rects = parts.length ? parts : [line.getBoundingClientRect()];
      return {
        top: Math.min(...rects.map(({ top }) => top)), bottom: Math.max(...rects.map(({ bottom }) => bottom)),
        left: Math.min(...rects.map(({ left }) => left)), right: Math.max(...rects.map(({ right }) => right)),
      };
    });
    return lines.flatMap((a, i) => lines.slice(i + 1).map((b) =>
      Math.min(Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top), Math.min(a.right, b.right) - Math.max(a.left, b.left))));
  }));
  for (let i = 0; i < 8; ++i) {
    await page.locator('.recurrence tbody tr').nth(i).click();
    expect(Math.max(...(await overlaps())), `section ${i + 1}`).toBeLessThanOrEqual(-2);
  }
});

test('no equation and no row is cut off, however large its numbers', async () => {
  for (let i = 0; i < 8; ++i) await set(i, -179.9);
  for (let i = 1; i <= 8; ++i) {
    await page.locator('.recurrence tbody tr').nth(i - 1).click();
    expect(await page.locator('.teach-text h2').first().textContent()).toBe(`Section ${i}`);
    const beyond = await page.locator('.teach-text').evaluate((box) => {
      const { left, width } = box.getBoundingClientRect();
      const right = left + (box as HTMLElement).clientWidth;
      return [...box.querySelectorAll('*')].map((part) => part.getBoundingClientRect())
        .filter((part) => part.width > 0 && (part.right > right || part.left < left)).length + Math.max(0, box.scrollWidth - Math.ceil(width));
    });
    expect(beyond, `section ${i}`).toBe(0);
  }
  await open('The paper’s arm, free');
});

test('down to a projector’s size, the page enlarged, every slider has a track, and nothing lies upon another', async () => {
  for (const [width, height] of [[1440, 900], [1280, 720], [1025, 600], [1100, 600], [1101, 600], [960, 540], [853, 480]]) {
    await page.setViewportSize({ width, height });
    await page.waitForTimeout(200);
    const size = `${width}x${height}`;
    const seen = await page.evaluate(() => {
      const box = (element: Element) => {
        const { left, top, right, bottom } = element.getBoundingClientRect();
        return { left, top, right, bottom };
      };
      return {
        tracks: [...document.querySelectorAll('.archings .track')].map(box),
        numbers: [...document.querySelectorAll('.archings .unit')].map(box),
        archings: box(document.querySelector('.archings')!),
        plane: box(document.querySelector('.plane-box')!),
        sections: [...document.querySelectorAll('.teach > section')].map(box),
        beyond: document.documentElement.scrollWidth - innerWidth,
        wide: [...document.querySelectorAll('.teach-text, .exercises')].map((part) => part.scrollWidth - part.clientWidth),
      };
    });
    expect(seen.tracks, size).toHaveLength(8);
    for (const { left, right, bottom } of seen.tracks) {
      expect(right - left, size).toBeGreaterThanOrEqual(60);
      expect(bottom, size).toBeLessThanOrEqual(height);
    }
    for (const { right } of seen.numbers) expect(right, size).toBeLessThanOrEqual(seen.archings.right);
    expect(seen.plane.bottom - seen.plane.top, `${size}: the arm`).toBeGreaterThan(150);
    expect(seen.plane.right - seen.plane.left, `${size}: the arm`).toBeGreaterThan(300);
    expect([seen.beyond, ...seen.wide], size).toEqual([0, 0, 0]);
    seen.sections.forEach((a, i) => seen.sections.slice(i + 1).forEach((b) => {
      const over = Math.min(Math.min(a.right, b.right) - Math.max(a.left, b.left), Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));
      expect(over, size).toBeLessThanOrEqual(0.5);
    }));
  }
  // Drags the last slider with the mouse.
  const track = (await page.locator('#arching-7').boundingBox())!;
  const before = await effector();
  await page.mouse.click(track.x + 0.75 * track.width, track.y + track.height / 2);
  expect(await effector()).not.toBe(before);
  await page.setViewportSize({ width: 1280, height: 720 });
  await open('The paper’s arm, free');
});

test('each of the five exercises knows when it is done', async () => {
  await open('A half circle');
  expect(await page.locator('#verdict').textContent()).not.toContain('Done');
  await set(0, -90);
  await done('half circle');

  await open('Aside, and upright again');
  await set(0, -15);
  await set(1, 15);
  await page.getByLabel('Arching of section 1, °').fill('-14.85');
  await page.keyboard.press('Enter');
  await page.getByLabel('Arching of section 2, °').fill('14.85');
  await page.keyboard.press('Enter');
  await done('aside');

  await open('Reach a point');
  const tip = (await page.locator('.joint[data-tip="true"]').boundingBox())!;
  const goal = (await page.locator('.goal circle').boundingBox())!;
  await page.mouse.move(tip.x + tip.width / 2, tip.y + tip.height / 2);
  await page.mouse.down();
  await page.mouse.move(goal.x + goal.width / 2, goal.y + goal.height / 2, { steps: 12 });
  await page.mouse.up();
  await done('reach');

  await open('The second cord');
  await set(1, 30);
  await done('second cord');

  await open('5 The paper’s arm');
  await set(4, 9);
  await done('paper');
  expect(await page.locator('#verdict').textContent()).toContain('(−10.738, 5.201)');
  expect(await page.locator('.tally').textContent()).toBe('5 of 5');
});

test('the way back is a link', async () => {
  await page.goto(server.url);
  await page.waitForSelector('.bench');
  await page.getByRole('link', { name: 'Learn' }).click();
  await page.waitForSelector('.plane');
  await page.getByRole('link', { name: 'Viewer', exact: true }).click();
  await page.waitForSelector('.bench');
});

test('of a live arm with eight sections the legends show every name', async () => {
  await until(async () => (await legends(page)).some(({ names }) => names === 8));
  for (const { names, seen } of await legends(page)) expect(seen).toBe(names);
});

test('the browser had nothing to complain of', () => {
  expect(complaints).toEqual([]);
});
