// Faults: refusals, silence, lost connections, restarts. Only the fake server can produce these.
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import { slide, stage_at_rest, until } from './browser';
import { fresh_before_each } from './opened';

let server: FakeServer;
let page: Page;

fresh_before_each((fresh) => ({ server, page } = fresh));

const badge = () => page.locator('.badge').first().getAttribute('data-kind');

test('a refused request is shown where screen readers hear it', async () => {
  server.refuse = 'the section would fold over itself';
  await slide(page, '.section .slider input[type="range"]', 0.5);
  const alert = page.locator('[role="alert"]');
  await until(async () => (await alert.textContent())!.includes('fold over itself'));
  await alert.getByRole('button', { name: 'Dismiss' }).first().click();
  expect(await alert.textContent()).toBe('');
});

test('where the tip cannot go is forgotten when a slider moves the arm', async () => {
  const tip = page.getByLabel('Tip’s Y, m');
  await tip.fill('9');
  await tip.press('Enter');
  const why = page.locator('.tip .bad');
  await until(async () => (await why.count()) === 1);
  await slide(page, '.section .slider input[type="range"]', 0.5);
  await until(async () => (await why.count()) === 0);
  await page.waitForTimeout(300);
  expect(await why.count()).toBe(0);
});

test('on the teaching page no key reaches the rig', async () => {
  await page.getByRole('link', { name: 'Learn' }).click();
  await page.waitForSelector('.plane');
  server.log.length = 0;
  for (const key of ['Space', 'h', 'r', 'c', 'Backspace', ']', 'p']) await page.keyboard.press(key);
  await page.keyboard.press('F1');
  await page.waitForSelector('dialog.help[open]');
  await page.keyboard.press('Escape');
  expect(server.log.filter((request) => !['ping', 'images'].includes(request.do as string))).toEqual([]);
  await page.getByRole('link', { name: 'Viewer', exact: true }).click();
  await page.waitForSelector('.badge[data-kind="live"]');
  expect(await page.locator('.bench').getAttribute('data-plots')).toBe('true');
  expect(await page.locator('.view-switch button[aria-pressed="true"]').textContent()).toBe('Free view');
});

test('silence makes everything stale, labelled and grey, and the first word ends that', async () => {
  server.mute = true;
  await until(async () => (await badge()) === 'stale');
  expect(await page.locator('.old-label').textContent()).toContain('No new data');
  expect(await page.locator('#stage').evaluate((canvas) => getComputedStyle(canvas).filter)).toContain('grayscale');
  await until(async () => /Outdated/.test((await page.locator('.picture .old').first().textContent()) ?? ''));
  server.mute = false;
  await until(async () => (await badge()) === 'live');
  expect(await page.locator('.old-label').count()).toBe(0);
});

test('a rig that stands still while the program answers is stale too', async () => {
  server.stuck = true;
  await until(async () => (await badge()) === 'stale');
  server.stuck = false;
  await until(async () => (await badge()) === 'live');
});

test('a lost connection is told, and comes back by itself', async () => {
  await server.stop();
  await until(async () => (await badge()) === 'lost');
  // An attempt to connect may be under way.
  await until(async () => /lost|not answer/i.test((await page.locator('.entrance').textContent()) ?? ''));
  expect(await page.locator('.section .slider input').first().isDisabled()).toBe(true);
  await server.start();
  await until(async () => (await badge()) === 'live', 12000);
  expect(await page.locator('.entrance').count()).toBe(0);
});

test('another session starts afresh: nothing of the old one stays', async () => {
  server.broadcast({ type: 'event', time: 1, level: 'error', name: 'old news', text: 'of before' });
  await page.getByRole('tab', { name: 'Events' }).click();
  await until(async () => (await page.locator('.events').textContent())!.includes('old news'));
  await server.restart();
  await until(async () => (await page.locator('[role="alertdialog"]').count()) > 0, 12000);
  await page.goto(server.url);
  await until(async () => (await badge()) === 'live');
  await until(async () => !(await page.locator('.left').textContent())!.includes('old news'));
  expect(await page.locator('[role="status"]').allTextContents().then((all) => all.join())).toContain('started again');
});

test('a restart brings another token, which is said plainly, and a pasted address lets one in', async () => {
  await server.restart();
  await until(async () => (await page.locator('[role="alertdialog"]').count()) > 0, 12000);
  expect(await badge()).toBe('lost');
  expect(await page.locator('[role="alertdialog"]').textContent()).toContain('token');
  await page.locator('#token').fill('http://nonsense');
  await page.getByRole('button', { name: 'Connect' }).click();
  expect(await page.locator('[role="alertdialog"]').textContent()).toContain('No valid token');
  await page.locator('#token').fill(server.url);
  await page.getByRole('button', { name: 'Connect' }).click();
  await until(async () => (await badge()) === 'live');
});

