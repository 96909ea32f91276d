// The page's panels: their sizes, plots, timeline, sliders and first hints, with the fake server.
import { readFileSync } from 'node:fs';
import type { Page } from 'playwright-core';
import { describe, expect, test } from 'vitest';
import { planar_rig } from '../fake/rigs';
import type { FakeServer } from '../fake/server';
import { server_state, slide, until } from './browser';
import { faked, fresh_before_each, opened_before } from './opened';

let page: Page;
let server: FakeServer;

const box = async (selector: string) => (await page.locator(selector).first().boundingBox())!;

/** Returns the times of a plot's ends, from the cursor that it shares with the timeline. */
async function plot_span(plot: number): Promise<[number, number]> {
  const over = page.locator('.chart .u-over').nth(plot);
  const { x, y, width } = (await over.boundingBox())!;
  const scrub = await page.locator('#scrub').evaluate((input: HTMLInputElement) => [Number(input.min), Number(input.max)]);
  const at = async (px: number): Promise<number> => {
    await page.mouse.move(px + 3, y + 20);
    await page.mouse.move(px, y + 20);
    await page.locator('.rail .hover').waitFor({ state: 'attached' });
    await page.waitForTimeout(120);
    const part = await page.locator('.rail .hover').evaluate((line: HTMLElement) => parseFloat(line.style.left) / 100);
    return scrub[0] + part * (scrub[1] - scrub[0]);
  };
  return [await at(x + 1), await at(x + width - 2)];
}

async function drag(from: { x: number; y: number }, by: { x?: number; y?: number }): Promise<void> {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await page.mouse.move(from.x + (by.x ?? 0) / 2, from.y + (by.y ?? 0) / 2);
  await page.mouse.move(from.x + (by.x ?? 0), from.y + (by.y ?? 0), { steps: 4 });
  await page.mouse.up();
}

