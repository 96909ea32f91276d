// The page of `flexura view` without a file.
import { afterAll, beforeAll, expect, test } from 'vitest';
import type { Page } from 'playwright-core';
import { until } from './browser';
import { visit } from './opened';
import { Program, program } from './program';

const viewer = new Program(['view']);
let page: Page;

beforeAll(async () => {
  if (!program) return;
  await viewer.start();
  ({ page } = await visit(viewer.url));
});
afterAll(() => viewer.stop());

test.runIf(program)('the examples are offered at the start, and one of them opens', async () => {
  const dialog = page.getByRole('dialog', { name: 'Open an example' });
  await dialog.waitFor();
  expect(await dialog.getByRole('listitem').count()).toBeGreaterThan(8);
  await dialog.getByRole('button', { name: 'Steering the shape' }).click();
  await until(async () => (await page.title()).includes('Steering the shape'));
  expect(await dialog.isVisible()).toBe(false);
  expect(await page.locator('select[aria-label="Tasks to run"] option').count()).toBeGreaterThan(3);
});

test.runIf(program)('another one opens from the header', async () => {
  await page.getByRole('button', { name: 'Examples' }).click();
  const dialog = page.getByRole('dialog', { name: 'Open an example' });
  await dialog.getByRole('button', { name: /tendons/i }).first().click();
  await until(async () => !(await page.title()).includes('Steering the shape'));
  await page.getByRole('button', { name: 'Tendons' }).waitFor();
});
