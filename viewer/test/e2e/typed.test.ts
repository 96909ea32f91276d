// What is typed into fields: what is taken of it is said, and keys are the page's again after Enter.
import type { Page } from 'playwright-core';
import { beforeEach, expect, test } from 'vitest';
import { until } from './browser';
import { fresh_before_each } from './opened';
import type { FakeServer } from '../fake/server';

let page: Page;
let server: FakeServer;
fresh_before_each((fresh) => {
  ({ page, server } = fresh);
});

const field = () => page.locator('.section .number').first();
const told = async (role: 'status' | 'alert') => (await page.locator(`.notices [role="${role}"]`).textContent()) ?? '';
const halts = () => server.log.filter(({ do: what }) => what === 'halt').length;
const focused = () => page.evaluate(() => document.activeElement?.tagName);

beforeEach(async () => {
  await field().waitFor();
});

test('a value beyond a limit is clamped, and that is said', async () => {
  await field().fill('500');
  await field().press('Enter');
  await until(async () => /500\.0 ° is above the limit. It is set to [\d.]+ °/.test(await told('status')), 8000, 'nothing is said');
  const limit = /set to ([\d.]+) °/.exec(await told('status'))![1];
  await until(async () => (await field().inputValue()) === limit);
  await field().fill('-500');
  await field().press('Enter');
  await until(async () => /−500\.0 ° is below the limit/.test(await told('status')));
});

test('a value within the limits needs no word', async () => {
  await field().fill('5');
  await field().press('Enter');
  await until(() => server.log.some(({ do: what }) => what === 'arm'));
  expect(await told('status')).toBe('');
});

test('what is no number is refused, and that is said', async () => {
  const before = await field().inputValue();
  await field().fill('abc');
  await field().press('Enter');
  await until(async () => /“abc” is not a number\. The value stays/.test(await told('alert')), 8000, 'nothing is said');
  expect(await field().inputValue()).toBe(before);
  expect(server.log.some(({ do: what }) => what === 'arm')).toBe(false);
});

test('Enter leaves the field', async () => {
  await field().fill('5');
  expect(await focused()).toBe('INPUT');
  await field().press('Enter');
  expect(await focused()).toBe('BODY');
  expect(server.log.filter(({ do: what }) => what === 'arm')).toHaveLength(1);
});

test('H halts from any focus, and that is confirmed', async () => {
  await field().focus();
  await page.keyboard.press('h');
  await until(() => halts() === 1, 8000, 'not from a field');
  expect(await field().inputValue()).not.toContain('h');
  await until(async () => /Halted: everything has stopped/.test(await told('status')));
  await page.locator('#scrub').focus();
  await page.keyboard.press('h');
  await until(() => halts() === 2, 8000, 'not from a slider');
  await page.getByLabel('Plot 1 shows').focus();
  await page.keyboard.press('h');
  await until(() => halts() === 3, 8000, 'not from a list');
  await page.keyboard.press('F1');
  await page.waitForSelector('dialog.help[open]');
  await page.keyboard.press('h');
  await until(() => halts() === 4, 8000, 'not from the help');
  await page.getByLabel('Enable keys').uncheck();
  await page.keyboard.press('F8');
  await page.waitForTimeout(300);
  expect(halts()).toBe(4);
  await page.getByLabel('Enable keys').check();
  await page.keyboard.press('F8');
  await until(() => halts() === 5);
});
