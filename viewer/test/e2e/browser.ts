// A browser for the page's tests, with helpers for user input.
import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { chromium, type Browser, type Page } from 'playwright-core';

/** The built page: FLEXURA_PAGE, or the output of `npm run build`. */
export const dist = process.env.FLEXURA_PAGE ?? fileURLToPath(new URL('../../dist', import.meta.url));

/** Shows `dist` instead of the program's embedded page, to work on the page without building the program. */
const is_instead = process.env.FLEXURA_PAGE_INSTEAD !== undefined;

/** Needed because a page without a network address may otherwise not connect to local servers. */
const has_no_address = '--disable-features=LocalNetworkAccessChecks';

/** Factor on all timeouts, for busy machines. */
const patience = Number(process.env.FLEXURA_PATIENCE ?? 1);

export async function launch(): Promise<Browser> {
  if (!existsSync(`${dist}/index.html`)) throw new Error(`there is no page in ${dist}: npm run build`);
  // The default software WebGL, as on a machine without a display.
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--disable-dev-shm-usage', ...(is_instead ? [has_no_address] : [])],
  });
}

export interface Opened {
  page: Page;
  /** Errors reported by the browser: script errors and violations of the security policy. */
  complaints: string[];
}

export async function open_page(
  browser: Browser, url: string, options: { width?: number; height?: number; dark?: boolean } = {},
): Promise<Opened> {
  const { width = 1440, height = 900, dark = true } = options;
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? 'dark' : 'light' });
  context.setDefaultTimeout(30_000 * patience);
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error' && !/Failed to load resource|WebSocket connection/.test(message.text())) {
      complaints.push(message.text());
    }
  });
  if (is_instead) await show_instead(page);
  await page.goto(url);
  return { page, complaints };
}

/** Serves the page's files from `dist`, under the server's security policy. */
async function show_instead(page: Page): Promise<void> {
  await page.route(({ pathname }) => pathname === '/' || pathname.startsWith('/assets/'), async (route) => {
    const { origin, pathname } = new URL(route.request().url());
    const { headers } = await fetch(origin);
    await route.fulfill({
      path: `${dist}${pathname === '/' ? '/index.html' : pathname}`,
      headers: { 'Content-Security-Policy': headers.get('Content-Security-Policy') ?? '' },
    });
  });
}

/** Hides overlays of the 3D view (a running clock, buttons, notes) while a picture of it is taken. */
async function without_what_lies_upon_it<Result>(page: Page, take: () => Promise<Result>): Promise<Result> {
  const show = (visibility: string) => page.evaluate((value) => {
    for (const above of document.querySelectorAll<HTMLElement>('.stage > :not(canvas), .notices')) above.style.visibility = value;
  }, visibility);
  await show('hidden');
  try {
    return await take();
  } finally {
    await show('');
  }
}

async function shot_of_stage(page: Page): Promise<Buffer> {
  return page.screenshot({ clip: (await page.locator('#stage').boundingBox())! });
}

/** Takes a picture of the 3D view alone. */
export async function stage_picture(page: Page): Promise<Buffer> {
  return without_what_lies_upon_it(page, () => shot_of_stage(page));
}

/**
 * Waits until the 3D view is drawn at the higher resolution of scenes at rest (src/scene/sharpness.ts). With a graphics
 * card both resolutions are equal.
 */
async function sharpened(page: Page, ms: number): Promise<void> {
  await page.evaluate(async (most) => {
    const canvas = document.querySelector<HTMLCanvasElement>('#stage')!;
    const end = performance.now() + most;
    // User input is drawn with the next frame.
    for (let i = 0; i < 2; ++i) await new Promise(requestAnimationFrame);
    while (canvas.width <= canvas.clientWidth && performance.now() < end) await new Promise((done) => setTimeout(done, 30));
  }, ms);
}

/** Takes a picture of the 3D view after user input, if nothing else moves. */
export async function stage_sharpened(page: Page): Promise<Buffer> {
  await sharpened(page, 2000 * patience);
  return stage_picture(page);
}

