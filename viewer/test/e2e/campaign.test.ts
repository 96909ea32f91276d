// A campaign in the viewer: its progress, the distributions of its measures, and its report.
import { spawnSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { until, type Opened } from './browser';
import { started, visit, type Served } from './opened';
import { Program, program } from './program';

const campaign = `title = "Lengths of an arm"
experiment = "${fileURLToPath(new URL('run.toml', import.meta.url))}"
samples = 40
[[parameter]]
kind = "uniform"
path = "arm.section.0.length"
name = "length"
low = 0.3
high = 0.6
[[measure]]
key = "tip.position.1"
name = "height"
`;

describe.skipIf(!program)('a campaign', () => {
  let made: Program;
  let served: Served;
  let opened: Opened;

  beforeAll(async () => {
    made = new Program();
    writeFileSync(join(made.folder, 'lengths.toml'), campaign);
    const { status, stderr } = spawnSync(program!, ['campaign', 'lengths.toml', '--out', 'lengths.db'], { cwd: made.folder, encoding: 'utf8' });
    if (status !== 0) throw new Error(`campaign ended with ${status}: ${stderr}`);
    served = await started(['view', join(made.folder, 'lengths.db')]);
    opened = await visit(served.url);
  });

  afterAll(async () => {
    await served?.stop();
    await made?.stop();
  });

  test('shows its progress and a histogram first, and the rig of a run', async () => {
    const { page } = opened;
    await page.waitForSelector('.campaign .histogram');
    expect(await page.locator('#tab-campaign').getAttribute('aria-selected')).toBe('true');
    expect(await page.locator('.campaign-state').textContent()).toBe('Complete: all 40 runs are done.');
    expect(await page.locator('.statuses').textContent()).toContain('40 of 40 runs');
    expect(await page.locator('.statuses tr[data-status="done"]').textContent()).toContain('40 (100 %)');
    expect(await page.locator('.campaign progress').evaluate((bar: HTMLProgressElement) => bar.position)).toBe(1);
    expect(await page.getByRole('img', { name: /^Distribution of height in 40 runs, from / }).locator('rect').count()).toBe(7);
    await page.locator('#tab-arm').click();
    await page.waitForSelector('.section .slider');
    await page.locator('#tab-campaign').click();
  });

  test('its report opens from the page', async () => {
    const { page, complaints } = opened;
    const link = page.getByRole('link', { name: 'Report of the campaign' });
    const [report] = await Promise.all([page.context().waitForEvent('page'), link.click()]);
    await report.waitForLoadState();
    expect(await report.title()).toContain('Lengths of an arm');
    await until(() => report.evaluate(() => document.body.textContent!.includes('Sensitivity')));
    expect(await report.locator('svg').count()).toBeGreaterThan(1);
    await report.close();
    expect(complaints).toEqual([]);
  });
});
