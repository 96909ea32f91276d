// `FLEXURA_PROGRAM=.../bin/flexura npm run gallery [FOLDER]`: the README's pictures of the page in three widths and both
// themes, as small PNG files. Needs a build, and a machine that does nothing else.
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { launch, open_page, slide, until } from '../test/e2e/browser';
import { Program, program } from '../test/e2e/program';
import { palette_png, pixels_of } from './palette_png';

const root = fileURLToPath(new URL('../../', import.meta.url));
const folder = process.argv[2] ?? `${root}docs/images`;
if (!program) throw new Error('FLEXURA_PROGRAM names the program: there is none');

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