/** Takes a picture of the 3D view at rest: equal to the previous picture. */
export async function stage_at_rest(page: Page, ms = 15000): Promise<Buffer> {
  const end = Date.now() + patience * ms;
  // Taking pictures is expensive, so this cheaper check comes first.
  await sharpened(page, 600);
  return without_what_lies_upon_it(page, async () => {
    let before = await shot_of_stage(page);
    for (;;) {
      await page.waitForTimeout(150);
      const now = await shot_of_stage(page);
      if (now.equals(before)) return now;
      if (Date.now() > end) throw new Error('the 3D view does not come to rest');
      before = now;
    }
  });
}

/** Returns the approximate number of colours in a picture, at 16 levels per class and channel. */
export async function colors_in(page: Page, png: Buffer): Promise<number> {
  return page.evaluate(async (text) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext('2d')!;
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(0, 0, bitmap.width, bitmap.height);
    const seen = new Set<number>();
    for (let i = 0; i < data.length; i += 4) seen.add(((data[i] >> 4) << 8) | ((data[i + 1] >> 4) << 4) | (data[i + 2] >> 4));
    return seen.size;
  }, png.toString('base64'));
}

/** Returns how many pixels of the first picture have approximately this colour, and their mean position. */
export async function colored(page: Page, color: string): Promise<{ count: number; u: number; v: number }> {
  return page.locator('.picture canvas').first().evaluate((canvas: HTMLCanvasElement, hex) => {
    const wanted = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
    const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
    let [count, u, v] = [0, 0, 0];
    for (let i = 0; i < data.length; i += 4) {
      if (Math.max(...wanted.map((value, k) => Math.abs(value - data[i + k]))) > 25) continue;
      ++count;
      u += (i / 4) % canvas.width;
      v += Math.floor(i / 4 / canvas.width);
    }
    return { count, u: u / count, v: v / count };
  }, color);
}

export interface ServerState {
  time: number;
  bends: number[];
  tip: number[];
  /** x, y, z, q, pan, tilt, zoom, ..., and from 17 on what is commanded, of the first camera. */
  camera: number[];
  /** Tendon displacements, m. */
  displacements: number[];
  /** Value, force and lost steps of each actuator. */
  actuators: number[][];
  /** Kinetic, elastic, gravity; [] if missing. */
  energy: number[];
  /** s, point, force; [] if there is no push. */
  push: number[];
  /** Obstacle, s, point, force, normal force, slip state. */
  contacts: number[][];
  is_moving: boolean;
  is_weightless: boolean;
  is_running: boolean;
}