test('a wrong token in the address ends no session that is good, nor is it kept', async () => {
  for (const wrong of ['0'.repeat(32), 'zz']) {
    await page.evaluate((token) => (location.hash = `#token=${token}`), wrong);
    await until(() => new URL(page.url()).hash === '');
    await until(async () => (await badge()) === 'live');
    await page.waitForTimeout(300);
    expect(await badge()).toBe('live');
  }
  await page.reload();
  await until(async () => (await badge()) === 'live');
});

test('a reloaded page comes in again, and so does another tab without the token', async () => {
  await page.reload();
  await until(async () => (await badge()) === 'live');
  const other = await page.context().newPage();
  await other.goto(server.url.replace(/#.*/, ''));
  await other.waitForSelector('.badge[data-kind="live"]');
  await other.close();
});

test('bytes that are no state are told and do no harm', async () => {
  server.push_all(Buffer.from([1, 2, 3]));
  server.push_all(Buffer.from([99, 0]));
  await until(async () => (await page.locator('[role="alert"]').textContent())!.includes('shorter'));
  await until(async () => (await badge()) === 'live');
});

test('tasks run with progress, can be cancelled, and their recording can be opened', async () => {
  await page.getByRole('button', { name: 'Run tasks' }).click();
  await page.waitForSelector('progress');
  await page.getByRole('button', { name: 'Cancel' }).click();
  await until(async () => (await page.locator('[role="alert"]').textContent())!.includes('cancelled'));
  await page.getByRole('button', { name: 'Run tasks' }).click();
  await until(async () => Number(await page.locator('progress').getAttribute('value')) > 0.1);
  // The tasks take three seconds; most of it is skipped.
  server.session.time += 2.5;
  await page.getByRole('button', { name: 'Replay' }).click({ timeout: 20000 });
  await page.waitForSelector('.badge[data-kind="recording"]');
  await page.getByRole('button', { name: 'To the rig' }).click();
  await page.waitForSelector('.badge[data-kind="live"]');
  await page.reload();
  await page.getByRole('button', { name: 'Replay' }).click();
  await page.waitForSelector('.badge[data-kind="recording"]');
});

test('what happens at once has one label, and all of it is in its words', async () => {
  const { time } = server.session;
  for (const [name, at] of [['stand', time], ['run', time], ['later', time + 0.001]] as const) {
    server.broadcast({ type: 'event', time: at, level: 'info', name, text: '' });
  }
  const labels = page.locator('.mark[data-level="info"]');
  await until(async () => (await labels.allTextContents()).join('; ').includes('later'));
  expect(await labels.allTextContents()).toEqual(['stand, run, later']);
  expect(await labels.first().getAttribute('aria-label')).toMatch(/stand at .*; info: run at .*; info: later at /);
});

test('what the program says to nobody in particular is shown', async () => {
  server.broadcast({ type: 'reply', id: null, error: 'too many requests wait' });
  await until(async () => (await page.locator('[role="alert"]').textContent())!.includes('too many requests wait'));
});

test('a run that a terminal has started is not to be cancelled here, by a button or a key', async () => {
  server.session.is_watched = true;
  await page.reload();
  await until(async () => (await badge()) === 'live');
  server.broadcast({ type: 'progress', what: 'reach', fraction: 0.3 });
  const cancel = page.getByRole('button', { name: 'Cancel' });
  await cancel.waitFor();
  expect(await cancel.isDisabled()).toBe(true);
  await cancel.click({ force: true });
  await page.keyboard.press('c');
  await page.waitForTimeout(200);
  expect(server.log.filter(({ do: what }) => what === 'cancel')).toHaveLength(0);
});

test('layers lie upon the pictures, and ghosts stand in the view', async () => {
  const picture = page.locator('.picture canvas').first();
  await until(async () => (await page.locator('.picture .none').count()) === 0, 15000);
  const yellow = () => picture.evaluate((canvas: HTMLCanvasElement) => {
    const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (data[i] > 200 && data[i + 1] > 150 && data[i + 2] < 120) ++count;
    return count;
  });
  expect(await yellow()).toBe(0);
  server.broadcast({ type: 'overlay', camera: 'front', layers: [{ id: 'axis', kind: 'polyline', points: [[20, 20], [600, 400]], color: '#ffd43b' }] });
  await until(async () => (await yellow()) > 100);
  server.stuck = true;
  // Stale content is drawn pale; this must hold for every picture.
  await until(async () => (await page.locator('.badge[data-kind="stale"]').count()) === 1, 15000);
  const before = await stage_at_rest(page);
  server.broadcast({ type: 'ghost', id: 'desired', color: '#4dabf7', poses: [[0, 0, 0, 0.7071, -0.7071, 0, 0], [0.3, 0.3, 0, 0.5, -0.5, 0.5, -0.5]] });
  await page.waitForTimeout(300);
  expect((await stage_at_rest(page)).equals(before)).toBe(false);
  server.broadcast({ type: 'ghost', id: 'desired' });
  await page.waitForTimeout(300);
  expect((await stage_at_rest(page)).equals(before)).toBe(true);
});
