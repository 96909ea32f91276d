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
}
