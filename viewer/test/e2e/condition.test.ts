// One badge says in which condition the rig is, and the run that is recorded, and the same is in the run's report.
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { slide, until, type Opened } from './browser';
import { opened_before, recorded, started } from './opened';
import { program } from './program';

const file = (name: string) => fileURLToPath(new URL(name, import.meta.url));

const badge_says = ({ page }: Opened, word: string) =>
  until(() => page.evaluate((wanted) => document.getElementById('condition')?.textContent === wanted, word), 8000, `not ${word}`);

describe.skipIf(!program)('the condition', () => {
  describe('of a rig', () => {
    const opened = opened_before(() => started(['view', file('run.toml')]), 'live');
    const says = (word: string) => badge_says(opened, word);

    test('is idle, running, halted, done', async () => {
      const { page, complaints } = opened;
      await says('IDLE');
      await page.getByRole('button', { name: 'Run tasks' }).click();
      await says('RUNNING');
      await page.keyboard.press('h');
      await says('HALTED');
      await page.getByRole('button', { name: 'Reset' }).click();
      await says('IDLE');
      await page.getByLabel('Speed of the tasks').selectOption({ label: 'As fast as possible' });
      await page.getByRole('button', { name: 'Run tasks' }).click();
      await says('DONE');
      await page.reload();
      await says('DONE');
      expect(complaints).toEqual([]);
    });
  });

  describe('of a rig that is slow, and of tasks that harm it', () => {
    const opened = opened_before(() => started(['view', file('unsafe.toml')]), 'live');

    test('is moving, then idle; unsafe where a task violates a limit', async () => {
      const { page, complaints } = opened;
      const says = (word: string) => badge_says(opened, word);
      await says('IDLE');
      // At most half a radian per second.
      const field = page.locator('.section').nth(1).locator('.number').first();
      await field.fill('60');
      await field.press('Enter');
      await says('MOVING');
      await says('IDLE');
      await page.getByRole('button', { name: 'Run tasks' }).click();
      await says('RUNNING');
      await says('UNSAFE');
      // Whoever stops it there leaves it there.
      await page.keyboard.press('h');
      await until(() => page.getByRole('button', { name: 'Run tasks' }).isEnabled());
      expect(await page.locator('#condition').textContent()).toBe('UNSAFE');
      await page.getByRole('button', { name: 'Reset' }).click();
      await says('IDLE');
      expect(complaints).toEqual([]);
    });
  });

  describe('of tasks that fail', () => {
    const opened = opened_before(() => started(['view', file('failing.toml')]), 'live');

    test('is failed, with the reason', async () => {
      const { page, complaints } = opened;
      await page.getByRole('button', { name: 'Run tasks' }).click();
      await badge_says(opened, 'FAILED');
      expect(await page.locator('#condition').getAttribute('title')).toMatch(/^The tasks failed\. hurry: saturated: section 1: bend rate/);
      expect(complaints).toEqual([]);
    });
  });

  describe('of a recorded run', () => {
    const opened = opened_before(() => recorded(file('unsafe.toml'), 1), 'recording');

    test('is that of the time that is shown, and its report has the badge of its end', async () => {
      const { page, complaints } = opened;
      const says = (word: string) => badge_says(opened, word);
      await slide(page, '#scrub', 1);
      await says('RUNNING');
      await slide(page, '#scrub', 3);
      await says('UNSAFE');
      const color = (of: string) => page.locator(of).evaluate((badge) => getComputedStyle(badge).backgroundColor);
      const report = await page.context().newPage();
      await report.goto(new URL('report', page.url()).href);
      const badge = report.locator('.badge');
      expect(await badge.textContent()).toBe('UNSAFE');
      expect(await badge.evaluate((each) => getComputedStyle(each).backgroundColor)).toBe(await color('#condition'));
      await report.close();
      expect(complaints).toEqual([]);
    });
  });
});