/** Returns the state that the server sends to a second client; independent of the page's decoder. */
export async function server_state(page: Page): Promise<ServerState> {
  return page.evaluate(() => new Promise<ServerState>((resolve, reject) => {
    const socket = new WebSocket(new URL('socket', location.href.replace(/^http/, 'ws').replace(/#.*/, '')));
    socket.binaryType = 'arraybuffer';
    socket.onerror = () => reject(new Error('no second connection'));
    socket.onmessage = ({ data }) => {
      if (typeof data === 'string' || new DataView(data as ArrayBuffer).getUint8(0) !== 1) return;
      socket.close();
      const view = new DataView(data as ArrayBuffer);
      const sections = view.getUint16(2, true);
      const samples = view.getUint16(4, true);
      const numbers = new Float32Array(data as ArrayBuffer, 28);
      const last = 3 * sections + 8 * (samples - 1);
      const tendons = last + 8 + 23 * view.getUint16(6, true);
      const actuators = tendons + view.getUint16(8, true);
      const flags = view.getUint8(1);
      const energy = actuators + 3 * view.getUint16(24, true);
      const push = energy + (flags & 32 ? 3 : 0);
      const pace = push + (flags & 64 ? 7 : 0);
      const contacts = pace + (flags & 128 ? 1 : 0);
      resolve({
        time: view.getFloat64(16, true),
        bends: Array.from(numbers.subarray(0, 2 * sections)),
        tip: Array.from(numbers.subarray(last + 1, last + 4)),
        camera: Array.from(numbers.subarray(last + 8, last + 31)),
        displacements: Array.from(numbers.subarray(tendons, actuators)),
        actuators: Array.from({ length: view.getUint16(24, true) }, (_, i) => Array.from(numbers.subarray(actuators + 3 * i, actuators + 3 * i + 3))),
        energy: Array.from(numbers.subarray(energy, push)),
        push: Array.from(numbers.subarray(push, pace)),
        contacts: Array.from({ length: view.getUint16(26, true) }, (_, i) => Array.from(numbers.subarray(contacts + 10 * i, contacts + 10 * i + 10))),
        is_moving: (flags & 1) !== 0,
        is_weightless: (view.getUint8(1) & 16) !== 0,
        is_running: (view.getUint8(1) & 2) !== 0,
      });
    };
  }));
}

/** Returns the server's answer to a second client; independent of the page. */
export async function ask_server<Result>(page: Page, request: Record<string, unknown>): Promise<Result> {
  return page.evaluate((asked) => new Promise<Result>((resolve, reject) => {
    const socket = new WebSocket(new URL('socket', location.href.replace(/^http/, 'ws').replace(/#.*/, '')));
    socket.binaryType = 'arraybuffer';
    socket.onerror = () => reject(new Error('no second connection'));
    socket.onopen = () => socket.send(JSON.stringify({ id: 1, ...asked }));
    socket.onmessage = ({ data }) => {
      const message = typeof data === 'string' ? (JSON.parse(data) as { type: string; error?: string; result: Result }) : null;
      if (message?.type !== 'reply') return;
      socket.close();
      if (message.error === undefined) resolve(message.result);
      else reject(new Error(message.error));
    };
  }), request);
}

/** Returns for each plot how many names its legend shows completely: within the plot, above its chart. */
export async function legends(page: Page): Promise<{ names: number; seen: number }[]> {
  return page.evaluate(() => [...document.querySelectorAll('.plot')].map((plot) => {
    const frame = plot.getBoundingClientRect();
    const chart = plot.querySelector('.chart')!.getBoundingClientRect();
    const list = plot.querySelector('.legend')!.getBoundingClientRect();
    const items = [...plot.querySelectorAll('.legend li')].map((item) => item.getBoundingClientRect());
    const inside = items.filter(({ right, bottom }) =>
      right <= frame.right + 1 && bottom <= Math.min(chart.top, list.bottom) + 1);
    return { names: items.length, seen: inside.length };
  }));
}

/** Waits until a condition holds. */
export async function until(what: () => boolean | Promise<boolean>, ms = 8000, why = 'it did not happen'): Promise<void> {
  const end = Date.now() + patience * ms;
  while (!(await what())) {
    if (Date.now() > end) throw new Error(why);
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** Returns the screen position of the arm's point at s, or of its tip. */
export async function tip_on_screen(page: Page, s?: number): Promise<{ x: number; y: number }> {
  return page.evaluate((at) => (globalThis as unknown as { flexura: { tip(s?: number): { x: number; y: number } } }).flexura.tip(at), s);
}

/** Returns the viewpoint of the free view. */
export async function orbit_of(page: Page): Promise<{ azimuth: number; elevation: number; distance: number; target: { x: number; y: number; z: number } }> {
  return page.evaluate(() => {
    const { azimuth, elevation, distance, target } = (globalThis as unknown as {
      flexura: { orbit(): Awaited<ReturnType<typeof orbit_of>> };
    }).flexura.orbit();
    return { azimuth, elevation, distance, target: { x: target.x, y: target.y, z: target.z } };
  });
}

/** Moves a range input to a value as a user would, with an event. */
export async function slide(page: Page, selector: string, value: number): Promise<void> {
  await page.locator(selector).first().evaluate((input: HTMLInputElement, to) => {
    input.value = String(to);
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }, value);
}
