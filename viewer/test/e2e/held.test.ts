// User commands while the view is held at an earlier time, and while the connection is silent.
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import { slide, until } from './browser';
import { fresh_before_each } from './opened';

let server: FakeServer;
let page: Page;

fresh_before_each((fresh) => ({ server, page } = fresh));

const badge = () => page.locator('.badge').first().getAttribute('data-kind');
const last = (what: string) => server.log.filter((request) => request.do === what).at(-1);
const goal: [number, number][] = [[0.2, 0.1], [0.5, -0.3], [-0.4, 0.25]];

/** Holds the view and moves the rig meanwhile. */
async function hold_and_move(): Promise<void> {
  await page.getByRole('button', { name: 'Hold the view' }).click();
  await page.waitForSelector('.badge[data-kind="held"]');
  server.session.arm.command(goal, [1.05, 0.95, 1]);
  await until(() => !server.session.moving && Math.abs(server.session.arm.stretches[0] - 1.05) < 1e-6);
  // Until the page has received the new state, which it does not show.
  await page.waitForTimeout(400);
}

/** Expects these bends in a request, except those given in `but`, within the step of a slider. */
function expect_bends(bends: unknown, but: Record<number, number> = {}): void {
  (bends as [number, number][]).flat().forEach((bend, i) => expect(bend, `number ${i}`).toBeCloseTo(but[i] ?? goal.flat()[i], 2));
}

test('a slider of a held view moves its own section: the others stay as they are, not as they were', async () => {
  await hold_and_move();
  await slide(page, '#arm-bends-0', 0.35);
  await until(() => last('arm') !== undefined);
  expect_bends(last('arm')!.bends, { 0: 0.35 });
  expect((last('arm')!.stretches as number[])[0]).toBeCloseTo(1.05, 3);
  await until(async () => (await badge()) === 'live');
});

test('a stretch too', async () => {
  await hold_and_move();
  await slide(page, '#arm-stretch-2', 1.04);
  await until(() => last('arm') !== undefined);
  expect_bends(last('arm')!.bends);
  expect(last('arm')!.stretches as number[]).toEqual([1.05, 0.95, 1.04].map((value) => expect.closeTo(value, 3)));
});

test('a tendon too', async () => {
  await page.getByRole('button', { name: 'Tendons' }).click();
  await hold_and_move();
  const before = server.session.arm.displacements();
  await slide(page, '#arm-tendons-6', before[6] + 0.003);
  await until(() => last('arm') !== undefined);
  const asked = server.session.arm.from_tendons(last('arm')!.tendons as number[]);
  // The tendon ends at the third section and does not affect the first two.
  asked.slice(0, 2).flat().forEach((bend, i) => expect(bend).toBeCloseTo(goal.flat()[i], 3));
});

test('a typed coordinate of the tip too', async () => {
  await hold_and_move();
  const tip = server.session.arm.tip(server.session.arm.bends);
  const field = page.getByLabel('Tip’s Y, m');
  await field.fill('0.6');
  await field.press('Enter');
  await until(() => last('tip') !== undefined);
  expect(last('tip')!.position).toEqual([expect.closeTo(tip[0], 4), 0.6, expect.closeTo(tip[2], 4)]);
});

test('while nothing is heard of the rig nothing can be moved, by a hand or a key; to stop it is worth a try', async () => {
  server.mute = true;
  await until(async () => (await badge()) === 'stale');
  const enabled = () => page.locator('.left label:not(:has-text("truly stand")) input:enabled, .left input:enabled:not(label input)').count();
  await until(async () => (await enabled()) === 0);
  await page.getByRole('tab', { name: 'Cameras' }).click();
  expect(await enabled()).toBe(0);
  expect(await page.locator('.left input').count()).toBeGreaterThan(4);
  for (const name of ['Run tasks', 'Reset']) expect(await page.getByRole('button', { name }).isDisabled(), name).toBe(true);
  server.log.length = 0;
  for (const key of ['r', 'Backspace']) await page.keyboard.press(key);
  await page.getByRole('button', { name: 'Halt' }).click();
  await until(() => last('halt') !== undefined);
  expect(server.log.filter(({ do: what }) => ['run', 'reset', 'arm', 'tip', 'head'].includes(what as string))).toEqual([]);
  server.mute = false;
  await until(async () => (await badge()) === 'live');
  await until(async () => (await enabled()) > 4);
  expect(await page.getByRole('button', { name: 'Reset' }).isDisabled()).toBe(false);
});

test('the clock and the line of time say one time, that of the state that is shown', async () => {
  await page.getByRole('button', { name: 'Hold the view' }).click();
  await page.waitForSelector('.badge[data-kind="held"]');
  for (let i = 0; i < 8; ++i) {
    await page.getByRole('button', { name: 'One step back' }).click();
    await page.waitForTimeout(150);
    const [clock, line] = [await page.locator('#clock').textContent(), await page.locator('#time').textContent()];
    expect(line!.trim()).toBe(clock);
  }
});

test('a number is what people write as one', async () => {
  const field = page.getByLabel('Section 1, towards x, °');
  await field.fill('0x10');
  await field.press('Enter');
  await page.waitForTimeout(300);
  expect(last('arm')).toBeUndefined();
  await field.fill('10,5');
  await field.press('Enter');
  await until(() => last('arm') !== undefined);
  expect((last('arm')!.bends as number[][])[0][0]).toBeCloseTo((10.5 * Math.PI) / 180, 6);
});

test('every key that is bound stands in the help', async () => {
  await page.keyboard.press('F1');
  await page.waitForSelector('dialog.help[open]');
  const keys = await page.locator('dialog.help kbd').allTextContents();
  for (const key of ['Numpad 1', '3', 'Numpad 0', 'A', 'Numpad +', '=', '?', 'Alt ←', 'Numpad 4', '2nd right of P']) expect(keys).toContain(key);
  const over = await page.locator('dialog.help').evaluate((help) => ({
    help: help.scrollWidth - help.clientWidth,
    keys: [...help.querySelectorAll('dt')].filter((dt) => dt.scrollWidth > dt.clientWidth + 1).length,
  }));
  expect(over).toEqual({ help: 0, keys: 0 });
});

test('what is told lies upon neither the inspector nor the plots', async () => {
  for (const [width, height] of [[1280, 720], [1440, 900], [910, 512]]) {
    await page.setViewportSize({ width, height });
    // The same words prolong it.
    server.broadcast({ type: 'progress', done: true, outcome: 'unsafe', text: 'section 1: bend 130 degrees, limit 120 degrees, at 2.5 s' });
    await page.waitForSelector('.notice');
    await page.waitForTimeout(200);
    const upon = await page.evaluate(() => {
      const box = (what: string): DOMRect => document.querySelector(what)!.getBoundingClientRect();
      const notice = box('.notice');
      return ['.left', '.right', '.plots', '.timeline', '.header'].filter((what) => {
        const other = box(what);
        return Math.min(notice.right, other.right) > Math.max(notice.left, other.left) + 0.5
          && Math.min(notice.bottom, other.bottom) > Math.max(notice.top, other.top) + 0.5;
      });
    });
    expect(upon, `${width}x${height}`).toEqual([]);
  }
});
