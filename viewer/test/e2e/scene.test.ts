// The 3D view: its opening view, colours, axes, scale, shadow, ghosts, and the arm below the floor.
import { fileURLToPath } from 'node:url';
import { PerspectiveCamera, Vector3 } from 'three';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { camera_stride } from '../../src/protocol/state';
import { Orbit } from '../../src/scene/orbit';
import { spatial_rig } from '../fake/rigs';
import type { FakeServer } from '../fake/server';
import { orbit_of, stage_at_rest, stage_sharpened, tip_on_screen, until } from './browser';
import { faked, started, visit } from './opened';
import { program } from './program';

const quarter = Math.PI / 2;

/** The rig without a plane: its floor is only drawn. */
function rig_without_plane() {
  const rig = spatial_rig();
  rig.scene.obstacles = rig.scene.obstacles.filter(({ kind }) => kind !== 'plane');
  return rig;
}

/** Counts the pixels of a picture of the stage that look like this colour. */
async function count_like(page: Page, png: Buffer, color: string, off = 30): Promise<number> {
  return page.evaluate(async ({ text, hex, most }) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], { type: 'image/png' }));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d')!;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const wanted = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (Math.max(...wanted.map((value, k) => Math.abs(value - data[i + k]))) <= most) ++count;
    return count;
  }, { text: png.toString('base64'), hex: color, most: off });
}

/** Returns the mean colour of the stage around a place of the window. */
async function color_at(page: Page, png: Buffer, { x, y }: { x: number; y: number }): Promise<number[]> {
  const box = (await page.locator('#stage').boundingBox())!;
  return page.evaluate(async ({ text, u, v }) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], { type: 'image/png' }));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d')!;
    context.drawImage(image, 0, 0);
    return [...context.getImageData(Math.round(u), Math.round(v), 1, 1).data.slice(0, 3)];
  }, { text: png.toString('base64'), u: x - box.x, v: y - box.y });
}

describe('the 3D view of a rig', () => {
  let server: FakeServer;
  let page: Page;
  let complaints: string[];

  beforeAll(async () => {
    server = await faked(rig_without_plane());
    ({ page, complaints } = await visit(server.url));
    await page.waitForSelector('.badge[data-kind="live"]');
    await page.waitForSelector('.section .slider');
    await until(async () => (await page.locator('.stage-labels span').count()) > 0);
  });
  afterAll(() => server.stop());

  test('the axes have letters, and the floor a scale', async () => {
    const words = await page.locator('.stage-labels span').allTextContents();
    expect(words).toEqual(['0.1 m', 'X', 'Y', 'Z']);
    const box = (await page.locator('#stage').boundingBox())!;
    for (const place of await page.locator('.stage-labels span').evaluateAll((all) => all.map((each) => each.getBoundingClientRect().toJSON()))) {
      expect(place.left).toBeGreaterThan(box.x);
      expect(place.right).toBeLessThan(box.x + box.width);
    }
    await page.getByRole('tab', { name: 'Scene' }).click();
    await page.getByRole('button', { name: 'Show: World axes' }).click();
    await until(async () => (await page.locator('.stage-labels span').allTextContents()).join() === '0.1 m');
    await page.getByRole('button', { name: 'Show: World axes' }).click();
    await until(async () => (await page.locator('.stage-labels span').count()) === 4);
    await page.getByRole('tab', { name: 'Arm' }).click();
  });

  test('a click on an axis looks along it, also by keys', async () => {
    const before = await orbit_of(page);
    const gizmo = page.getByRole('group', { name: 'Directions of the axes' });
    const looks = async (name: string, azimuth: number, elevation: number): Promise<void> => {
      await until(async () => {
        const orbit = await orbit_of(page);
        return Math.abs(orbit.azimuth - azimuth) + Math.abs(orbit.elevation - elevation) < 1e-9;
      }, 8000, `not from ${name}`);
    };
    await gizmo.getByRole('button', { name: 'Look from X', exact: true }).click();
    await looks('X', quarter, 0);
    // Now Z points to the left.
    const place = async (name: string) => (await gizmo.getByRole('button', { name: `Look from ${name}`, exact: true }).boundingBox())!;
    await until(async () => (await place('Z')).x < (await place('−Z')).x);
    await gizmo.getByRole('button', { name: 'Look from −Z', exact: true }).click();
    await looks('−Z', 2 * quarter, 0);
    await gizmo.getByRole('button', { name: 'Look from Y', exact: true }).focus();
    await page.keyboard.press('Enter');
    await looks('Y', 0, quarter);
    await page.evaluate(({ azimuth, elevation }) => {
      (globalThis as unknown as { flexura: { orbit(): { look(a: number, e: number): void } } }).flexura.orbit().look(azimuth, elevation);
    }, before);
  });

  test('that the arm passes through a floor that is only drawn is said, with the depth', async () => {
    const note = page.locator('#floor-note');
    expect(await note.count()).toBe(0);
    server.session.arm.command([[2, 0], [2, 0], [0.5, 0]]);
    await note.waitFor({ timeout: 15000 });
    expect(await note.textContent()).toMatch(/^The arm passes through the floor by \d+(\.\d)? (mm|cm)$/);
    server.session.arm.command([[0, 0], [0, 0], [0, 0]]);
    await until(async () => (await note.count()) === 0, 15000, 'the note stays');
  });

  test('a ghost is an outline, and a true one is not drawn where the arm is', async () => {
    await page.keyboard.press('1');
    await page.keyboard.press('0');
    const base = [0, 0, 0, Math.SQRT1_2, -Math.SQRT1_2, 0, 0];
    const tip = [0, 0.75, 0, Math.SQRT1_2, -Math.SQRT1_2, 0, 0];
    const beside = (pose: number[]) => [pose[0] + 0.2, ...pose.slice(1)];
    const magenta = '#ff00ff';
    const seen = async () => count_like(page, await stage_at_rest(page), magenta, 70);
    expect(await seen()).toBe(0);
    server.broadcast({ type: 'ghost', id: 'truth', color: magenta, poses: [base, tip] });
    await page.waitForTimeout(500);
    expect(await seen()).toBe(0);
    server.broadcast({ type: 'ghost', id: 'truth', color: magenta, poses: [beside(base), beside(tip)] });
    await until(async () => (await seen()) > 40, 15000, 'it is not drawn');
    const outline = await seen();
    // Its middle is nearly clear: a solid body of this size has many more pixels.
    const height = (await tip_on_screen(page, 0)).y - (await tip_on_screen(page, 0.75)).y;
    const area = (height / 0.75) ** 2 * 0.75 * 2 * 0.02;
    expect(outline).toBeLessThan(0.6 * area);
    server.broadcast({ type: 'ghost', id: 'truth' });
    await until(async () => (await seen()) === 0, 15000, 'it stays');
  });

  test('the arm has its own colours, in both themes', async () => {
    // From the front, close to a red mark.
    await page.keyboard.press('1');
    await page.evaluate(() => {
      const orbit = (globalThis as unknown as { flexura: { orbit(): { distance: number; target: { set(...at: number[]): void } } } }).flexura.orbit();
      orbit.distance = 0.25;
      orbit.target.set(0, 0.296, 0);
    });
    const colors: number[][] = [];
    for (const dark of [true, false]) {
      await page.emulateMedia({ colorScheme: dark ? 'dark' : 'light' });
      await page.waitForTimeout(400);
      const png = await stage_sharpened(page);
      colors.push(await color_at(page, png, await tip_on_screen(page, 0.296)));
    }
    for (const [red, green, blue] of colors) {
      // [0.8, 0.25, 0.02], linear: orange.
      expect(red).toBeGreaterThan(170);
      expect(green).toBeLessThan(0.75 * red);
      expect(blue).toBeLessThan(0.45 * red);
    }
    for (let i = 0; i < 3; ++i) expect(Math.abs(colors[0][i] - colors[1][i])).toBeLessThan(45);
    await page.emulateMedia({ colorScheme: 'dark' });
    expect(complaints).toEqual([]);
  });
});

