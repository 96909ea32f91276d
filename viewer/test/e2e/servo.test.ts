// Watching a servo, stopping it, and replaying its recording.
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { beforeAll, describe, expect, test } from 'vitest';
import { colored, slide, stage_at_rest, until } from './browser';
import { opened_before, started } from './opened';
import { program } from './program';

const file = fileURLToPath(new URL('servo.toml', import.meta.url));
const [wanted, seen, features] = ['#ff922b', '#22b8cf', '#da77f2'];

describe.skipIf(!program)('a servo', () => {
  const opened = opened_before(() => started(file), 'live');
  let page: Page;

  beforeAll(() => {
    ({ page } = opened);
  });

  const legend = () => page.locator('.extras');
  const eye = (label: string) => legend().getByRole('button', { name: `Show: ${label}` });
  const drawn = async (color: string) => (await colored(page, color)).count > 20;

  test('one task is chosen and started; wanted, seen and true shapes have a legend', async () => {
    expect(await legend().count()).toBe(0);
    await page.getByLabel('Tasks to run').selectOption({ label: '2: sway (servo)' });
    await page.getByRole('button', { name: 'Run tasks' }).click();
    await legend().waitFor();
    await until(async () => (await legend().getByRole('button').count()) === 4, 15000, 'not all shapes came');
    for (const label of ['Target', 'Seen', 'True', 'Features']) expect(await eye(label).getAttribute('aria-pressed')).toBe('true');
    await until(async () => /sway: error [\d.]+ % of the length/.test((await page.locator('.running-text').textContent()) ?? ''), 15000, 'no word');
  });

  test('the axis as measured and the wanted shape lie upon both pictures, each with its eye', async () => {
    await until(() => drawn(wanted), 15000, 'the wanted shape is not drawn');
    await until(() => drawn(seen), 15000, 'the axis is not drawn');
    await eye('Target').click();
    await until(async () => !(await drawn(wanted)), 8000, 'it is not hidden');
    expect(await drawn(seen)).toBe(true);
    await eye('Target').click();
    await until(() => drawn(wanted));
  });

  test('errors along the arm, and over time, are plots', async () => {
    await page.getByLabel('Plot 2 shows').selectOption({ label: 'Errors along the arm' });
    const second = page.locator('.plot').nth(1);
    await until(async () => /Seen.*True/.test((await second.locator('.legend').textContent()) ?? ''));
    await page.getByLabel('Plot 1 shows').selectOption({ label: 'Servo error, %' });
    await until(async () => /rms\s*[\d.]+/.test((await page.locator('.plot').first().locator('.legend').textContent()) ?? ''));
  });

  test('it is stopped, says so, and what it drew is gone', async () => {
    await page.getByRole('button', { name: 'Cancel' }).click();
    await until(async () => /cancelled/.test((await page.locator('[role="alert"]').textContent()) ?? ''), 15000, 'it does not end');
    await until(async () => (await legend().count()) === 0);
    await page.getByRole('tab', { name: 'Events' }).click();
    expect(await page.locator('.events').textContent()).toMatch(/sway.*cancelled/);
  });

  test('its recording shows the same, at every time', async () => {
    await page.getByRole('button', { name: 'Replay' }).click();
    await page.waitForSelector('.badge[data-kind="recording"]');
    await slide(page, '#scrub', 1);
    await legend().waitFor();
    await until(() => drawn(wanted), 15000, 'the wanted shape is not drawn');
    await until(() => drawn(seen), 15000, 'the axis is not drawn');
    const plot = page.locator('.plot').nth(1);
    await until(async () => /rms.*tip.*true rms/.test((await plot.locator('.legend').textContent()) ?? ''), 8000, 'no errors over time');
    const all = await stage_at_rest(page);
    for (const label of ['Target', 'Seen', 'True']) await eye(label).click();
    expect((await stage_at_rest(page)).equals(all)).toBe(false);
    await until(async () => !(await drawn(wanted)) && !(await drawn(seen)));
    for (const label of ['Target', 'Seen', 'True']) await eye(label).click();
    expect(opened.complaints).toEqual([]);
  });

  test('what the law compares lies upon the pictures of the way, with its eye', async () => {
    await slide(page, '#scrub', 0.4);
    const of_features = async () => (await colored(page, features)).count;
    await until(async () => (await of_features()) > 40, 15000, 'no lines to where the points are wanted');
    await eye('Features').click();
    await until(async () => (await of_features()) === 0, 8000, 'they are not hidden');
    await eye('Features').click();
    await until(async () => (await of_features()) > 40);
    expect(opened.complaints).toEqual([]);
  });
});
