// Accessibility and layout of every page, in the smallest supported size and in both themes.
import type { Page } from 'playwright-core';
import { describe, expect, test } from 'vitest';
import { planar_rig, spatial_rig } from '../fake/rigs';
import type { FakeServer } from '../fake/server';
import { stage_at_rest, until } from './browser';
import { faked, visit } from './opened';

const width = 1280;
const height = 720;

/** Returns visible controls without an accessible name. */
const nameless = (page: Page) => page.evaluate(() =>
  [...document.querySelectorAll<HTMLElement>('button, a[href], input, select, textarea, summary, [tabindex="0"], [role="button"]')]
    .filter((control) => control.checkVisibility())
    .filter((control) => {
      const labels = [...((control as HTMLInputElement).labels ?? [])].map(({ textContent }) => textContent);
      const by = (control.getAttribute('aria-labelledby') ?? '').split(' ').map((id) => document.getElementById(id)?.textContent);
      return ![control.getAttribute('aria-label'), control.textContent, control.title, ...labels, ...by].some((name) => name?.trim());
    })
    .map(({ outerHTML }) => outerHTML.slice(0, 120)));

/** Returns elements that extend beyond the window, or beyond a box that cannot be scrolled. */
const overflowing = (page: Page) => page.evaluate(([w, h]) => {
  const scrolls = (element: Element): boolean => {
    const { overflowX, overflowY } = getComputedStyle(element);
    return /auto|scroll/.test(overflowX + overflowY);
  };
  const out: string[] = [];
  for (const element of document.querySelectorAll<HTMLElement>('#app *')) {
    if (!element.checkVisibility() || element.closest('.sr, svg, math, .chart, dialog:not([open])')) continue;
    const rect = element.getBoundingClientRect();
    if (!rect.width || !rect.height) continue;
    let box = element.parentElement;
    while (box && !scrolls(box)) box = box.parentElement;
    if (box) continue;
    if (rect.right > w + 1 || rect.bottom > h + 1 || rect.left < -1 || rect.top < -1) out.push(element.outerHTML.slice(0, 120));
  }
  const { scrollWidth, scrollHeight } = document.documentElement;
  if (scrollWidth > w || scrollHeight > h) out.push(`${scrollWidth} x ${scrollHeight}`);
  // No horizontal scrolling is allowed.
  for (const panel of document.querySelectorAll<HTMLElement>('.panel, .right, .teach-text, .exercises, .help-groups')) {
    if (panel.checkVisibility() && panel.scrollWidth > panel.clientWidth + 1) out.push(`${panel.className} is ${panel.scrollWidth} wide`);
  }
  return out;
}, [width, height]);

/** Returns texts with too little contrast to their background (WCAG 2.2, 1.4.3); disabled controls are exempt. */
const faint = (page: Page) => page.evaluate(() => {
  type Color = [number, number, number, number];
  const parse = (text: string): Color => {
    const numbers = (text.match(/-?[\d.]+(e-?\d+)?%?/g) ?? []).map((n) => (n.endsWith('%') ? parseFloat(n) / 100 : Number(n)));
    const unit = text.startsWith('color(') ? 1 : 255;
    const [r, g, b] = numbers;
    return [r / unit, g / unit, b / unit, numbers[3] ?? 1];
  };
  const over = ([r, g, b, a]: Color, ground: Color): Color => {
    const mix = (x: number, y: number): number => a * x + (1 - a) * y;
    return [mix(r, ground[0]), mix(g, ground[1]), mix(b, ground[2]), 1];
  };
  const ground_of = (element: Element | null): Color => {
    if (!element) return [1, 1, 1, 1];
    const color = parse(getComputedStyle(element).backgroundColor);
    return color[3] >= 1 ? color : over(color, ground_of(element.parentElement));
  };
  const light = (color: Color): number => {
    const [r, g, b] = color.slice(0, 3).map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const out: string[] = [];
  for (const element of document.querySelectorAll<HTMLElement>('#app *')) {
    const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent?.trim());
    const input = element.matches('input[type="text"], select');
    if ((!own && !input) || !element.checkVisibility() || element.closest(':disabled, .sr, .picture, option, svg')) continue;
    const style = getComputedStyle(element);
    const ground = ground_of(element);
    const [a, b] = [light(over(parse(style.color), ground)), light(ground)].sort((x, y) => y - x);
    const size = parseFloat(style.fontSize);
    const large = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    const ratio = (a + 0.05) / (b + 0.05);
    if (ratio < (large ? 3 : 4.5)) out.push(`${ratio.toFixed(2)}: ${element.outerHTML.slice(0, 120)}`);
  }
  return [...new Set(out)];
});

