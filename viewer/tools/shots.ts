// `npm run shots [FOLDER]`: pictures of the page as it stands, to look at.
import { mkdirSync } from 'node:fs';
import { planar_rig, spatial_rig } from '../test/fake/rigs';
import { FakeServer } from '../test/fake/server';
import { dist, launch, open_page } from '../test/e2e/browser';

const folder = process.argv[2] ?? 'test-output';
mkdirSync(folder, { recursive: true });
const only = process.argv[3];
const browser = await launch();

interface Shot {
  name: string;
  rig: ReturnType<typeof planar_rig>;
  mode: 'live' | 'recording';
  width: number;
  height: number;
  dark: boolean;
  hash?: string;
}

const sizes = [[1440, 900], [1280, 720]] as const;
const shots: Shot[] = sizes.flatMap(([width, height]) => [true, false].flatMap((dark): Shot[] => {
  const tail = `${width}-${dark ? 'dark' : 'light'}`;
  return [
    { name: `live-${tail}`, rig: spatial_rig(), mode: 'live', width, height, dark },
    { name: `paper-${tail}`, rig: planar_rig(), mode: 'recording', width, height, dark },
    { name: `teach-${tail}`, rig: planar_rig(), mode: 'live', width, height, dark, hash: '#/teach' },
  ];
}));

for (const { name, rig, mode, width, height, dark, hash } of shots) {
  if (only && !name.includes(only)) continue;
  const server = new FakeServer(dist, rig, mode);
  await server.start();
  const { page, complaints } = await open_page(browser, server.url, { width, height, dark });
  await page.waitForSelector('.badge, .teach');
  if (hash) await page.goto(`http://127.0.0.1:${server.port}/${hash}`);
  await page.waitForTimeout(800);
  if (mode === 'live') server.session.arm.command(rig.goal.map(([x, y]) => [0.8 * x, 0.8 * y]));
  else await page.locator('#scrub').evaluate((input: HTMLInputElement) => {
    input.value = '2.2';
    input.dispatchEvent(new Event('input', { bubbles: true }));
  });
  await page.waitForTimeout(2500);
  await page.screenshot({ path: `${folder}/${name}.png` });
  if (complaints.length) console.log(name, complaints);
  await page.context().close();
  await server.stop();
}
await browser.close();
