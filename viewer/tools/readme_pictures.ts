// `FLEXURA_PROGRAM=.../bin/flexura npm run pictures`: the documents' pictures of the viewer, of the program with its page.
import { writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { launch, open_page, slide, until } from '../test/e2e/browser';
import { Program, program } from '../test/e2e/program';
import { palette_png, pixels_of } from './palette_png';

/** Around the arm of example 18, and on it, px. */
const finder_corners: [number, number][] = [[280, 105], [440, 105], [440, 290], [370, 410], [280, 410]];
const finder_pixel: [number, number] = [389, 220];
const finder_arm = ['arm.look.color=[0.8,0.6,0.02]', 'arm.initial={bends=[[0.9,0.2],[-1.2,0.3],[0.8,0]]}'];

const root = fileURLToPath(new URL('../../', import.meta.url));
if (!program) throw new Error('FLEXURA_PROGRAM names the program: there is none');
const browser = await launch();
const served = new Program(`${root}examples/03_cameras/experiment.toml`);
await served.start();

const { page } = await open_page(browser, served.url, { width: 1440, height: 900, dark: true });
await until(async () => (await page.locator('.picture .none').count()) === 0, 30000);
for (const [i, bend] of [0.75, 0.5, -1.25, 0.75, 1.25].entries()) {
  await slide(page, `#arm-bends-${i}`, bend);
  await page.waitForTimeout(700);
}
for (const label of ['Edges', 'Axis']) await page.getByRole('button', { name: new RegExp(`^${label}: `) }).click();
// All of the way from straight to bent is in the plots, the view has come to rest, and no picture is late.
await page.waitForTimeout(4000);
await until(async () => (await page.locator('.picture .old').count()) === 0, 30000);
await page.screenshot({ path: `${root}docs/images/viewer.png` });

const teach = await open_page(browser, `${new URL(served.url).origin}/#/teach`, { width: 1280, height: 720, dark: false });
await teach.page.waitForSelector('.plane');
await teach.page.locator('.recurrence tbody tr').nth(2).click();
await teach.page.waitForTimeout(500);
await teach.page.screenshot({ path: `${root}docs/images/teaching.png` });

// A servo as its recording has it, in the middle of its way.
const servo = new Program();
const shown = new Program(['view', servo.record(`${root}viewer/tools/servo_picture.toml`)]);
await shown.start();
const steered = await open_page(browser, shown.url, { width: 1280, height: 720, dark: false });
await until(async () => (await steered.page.locator('.picture .none').count()) === 0, 30000);
await slide(steered.page, '#scrub', 0.4);
await steered.page.getByLabel('Plot 2 shows').selectOption({ label: 'Servo error, %' });
await steered.page.getByLabel('Plot 1 shows').selectOption({ label: 'Errors along the arm' });
await steered.page.waitForTimeout(4000);
// Without the sliders of what a recording cannot move.
await steered.page.screenshot({ path: `${root}docs/images/servo-viewer.png`, clip: { x: 281, y: 45, width: 999, height: 627 } });
await shown.stop();
await servo.stop();

// A picture file, in which a region and a colour say where the arm is.
const made = new Program();
const photo = made.render(`${root}examples/18_clutter_servo/experiment.toml`, 'front', 0, finder_arm);
const file = new Program(['view', photo]);
await file.start();
const [width, height] = [1100, 620];
const finder = await open_page(browser, file.url, { width, height, dark: false });
await until(async () => (await finder.page.locator('.finder .result').count()) > 0, 30000);
const canvas = finder.page.locator('.camera canvas');
const tool = (name: string) => finder.page.locator('.finder').getByRole('button', { name, exact: true });
const place = async (u: number, v: number): Promise<[number, number]> => {
  const box = (await canvas.boundingBox())!;
  return [box.x + ((u + 0.5) / 640) * box.width, box.y + ((v + 0.5) / 480) * box.height];
};
await tool('Polygon').click();
for (const corner of finder_corners) await finder.page.mouse.click(...(await place(...corner)));
await finder.page.keyboard.press('Enter');
await tool('Colour').click();
await finder.page.mouse.click(...(await place(...finder_pixel)));
await finder.page.waitForTimeout(3000);
const shot = await finder.page.screenshot();
writeFileSync(`${root}docs/images/finder.png`, palette_png(await pixels_of(finder.page, shot), width, height));
await file.stop();
await made.stop();

await browser.close();
await served.stop();