describe('a rig’s page', () => {
  fresh_before_each((fresh) => ({ page, server } = fresh));

  describe('borders', () => {
    const border = (name: string) => page.getByRole('separator', { name });
    const middle_of = async (name: string) => {
      const { x, y, width, height } = (await border(name).boundingBox())!;
      return { x: x + width / 2, y: y + height / 2 };
    };

    test('are dragged, kept, and restored by a double click', async () => {
      const borders = [
        ['Width of the controls', '.left', 'width', { x: 70 }], ['Width of the pictures', '.right', 'width', { x: -70 }],
        ['Height of the plots', '.plots', 'height', { y: -70 }],
      ] as const;
      const sizes = () => Promise.all(borders.map(async ([, panel, side]) => Math.round((await box(panel))[side])));
      const before = await sizes();
      const dragged = before.map((size) => size + 70);
      for (const [name, , , by] of borders) await drag(await middle_of(name), by);
      await until(async () => (await sizes()).join() === dragged.join(), 3000, `${(await sizes()).join()} after ${before.join()}`);
      await page.reload();
      await page.waitForSelector('.section .slider');
      expect(await sizes()).toEqual(dragged);
      for (const [name] of borders) {
        const { x, y } = await middle_of(name);
        await page.mouse.dblclick(x, y);
      }
      await until(async () => (await sizes()).join() === before.join());
    });

    test('are moved by keys, within limits that are shown', async () => {
      const left = border('Width of the controls');
      await left.focus();
      const width = async () => Math.round((await box('.left')).width);
      const before = await width();
      await page.keyboard.press('ArrowRight');
      await until(async () => (await width()) === before + 16);
      await page.keyboard.press('Shift+ArrowLeft');
      await until(async () => (await width()) === before + 14);
      expect(await left.getAttribute('aria-valuenow')).toBe(String(before + 14));
      await page.keyboard.press('End');
      await until(async () => (await width()) === Number(await left.getAttribute('aria-valuemax')));
      expect((await box('.stage')).width).toBeGreaterThanOrEqual(297);
      expect((await box('.right')).width).toBeGreaterThanOrEqual(200);
      await page.keyboard.press('Home');
      await until(async () => (await width()) === 240);
      await page.keyboard.press('Enter');
      await until(async () => (await width()) === before);
      // The keys moved the border, not the time.
      expect(await page.locator('.badge[data-kind="live"]').count()).toBe(1);
    });

    test('cannot be dragged so far that something vanishes', async () => {
      await drag(await middle_of('Width of the controls'), { x: -280 });
      await until(async () => Math.round((await box('.left')).width) === 240);
      await drag(await middle_of('Height of the plots'), { y: -700 });
      await until(async () => (await box('.stage')).height < 200);
      expect((await box('.stage')).height).toBeGreaterThan(100);
    });
  });

  test('below 900 px a notice has a row of its own, and no panel is wider than the window', async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    const notice_again = async (): Promise<void> => {
      // The same words prolong it.
      server.broadcast({ type: 'reply', id: null, error: 'too many requests wait' });
      await page.waitForSelector('.notice');
    };
    const tabs = { '3D view': '.stage', Controls: '.left', Pictures: '.right', Plots: '.plots' };
    for (const [tab, panel] of Object.entries(tabs)) {
      await page.getByRole('button', { name: tab, exact: true }).click();
      await until(async () => page.locator(panel).isVisible());
      await notice_again();
      const [notice, shown, timeline] = [await box('.notices'), await box(panel), await box('.timeline')];
      expect(shown.y + shown.height).toBeLessThanOrEqual(notice.y + 0.5);
      expect(timeline.y + timeline.height).toBeLessThanOrEqual(notice.y + 0.5);
      expect(notice.y + notice.height).toBeLessThanOrEqual(844);
      const over = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]);
      expect(over, tab).toEqual([390, 844]);
      // What is reached by scrolling is reached by scrolling down.
      const beyond = await page.evaluate(() => [...document.querySelectorAll<HTMLElement>('button, input, select, a[href]')]
        .filter((control) => control.checkVisibility({ visibilityProperty: true }) && !control.closest('.marks'))
        .filter((control) => {
          const { left, right, width } = control.getBoundingClientRect();
          return width > 0 && (left < -8 || right > 398);
        })
        .map(({ outerHTML }) => outerHTML.slice(0, 100)));
      expect(beyond, tab).toEqual([]);
      if (tab !== 'Controls') continue;
      for (const name of await page.getByRole('tab').allTextContents()) {
        await page.getByRole('tab', { name }).click();
        expect(await page.locator('.panel').evaluate((element) => element.scrollWidth - element.clientWidth), name).toBeLessThanOrEqual(1);
      }
    }
    await notice_again();
    await page.getByRole('button', { name: 'Dismiss', exact: true }).click();
    await until(async () => (await page.locator('.notice').count()) === 0);
  });

  test('a drag in a plot zooms both in time, a double click goes back', async () => {
    server.session.time += 15;
    await page.waitForTimeout(1500);
    const whole = await plot_span(0);
    const chart = await box('.chart .u-over');
    await drag({ x: chart.x + 0.5 * chart.width, y: chart.y + 30 }, { x: 0.25 * chart.width });
    await page.getByRole('button', { name: 'Whole time' }).first().waitFor();
    // Each plot has the button, and a drag is no click: nothing is held.
    expect(await page.getByRole('button', { name: 'Whole time' }).count()).toBe(2);
    expect(await page.locator('.badge[data-kind="live"]').count()).toBe(1);
    const zoomed = [await plot_span(0), await plot_span(1)];
    for (const [start, end] of zoomed) {
      expect((end - start) / (whole[1] - whole[0])).toBeGreaterThan(0.15);
      expect((end - start) / (whole[1] - whole[0])).toBeLessThan(0.35);
      expect(Math.abs(start - zoomed[0][0])).toBeLessThan(0.4);
    }
    await page.mouse.dblclick(chart.x + 0.5 * chart.width, chart.y + 30);
    await until(async () => (await page.getByRole('button', { name: 'Whole time' }).count()) === 0);
    // The click of a double click holds nothing either.
    await until(async () => (await page.locator('.badge[data-kind="live"]').count()) === 1);
  });

  test('the y axis has typed limits, which are kept, and a log scale, which says so', async () => {
    const first = page.locator('.plot').first();
    await page.getByRole('button', { name: 'Y axis of plot 1' }).click();
    const [low, high] = [page.getByLabel('Lower limit of y, plot 1'), page.getByLabel('Upper limit of y, plot 1')];
    const type = async (field: typeof low, text: string): Promise<void> => {
      await field.fill(text);
      await field.press('Enter');
    };
    await type(low, '-3');
    await type(high, '-4');
    await until(async () => (await page.locator('[role="alert"]').textContent())!.includes('must be below'));
    expect(await high.inputValue()).toBe('');
    await type(high, '7,5');
    expect(await high.inputValue()).toBe('7.5');
    await page.reload();
    await page.waitForSelector('.section .slider');
    await page.getByRole('button', { name: 'Y axis of plot 1' }).click();
    expect([await low.inputValue(), await high.inputValue()]).toEqual(['-3', '7.5']);
    const log = first.getByLabel('log');
    await log.click();
    await until(async () => (await page.locator('[role="alert"]').textContent())!.includes('above 0'));
    expect(await log.isChecked()).toBe(false);
    await first.getByRole('button', { name: 'Auto' }).click();
    await log.click();
    await until(async () => (await first.locator('.legend').textContent())!.includes('log scale'));
    await first.getByRole('button', { name: 'Auto' }).click();
    await until(async () => !(await first.locator('.legend').textContent())!.includes('log scale'));
    expect(await low.inputValue()).toBe('');
  });

  test('the shown series are saved as CSV, with their units', async () => {
    await slide(page, '.section .slider input[type="range"]', 0.5);
    await until(async () => (await server_state(page)).bends[0] > 0.45);
    await page.waitForTimeout(300);
    await page.locator('.plot').first().locator('.legend button').nth(1).click();
    const [download] = await Promise.all([
      page.waitForEvent('download'), page.getByRole('button', { name: 'Save plot 1 as CSV' }).click(),
    ]);
    expect(download.suggestedFilename()).toBe('tip.csv');
    const [head, ...rows] = readFileSync(await download.path(), 'utf8').trimEnd().split('\n');
    expect(head).toBe('time [s],Tip x [m],Tip z [m]');
    const numbers = rows.map((row) => row.split(',').map(Number));
    expect(numbers.length).toBeGreaterThan(10);
    const { tip } = await server_state(page);
    expect(numbers.at(-1)![1]).toBeCloseTo(tip[0], 3);
    expect(numbers.at(-1)![2]).toBeCloseTo(tip[2], 3);
    for (let i = 1; i < numbers.length; ++i) expect(numbers[i][0]).toBeGreaterThan(numbers[i - 1][0]);
  });

  test('a live run’s tasks are bars while they run, and after', async () => {
    const { time } = server.session;
    server.broadcast({ type: 'event', time, level: 'info', name: 'reach', text: 'move starts' });
    server.session.running = time;
    const bar = page.locator('.mark[data-task="true"]');
    await bar.waitFor();
    await until(async () => (await bar.getAttribute('title'))!.startsWith('reach (move): '));
    await page.waitForTimeout(1000);
    server.session.running = 0;
    server.broadcast({ type: 'event', time: server.session.time, level: 'info', name: 'run', text: 'done' });
    await page.locator('.tick').waitFor();
    await page.waitForTimeout(600);
    const title = await bar.getAttribute('title');
    await page.waitForTimeout(600);
    expect(await bar.getAttribute('title')).toBe(title);
  });

  describe('sliders', () => {
    const degree = Math.PI / 180;
    const slider = () => page.locator('#arm-bends-0');
    const value = async () => Number(await slider().inputValue());

    test('are wide enough for a degree, and say their limits at their ends', async () => {
      const [least, most] = await slider().evaluate((input: HTMLInputElement) => [Number(input.min), Number(input.max)]);
      const { width } = await box('.track');
      expect(width).toBeGreaterThanOrEqual((most - least) / degree);
      const ends = await page.locator('.slider').first().locator('.ends span').allTextContents();
      expect(ends).toEqual(['−120.0', '120.0']);
    });

    test('go a degree by an arrow key, a tenth of it with Shift', async () => {
      await slider().focus();
      await page.keyboard.press('ArrowRight');
      await until(async () => Math.abs((await value()) - degree) < 0.1 * degree);
      await page.keyboard.press('Shift+ArrowRight');
      await until(async () => Math.abs((await value()) - 1.1 * degree) < 0.06 * degree, 3000, 'no fine step');
    });

    test('are dragged, with Shift in fine steps', async () => {
      const { x, y, width } = await box('.track');
      const [least, most] = await slider().evaluate((input: HTMLInputElement) => [Number(input.min), Number(input.max)]);
      const per_pixel = (most - least) / width;
      await drag({ x: x + width / 2, y: y + 10 }, { x: 40 });
      await until(async () => Math.abs((await value()) - 40 * per_pixel) < 2 * per_pixel, 3000, 'not dragged');
      // Its knob is there now, and with Shift a drag of 40 pixels is one of 4.
      await page.keyboard.down('Shift');
      await drag({ x: x + width / 2 + 40, y: y + 10 }, { x: -40 });
      await page.keyboard.up('Shift');
      await until(async () => Math.abs((await value()) - 36 * per_pixel) < 2 * per_pixel, 3000, 'no fine drag');
      // A click far from the knob takes it there.
      await page.mouse.click(x + width * 0.25, y + 10);
      await until(async () => Math.abs((await value()) - (least + 0.25 * (most - least))) < 2 * per_pixel, 3000, 'no jump');
      // And so does the arm.
      await until(async () => Math.abs((await server_state(page)).bends[0] - (least + 0.25 * (most - least))) < 3 * per_pixel);
    });
  });

  test('first hints stand beside the view, and each is gone for good when dismissed', async () => {
    const hints = page.locator('.hints li');
    expect(await hints.allTextContents()).toEqual([
      'Drag to turn the view.', 'Click “Run tasks” at the top to start the tasks.', 'Move a slider: the arm follows.',
    ]);
    const [stage, strip, plots] = [await box('.stage'), await box('.hints'), await box('.plots')];
    expect(strip.y).toBeGreaterThanOrEqual(stage.y + stage.height - 0.5);
    expect(strip.y + strip.height).toBeLessThanOrEqual(plots.y + 0.5);
    await page.getByRole('button', { name: 'Hide the hint about running tasks' }).click();
    await until(async () => (await hints.count()) === 2);
    await page.reload();
    await page.waitForSelector('.section .slider');
    expect(await hints.count()).toBe(2);
    while (await hints.count()) await hints.first().getByRole('button').click();
    expect(await page.locator('.hints').count()).toBe(0);
    expect(await page.evaluate(() => document.querySelector('.stage')!.getBoundingClientRect().height)).toBeGreaterThan(stage.height);
  });

  test('every control says in words what it does, in every tab', async () => {
    await page.getByRole('button', { name: 'Y axis of plot 1' }).click();
    await page.keyboard.press('k');
    for (const name of await page.getByRole('tab').allTextContents()) {
      await page.getByRole('tab', { name }).click();
      const silent = await page.evaluate(() =>
        [...document.querySelectorAll<HTMLElement>('button, input, select, a, [role="separator"]')]
          .filter((control) => {
            const text = control.closest('[title]')?.getAttribute('title') ?? control.getAttribute('aria-label') ?? '';
            // Words, and no names of the program’s own.
            return !/[a-z]{2,}/i.test(text) || /_|undefined|null|NaN/.test(text);
          })
          .map((control) => control.outerHTML.slice(0, 120)));
      expect(silent, name).toEqual([]);
    }
  });
});

