// The text of the experiment in the page: edited, checked, saved as a new file, with a pose or a camera's view.
import { copyFileSync, existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { beforeAll, describe, expect, test } from 'vitest';
import { server_state, slide, until } from './browser';
import { opened_before, started } from './opened';
import { program } from './program';

const original = fileURLToPath(new URL('recording.toml', import.meta.url));

describe.skipIf(!program)('the text of the experiment', () => {
  const folder = mkdtempSync(join(tmpdir(), 'flexura-text-'));
  const file = join(folder, 'arm.toml');
  const before = readFileSync(original, 'utf8');
  const opened = opened_before(async () => {
    copyFileSync(original, file);
    const served = await started(file);
    return {
      url: served.url,
      stop: async () => {
        await served.stop();
        rmSync(folder, { recursive: true });
      },
    };
  }, 'live');
  let page: Page;

  beforeAll(() => {
    ({ page } = opened);
  });

  const area = () => page.locator('.experiment textarea');
  const status = () => page.locator('.experiment .problems').textContent();
  const read = (name: string) => readFileSync(join(folder, name), 'utf8');
  const close = async () => {
    await page.keyboard.press('Escape');
    await until(async () => !(await page.locator('.experiment').isVisible()));
  };
  const save = async () => {
    await page.locator('.experiment').getByRole('button', { name: 'Save' }).click();
    await until(async () => /Saved:/.test((await status()) ?? ''));
  };

  test('is that of the file', async () => {
    await page.getByRole('button', { name: 'Experiment', exact: true }).click();
    await until(async () => (await area().inputValue()) === before);
    expect(await status()).toBe('A valid experiment.');
    await close();
  });

  test('shows what is wrong with its line and column, and saves nothing then', async () => {
    await page.getByRole('button', { name: 'Experiment', exact: true }).click();
    await until(async () => (await area().inputValue()) === before);
    await area().fill(before.replace('max_bend = 2', 'max_bend = -2'));
    await until(async () => /arm\.section\[0\]\.max_bend = -2/.test((await status()) ?? ''));
    const line = before.split('\n').findIndex((each) => each.startsWith('max_bend')) + 1;
    const place = page.locator('.experiment .problems button');
    expect(await place.textContent()).toBe(`${line}:12`);
    expect(await page.locator('.gutter [data-faulty="true"]').textContent()).toBe(String(line));
    expect(await page.locator('.experiment').getByRole('button', { name: 'Save' }).isDisabled()).toBe(true);
    await place.click();
    const at = await area().evaluate((field: HTMLTextAreaElement) => field.value.slice(field.selectionStart, field.selectionStart + 2));
    expect(at).toBe('-2');
  });

  test('is saved as a new file, and overwrites none', async () => {
    const edited = before.replace('A recording', 'Edited in the page');
    await area().fill(edited);
    await until(async () => (await status()) === 'A valid experiment.');
    const field = page.getByLabel('New file');
    expect(await field.inputValue()).toBe('arm-2.toml');
    await save();
    expect(read('arm-2.toml')).toBe(edited);
    expect(read('arm.toml')).toBe(before);
    await area().fill(before);
    await until(async () => (await status()) === 'A valid experiment.');
    for (const [name, why] of [['arm-2.toml', /already exists/], ['../arm-3.toml', /expected a name/]] as const) {
      await field.fill(name);
      await page.locator('.experiment').getByRole('button', { name: 'Save' }).click();
      await until(async () => why.test((await page.locator('.notices').textContent()) ?? ''));
    }
    expect(read('arm-2.toml')).toBe(edited);
    expect(existsSync(join(folder, '..', 'arm-3.toml'))).toBe(false);
  });

  test('is given to the browser, too', async () => {
    await page.getByLabel('New file').fill('mine.toml');
    const [download] = await Promise.all([
      page.waitForEvent('download'), page.getByRole('button', { name: 'Download' }).click(),
    ]);
    expect(download.suggestedFilename()).toBe('mine.toml');
    expect(readFileSync(await download.path(), 'utf8')).toBe(before);
    await close();
  });

  test('gets a task to the shown pose', async () => {
    await slide(page, '.section .slider input[type="range"]', 0.2);
    await until(async () => {
      const { bends, is_moving } = await server_state(page);
      return !is_moving && Math.hypot(bends[0], bends[1]) > 0.01;
    });
    const { bends } = await server_state(page);
    await page.getByRole('button', { name: 'Save pose as a task' }).click();
    await until(async () => (await area().inputValue()).startsWith(before + '\n[[task]]\n'));
    const [, x, y] = /bends = \[\[([-\d.e]+), ([-\d.e]+)\], \[0, 0\]\]/.exec((await area().inputValue()).slice(before.length))!;
    expect(Number(x)).toBeCloseTo(bends[0], 5);
    expect(Number(y)).toBeCloseTo(bends[1], 5);
    await save();
    expect(read('arm-3.toml')).toBe(await area().inputValue());
    await close();
  });

  test('gets the view of a camera', async () => {
    await page.getByRole('tab', { name: 'Cameras' }).click();
    await slide(page, '#head-front-pan', 0.1);
    await until(async () => Math.abs((await server_state(page)).camera[17] - 0.1) < 0.02);
    const pan = (await server_state(page)).camera[17];
    await page.getByRole('button', { name: 'Save the view of front' }).click();
    const start = /name = "front"\ninitial = \{ pan = ([-\d.]+), tilt = 0, zoom = 1 \}\n/;
    await until(async () => start.test(await area().inputValue()));
    expect(Number(start.exec(await area().inputValue())![1])).toBeCloseTo(pan, 5);
    const selected = await area().evaluate((field: HTMLTextAreaElement) => field.value.slice(field.selectionStart, field.selectionEnd));
    expect(selected).toContain('pan = ');
    await save();
    expect(read('arm-4.toml')).toMatch(start);
    await close();
    expect(opened.complaints).toEqual([]);
  });
});
