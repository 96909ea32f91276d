// What is commanded of one axis of a camera moves no other, also where the camera stands elsewhere than it is believed to.
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { server_state, until } from './browser';
import { opened_before, started } from './opened';
import { program } from './program';

const file = fileURLToPath(new URL('run.toml', import.meta.url));
const degree = Math.PI / 180;

describe.skipIf(!program)('a camera’s axes', () => {
  const opened = opened_before(() => started(['view', file]), 'live');
  const field = (axis: string) => opened.page.getByLabel(`Camera front, ${axis}`, { exact: false }).locator('visible=true').and(opened.page.locator('.number'));
  const head = async () => (await server_state(opened.page)).camera.slice(7, 10);

  test('show what is commanded, and one does not move the others', async () => {
    const { page } = opened;
    await page.getByRole('tab', { name: 'Cameras' }).click();
    expect(await field('pan').inputValue()).toBe('0.0');
    expect(await field('tilt').inputValue()).toBe('0.0');
    const before = await head();
    expect(before[0]).toBeCloseTo(0.4 * degree, 5);
    await field('zoom').fill('1.5');
    await field('zoom').press('Enter');
    await until(async () => Math.abs((await head())[2] - 1.5) < 1e-3, 15_000, 'it does not zoom');
    await page.waitForTimeout(500);
    const after = await head();
    expect(after[0]).toBeCloseTo(0.4 * degree, 5);
    expect(after[1]).toBeCloseTo(-0.3 * degree, 5);
    expect(await field('pan').inputValue()).toBe('0.0');
    expect(await field('zoom').inputValue()).toBe('1.50');
  });

  test('show where they truly stand when that is wanted, marked as such', async () => {
    const { page, complaints } = opened;
    expect(await page.locator('.truth').count()).toBe(0);
    await page.getByLabel('Show where they truly stand').check();
    expect((await page.locator('.truth').first().textContent())!.replace(/\s+/g, ' ')).toBe('truly 0.40 °');
    expect(await field('pan').inputValue()).toBe('0.0');
    await page.getByLabel('Show where they truly stand').uncheck();
    expect(complaints).toEqual([]);
  });
});