describe('a recording’s page', () => {
  const opened = opened_before(() => faked(planar_rig(), 'recording'), 'recording');
  const shown_time = () => opened.page.evaluate(() => (globalThis as unknown as { flexura: { shown(): { time: number } } }).flexura.shown().time);

  test('has one bar for each task, with its name and times; a click goes there', async () => {
    ({ page } = opened);
    const bars = page.locator('.mark[data-task="true"]');
    expect(await bars.evaluateAll((all) => all.map((bar) => (bar as HTMLElement).title))).toEqual([
      'reach (move): 0.00 s to 4.00 s', 'back (move): 4.00 s to 6.00 s',
    ]);
    const line = await box('.line');
    const [reach, back] = [(await bars.nth(0).boundingBox())!, (await bars.nth(1).boundingBox())!];
    expect(reach.x).toBeCloseTo(line.x, 0);
    expect(reach.width / line.width).toBeCloseTo(4 / 6, 2);
    expect(back.width / line.width).toBeCloseTo(2 / 6, 2);
    await bars.nth(1).click();
    await until(async () => Math.abs((await shown_time()) - 4) < 1e-6);
  });

  test('zooms finer than the whole, and back by a double click', async () => {
    ({ page } = opened);
    await slide(page, '#scrub', 1);
    await until(async () => Math.abs((await shown_time()) - 1) < 1e-6);
    const chart = await box('.chart .u-over');
    await drag({ x: chart.x + chart.width / 3, y: chart.y + 20 }, { x: chart.width / 3 });
    await page.getByRole('button', { name: 'Whole time' }).first().waitFor();
    const [start, end] = await plot_span(0);
    expect(Math.abs(start - 2)).toBeLessThan(0.15);
    expect(Math.abs(end - 4)).toBeLessThan(0.15);
    const [download] = await Promise.all([
      page.waitForEvent('download'), page.getByRole('button', { name: 'Save plot 2 as CSV' }).click(),
    ]);
    const [head, ...rows] = readFileSync(await download.path(), 'utf8').trimEnd().split('\n');
    expect(head.split(',')[1]).toMatch(/^bend\[1\]\.x \[deg\]$/);
    const times = rows.map((row) => Number(row.split(',')[0]));
    expect(Math.min(...times)).toBeGreaterThan(1.85);
    expect(Math.max(...times)).toBeLessThan(4.15);
    expect(times.length).toBeGreaterThan(100);
    expect(Math.abs((await shown_time()) - 1)).toBeLessThan(1e-6);
    await page.mouse.dblclick(chart.x + chart.width / 2, chart.y + 20);
    await until(async () => (await page.getByRole('button', { name: 'Whole time' }).count()) === 0);
    await until(async () => Math.abs((await shown_time()) - 1) < 1e-6, 3000, 'the double click moved the time');
    expect(opened.complaints).toEqual([]);
  });
});
