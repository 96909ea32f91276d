// Tests of the page that do not depend on its content.
import type { Page } from 'playwright-core';
import { beforeAll, expect, test } from 'vitest';
import { type Opened, until } from './browser';

/** Theme, help, accessible names, and layout in small windows. */
export function page_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
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
    const box = page.getByLabel('Enable keys');
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

  test('every control says what it does to whoever points at it', async () => {
    const silent = await page.evaluate(() =>
      [...document.querySelectorAll<HTMLElement>('button, input, select, a')]
        .filter((element) => !element.closest('[title]'))
        .map((element) => element.outerHTML.slice(0, 120)));
    expect(silent).toEqual([]);
  });

  test('a picture is enlarged by a click, and small again by another or by Esc', async () => {
    await page.setViewportSize({ width: 1280, height: 720 });
    const canvas = page.locator('.picture canvas').first();
    const width = async () => (await canvas.boundingBox())!.width;
    const small = await width();
    await canvas.click();
    await until(async () => (await width()) > 2.5 * small);
    const { x, y, width: wide, height } = (await canvas.boundingBox())!;
    expect(x).toBeGreaterThanOrEqual(0);
    expect(x + wide).toBeLessThanOrEqual(1280);
    expect(y + height).toBeLessThanOrEqual(720);
    expect(wide / height).toBeCloseTo(4 / 3, 1);
    await canvas.click();
    await until(async () => Math.abs((await width()) - small) < 1);
    await canvas.click();
    await until(async () => (await width()) > 2.5 * small);
    await page.keyboard.press('Escape');
    await until(async () => Math.abs((await width()) - small) < 1);
  });

  test('a plot’s series are switched by a click', async () => {
    const name = page.locator('.plot').first().locator('.legend button').nth(1);
    const drawn = () => page.locator('.plot canvas').first().evaluate((canvas: HTMLCanvasElement) => {
      const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      // The second series is orange; the first lies under the third where the arm is straight.
      for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 100 && data[i] - data[i + 2] > 80 && data[i] > 150) ++count;
      return count;
    });
    await until(async () => (await drawn()) > 20);
    await name.click();
    expect(await name.getAttribute('aria-pressed')).toBe('false');
    await until(async () => (await drawn()) < 5);
    await name.click();
    await until(async () => (await drawn()) > 20);
  });

  test('below 900 px one panel is shown at a time, each by its tab', async () => {
    await page.setViewportSize({ width: 390, height: 844 });
    const panels = { '3D view': '.stage', Controls: '.left', Pictures: '.right', Plots: '.plots' };
    for (const [tab, panel] of Object.entries(panels)) {
      await page.getByRole('button', { name: tab, exact: true }).click();
      for (const each of Object.values(panels)) await until(async () => (await page.locator(each).isVisible()) === (each === panel), 8000, `${tab}: ${each}`);
      expect((await page.locator(panel).boundingBox())!.width).toBeGreaterThan(380);
      const over = await page.evaluate(() => [document.documentElement.scrollWidth, document.documentElement.scrollHeight]);
      expect(over, tab).toEqual([390, 844]);
    }
    await page.getByRole('button', { name: '3D view', exact: true }).click();
    await page.setViewportSize({ width: 1280, height: 720 });
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
    await page.getByRole('button', { name: 'Pictures', exact: true }).click();
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
}
