// Checks that each camera frustum in the 3D view shows its own picture in the right orientation.
import { PerspectiveCamera, Quaternion, Vector3 } from 'three';
import type { Page } from 'playwright-core';
import { beforeAll, expect, test } from 'vitest';
import { camera_stride } from '../../src/protocol/state';
import { Orbit } from '../../src/scene/orbit';
import { hang } from '../../src/scene/parts/cameras';
import { type Opened, orbit_of, server_state, slide, stage_at_rest, until } from './browser';

/** The arm stands at the origin. */
const [span, base, size] = [0.75, [0, 0, 0], { width: 640, height: 480 }];

interface Place {
  /** Pixel in the picture. */
  u: number;
  v: number;
  /** Pixel in the 3D view. */
  x: number;
  y: number;
}

interface Grey {
  /** Grey level in the picture, and its range in the neighbourhood. */
  picture: number;
  range: number;
  /** Grey level in the 3D view. */
  shown: number;
}

export function frustum_tests(opened: Opened): void {
  let page: Page;
  beforeAll(() => {
    ({ page } = opened);
  });

  /** Returns where the free view shows pixels of the picture in a camera's frustum. */
  const places_of = async (index: number): Promise<Place[]> => {
    const box = (await page.locator('#stage').boundingBox())!;
    const { target, ...angles } = await orbit_of(page);
    const eye = new PerspectiveCamera(38, box.width / box.height);
    const orbit = Object.assign(new Orbit(), angles);
    orbit.target.set(target.x, target.y, target.z);
    orbit.place(eye);
    eye.updateProjectionMatrix();
    eye.updateMatrixWorld();
    const row = Float32Array.from(await page.evaluate(() =>
      [...(globalThis as unknown as { flexura: { shown(): { cameras: Float32Array } } }).flexura.shown().cameras]));
    const at = index * camera_stride;
    const { left, right, top, bottom, depth } = hang(row, at, size, base, span, {} as ReturnType<typeof hang>);
    const turn = new Quaternion(row[at + 4], row[at + 5], row[at + 6], row[at + 3]);
    const places: Place[] = [];
    for (let v = 2; v < size.height; v += 4) {
      for (let u = 2; u < size.width; u += 4) {
        const point = new Vector3(left + ((u + 0.5) / size.width) * (right - left), top + ((v + 0.5) / size.height) * (bottom - top), depth)
          .applyQuaternion(turn).add(new Vector3(row[at], row[at + 1], row[at + 2])).project(eye);
        places.push({ u, v, x: ((point.x + 1) / 2) * box.width, y: ((1 - point.y) / 2) * box.height });
      }
    }
    return places;
  };

  /**
   * Returns the grey levels at these places in the camera's panel and in the 3D view. Data are passed as text, which is
   * many times faster.
   */
  const greys = async (index: number, places: Place[], stage: Buffer): Promise<Grey[]> => JSON.parse(await page.evaluate(async ({ nth, wanted, text }) => {
    const image = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], { type: 'image/png' }));
    const view = new OffscreenCanvas(image.width, image.height).getContext('2d')!;
    view.drawImage(image, 0, 0);
    const panel = document.querySelectorAll<HTMLCanvasElement>('.picture canvas')[nth];
    const pixels = (context: CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D, width: number, height: number) => {
      const { data } = context.getImageData(0, 0, width, height);
      return (x: number, y: number): number => data[4 * (Math.floor(y) * width + Math.floor(x)) + 1];
    };
    const [shown, picture] = [pixels(view, image.width, image.height), pixels(panel.getContext('2d')!, panel.width, panel.height)];
    return JSON.stringify((JSON.parse(wanted) as Place[]).map(({ u, v, x, y }) => {
      // Only places with a uniform neighbourhood: a pixel of the view covers several of the picture.
      const around = [-4, 0, 4].flatMap((dv) => [-4, 0, 4].map((du) =>
        picture(Math.min(639, Math.max(0, u + du)), Math.min(479, Math.max(0, v + dv)))));
      return { picture: picture(u, v), range: Math.max(...around) - Math.min(...around), shown: shown(x, y) };
    }));
  }, { nth: index, wanted: JSON.stringify(places), text: stage.toString('base64') })) as Grey[];

  test('before each camera hangs its own picture, the right way round', async () => {
    await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
    await page.getByRole('tab', { name: 'Arm' }).click();
    await page.keyboard.press('Backspace');
    await until(async () => Math.hypot(...(await server_state(page)).bends) < 1e-6);
    // Bent to different sides as seen by the two cameras.
    for (const [axis, bend] of [0.9, -0.7].entries()) {
      await slide(page, `#arm-bends-${axis}`, bend);
      await until(async () => Math.abs((await server_state(page)).bends[axis] - bend) < 0.02, 8000, `bend ${bend}`);
    }
    // From between the cameras, where neither picture hides the arm.
    // In a large window the thin arm covers some pixels of the view.
    await page.setViewportSize({ width: 1600, height: 1000 });
    await page.keyboard.press('Numpad1');
    while ((await orbit_of(page)).azimuth < 0.6) await page.keyboard.press('Numpad6');
    while ((await orbit_of(page)).elevation < 0.3) await page.keyboard.press('Numpad8');
    await page.keyboard.press('0');
    for (let i = 0; i < 3; ++i) await page.keyboard.press('PageDown');
    const stage = await stage_at_rest(page);
    for (const index of [0, 1]) {
      const even = (await greys(index, await places_of(index), stage)).filter(({ range }) => range < 60);
      const levels = even.map(({ picture }) => picture);
      const middle = (Math.min(...levels) + Math.max(...levels)) / 2;
      for (const [kind, some] of [['dark', even.filter(({ picture }) => picture < middle)], ['bright', even.filter(({ picture }) => picture >= middle)]] as const) {
        // The picture is slightly transparent, and objects in front cover a part of it.
        const right = some.filter(({ picture, shown }) => Math.abs(shown - 0.92 * picture) < 25).length / some.length;
        expect(some.length, `${kind} in picture ${index}`).toBeGreaterThan(30);
        expect(right, `${kind} in picture ${index}`).toBeGreaterThan(0.8);
      }
    }
    await page.setViewportSize({ width: 1280, height: 720 });
    await page.keyboard.press('Backspace');
    await page.keyboard.press('0');
  });
}
