// `FLEXURA_PROGRAM=.../bin/flexura npm run gallery [FOLDER]`: the README's pictures of the page in three widths and both
// themes, as small PNG files. Needs a build, and a machine that does nothing else.
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { launch, open_page, slide, until } from '../test/e2e/browser';
import { Program, program } from '../test/e2e/program';
import { palette_png } from './palette_png';

const root = fileURLToPath(new URL('../../', import.meta.url));
const folder = process.argv[2] ?? `${root}docs/images`;
if (!program) throw new Error('FLEXURA_PROGRAM names the program: there is none');

/** Returns the pixels of a PNG file, RGBA. */
async function pixels_of(page: Page, png: Buffer): Promise<Uint8Array> {
  const text = await page.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d')!;
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    let out = '';
    for (let i = 0; i < data.length; i += 8192) out += String.fromCharCode(...data.subarray(i, i + 8192));
    return btoa(out);
  }, png.toString('base64'));
  return Buffer.from(text, 'base64');
}

const browser = await launch();
const served = new Program(`${root}examples/03_cameras/experiment.toml`);
await served.start();
for (const [width, height] of [[1440, 900], [1024, 700], [390, 780]]) {
  for (const dark of [true, false]) {
    const { page, complaints } = await open_page(browser, served.url, { width, height, dark });
    await until(async () => (await page.locator('.picture .none').count()) === 0, 30000, 'no picture came');
    for (const [i, bend] of [0.75, 0.5, -1.25, 0.75, 1.25].entries()) await slide(page, `#arm-bends-${i}`, bend);
    // The arm has come to rest, the view is drawn finely, and no picture is late.
    await page.waitForTimeout(3000);
    const is_late = async () => (await page.locator('.picture .old').count()) > 0;
    let shot = Buffer.alloc(0);
    await until(async () => {
      if (await is_late()) return false;
      shot = await page.screenshot();
      return !(await is_late());
    }, 120000, 'the pictures are late: the machine does something else');
    const name = `${folder}/page-${width}-${dark ? 'dark' : 'light'}.png`;
    const png = palette_png(await pixels_of(page, shot), width, height);
    writeFileSync(name, png);
    console.log(`${name}: ${(png.length / 1000).toFixed(0)} kB`);
    if (complaints.length) throw new Error(complaints.join('\n'));
    await page.context().close();
  }
}
await browser.close();
await served.stop();