/** Returns the positions of the cameras in the free view, -1 to 1 across the picture. */
async function cameras_in_view(page: Page): Promise<Vector3[]> {
  const box = (await page.locator('#stage').boundingBox())!;
  const { target, ...angles } = await orbit_of(page);
  const eye = new PerspectiveCamera(38, box.width / box.height);
  const orbit = Object.assign(new Orbit(), angles);
  orbit.target.set(target.x, target.y, target.z);
  orbit.place(eye);
  eye.updateProjectionMatrix();
  eye.updateMatrixWorld();
  const { cameras, samples } = await page.evaluate(() => {
    const shown = (globalThis as unknown as { flexura: { shown(): { cameras: Float32Array; samples: Float32Array } } }).flexura.shown();
    return { cameras: [...shown.cameras], samples: [...shown.samples] };
  });
  const points: Vector3[] = [];
  for (let at = 0; at + camera_stride <= cameras.length; at += camera_stride) points.push(new Vector3(cameras[at], cameras[at + 1], cameras[at + 2]));
  for (let at = 0; at + 8 <= samples.length; at += 8) points.push(new Vector3(samples[at + 1], samples[at + 2], samples[at + 3]));
  return points.map((point) => point.project(eye));
}

describe.skipIf(!program)('the opening view', () => {
  test.each(['01_paper_arm', '03_cameras', '06_shape_servo', '12_hanging_tentacle'])('of %s holds the arm and the cameras', async (example) => {
    const served = await started(fileURLToPath(new URL(`../../../examples/${example}/experiment.toml`, import.meta.url)));
    try {
      const { page } = await visit(served.url);
      await page.waitForSelector('.section .slider');
      await until(async () => (await page.locator('.stage-labels span').count()) >= 4);
      const places = await cameras_in_view(page);
      expect(places.length).toBeGreaterThan(4);
      for (const { x, y, z } of places) {
        expect(Math.max(Math.abs(x), Math.abs(y))).toBeLessThan(1);
        expect(Math.abs(z)).toBeLessThan(1);
      }
    } finally {
      await served.stop();
    }
  });
});