test('these tests see what is wrong', async () => {
  const server = await faked();
  const { page } = await visit(server.url, { width, height });
  await page.waitForSelector('.badge[data-kind="live"]');
  await page.evaluate(() => {
    const button = document.querySelector<HTMLElement>('#play')!;
    button.removeAttribute('aria-label');
    button.removeAttribute('title');
    document.querySelector<HTMLElement>('.title')!.style.color = 'rgb(70 80 90)';
    const wide = document.querySelector<HTMLElement>('.header .spacer')!;
    wide.style.minWidth = '1200px';
  });
  expect((await nameless(page)).join()).toContain('id="play"');
  expect((await faint(page)).join()).toContain('class="title"');
  expect((await overflowing(page)).join()).toContain('Help');
  await server.stop();
});

/** Returns the colour in the 3D view's upper right corner. */
async function ground_of_stage(page: Page): Promise<number[]> {
  const png = (await stage_at_rest(page)).toString('base64');
  return page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d')!;
    context.drawImage(bitmap, 0, 0);
    return Array.from(context.getImageData(bitmap.width - 5, 5, 1, 1).data);
  }, png);
}

/** Returns how much of a box is visible only after scrolling, px. */
const hidden_of = (page: Page, box: string) =>
  page.locator(box).evaluate(({ scrollHeight, clientHeight }) => Math.max(0, scrollHeight - clientHeight));

async function expect_usable(page: Page, where: string): Promise<void> {
  expect(await nameless(page), `${where}: without a name`).toEqual([]);
  expect(await overflowing(page), `${where}: reaches out`).toEqual([]);
  expect(await faint(page), `${where}: hard to read`).toEqual([]);
}

for (const dark of [true, false]) {
  describe(dark ? 'dark' : 'light', () => {
    const opened = async (mode: 'live' | 'recording', use: (page: Page, server: FakeServer) => Promise<void>): Promise<void> => {
      const server = await faked(mode === 'live' ? spatial_rig() : planar_rig(), mode);
      const { page, complaints } = await visit(server.url, { width, height, dark });
      try {
        await page.waitForSelector(`.badge[data-kind="${mode}"]`);
        await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
        await use(page, server);
        expect(complaints).toEqual([]);
      } finally {
        await server.stop();
      }
    };

    test('a live rig, with each of its tabs, layers, a picked point, a run and an error', () => opened('live', async (page, server) => {
      for (const tab of await page.getByRole('tab').all()) {
        await tab.click();
        await expect_usable(page, (await tab.textContent())!);
      }
      for (const chip of await page.locator('.chip').all()) await chip.click();
      await until(async () => (await page.locator('.shape-said').textContent())!.startsWith('Shape ±'));
      await page.keyboard.press('k');
      await page.locator('.picture canvas').first().hover();
      await until(async () => /section 2 at s/.test((await page.locator('.pixel').textContent())!));
      await until(async () => (await hidden_of(page, '.right')) === 0, 15000, 'something is hidden below the column');
      server.broadcast({ type: 'event', time: 1, level: 'error', name: 'safety', text: 'stopped before section 2: contact with ball' });
      server.broadcast({ type: 'progress', what: 'a task with a name that is rather long', fraction: 0.4 });
      await page.waitForTimeout(300);
      await expect_usable(page, 'with everything');
    }));

    test('a recording', () => opened('recording', (page) => expect_usable(page, 'a recording')));

    test('who is not let in sees that, what to do about it, and nothing that nobody knows', async () => {
      // The upper end of the background's gradient.
      const ground = dark ? [0x13, 0x1b, 0x23] : [0xd5, 0xde, 0xe7];
      for (const hash of ['', `#token=${'0'.repeat(32)}`, '#token=zz']) {
        const server = await faked();
        const { page, complaints } = await visit(server.url.replace(/#.*/, hash), { width, height, dark });
        await page.waitForSelector('.badge[data-kind="refused"]');
        expect(await page.locator('.badge').first().textContent()).toBe('NO ACCESS');
        const form = (await page.getByRole('alertdialog').textContent())!;
        expect(form).toContain('No valid token');
        expect(form).toContain('Open the address that');
        expect(await page.locator('.right').textContent()).toBe('No data received yet.');
        expect(new URL(page.url()).hash).toBe('');
        const shown = await ground_of_stage(page);
        for (let i = 0; i < 3; ++i) expect(Math.abs(shown[i] - ground[i]), `${shown.join()} of the 3D view`).toBeLessThan(6);
        await expect_usable(page, 'not let in');
        expect(complaints).toEqual([]);
        await server.stop();
      }
    });

    test('help, and the teaching page with an exercise', () => opened('live', async (page) => {
      await page.keyboard.press('F1');
      await expect_usable(page, 'help');
      expect(await hidden_of(page, 'dialog.help')).toBe(0);
      await page.keyboard.press('Escape');
      await page.getByRole('link', { name: 'Learn' }).click();
      await page.waitForSelector('.plane');
      await page.getByRole('button', { name: 'Reach a point' }).click();
      await expect_usable(page, 'teaching');
    }));
  });
}
