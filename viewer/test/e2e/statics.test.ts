// Elastic arms: individually driven tendons, their tensions, and switching off the weight.
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { server_state, slide, until } from './browser';
import { faked, opened_before, started, visit } from './opened';
import { program } from './program';

const example = (name: string): string => fileURLToPath(new URL(`../../../examples/${name}/experiment.toml`, import.meta.url));

const distance = (a: number[], b: number[]): number => Math.hypot(...a.map((x, i) => x - b[i]));

test('what nobody asked for is told at once', async () => {
  const server = await faked();
  const { page } = await visit(server.url);
  await page.waitForSelector('.badge[data-kind="live"]');
  server.broadcast({ type: 'event', time: 1, level: 'info', name: 'reach', text: 'of the log alone' });
  server.broadcast({ type: 'event', time: 1, level: 'warning', name: 'statics', text: 'the arm snaps', notice: true });
  await page.waitForSelector('.notice');
  expect(await page.locator('.notice').allTextContents()).toEqual(['The arm snaps']);
  await server.stop();
});

describe.skipIf(!program)('an arm under its tendons', () => {
  const opened = opened_before(() => started(example('09_tendon_statics')), 'live');

  test('has a slider a tendon, which says by which it pulls', async () => {
    const { page, complaints } = opened;
    const before = await server_state(page);
    expect(before.actuators).toHaveLength(6);
    await page.getByRole('button', { name: 'Tendons' }).click();
    expect(await page.locator('.actuator').count()).toBe(6);
    expect(await page.locator('#weight').count()).toBe(0);
    await slide(page, '#actuator-0', 0.005);
    await until(async () => Math.abs((await server_state(page)).actuators[0][0] - 0.005) < 1e-4);
    const pulled = await server_state(page);
    // The tendons of the same section moved too.
    expect(pulled.actuators[1][0]).toBeCloseTo(-0.0025, 4);
    expect(pulled.actuators[3][0]).toBeCloseTo(0.005, 4);
    expect(distance(pulled.tip, before.tip)).toBeGreaterThan(0.05);
    const pulls = await page.locator('.pull .force').allTextContents();
    expect(pulls).toContain('slack');
    await until(async () => /^\d.* N$/.test((await page.locator('.pull .force').allTextContents())[0]), 4000, 'no tension came');
    expect(complaints).toEqual([]);
  });

  test('moves one alone, against the others', async () => {
    const { page } = opened;
    const before = await server_state(page);
    await page.getByLabel('The other tendons follow').uncheck();
    await slide(page, '#actuator-5', 0.001);
    await until(async () => Math.abs((await server_state(page)).actuators[5][0] - 0.001) < 1e-4);
    const after = await server_state(page);
    expect(after.actuators[0][0]).toBeCloseTo(before.actuators[0][0], 5);
    await page.getByLabel('The other tendons follow').check();
  });

  test('shows in its tendons what its bends ask of them', async () => {
    const { page, complaints } = opened;
    await page.getByRole('button', { name: 'Bends' }).click();
    await slide(page, '#arm-bends-0', 0.4);
    await slide(page, '#arm-bends-1', 0);
    await until(async () => Math.abs((await server_state(page)).bends[1]) < 1e-3);
    await page.getByRole('button', { name: 'Tendons' }).click();
    const { bends, actuators } = await server_state(page);
    // The tendon at 90 degrees is pulled in by the bend towards y, that at -30 degrees by cos 30 of the bend towards x.
    expect(actuators[0][0]).toBeCloseTo(0.01 * bends[1], 4);
    expect(actuators[1][0]).toBeCloseTo(0.01 * bends[0] * Math.cos(Math.PI / 6), 4);
    await until(async () => Math.abs(Number(await page.getByLabel('Tendon 2, pulled in, mm').inputValue()) - 1000 * actuators[1][0]) < 0.02);
    expect(complaints).toEqual([]);
  });

  test('refuses what no tendon can in one line', async () => {
    const { page } = opened;
    const refused = await page.evaluate(() => new Promise<string>((resolve) => {
      const socket = new WebSocket(new URL('socket', location.href.replace(/^http/, 'ws').replace(/#.*/, '')));
      socket.onopen = () => socket.send(JSON.stringify({ id: 1, do: 'arm', tendons: [1, 0, 0, 0, 0, 0] }));
      socket.onmessage = ({ data }) => {
        const message = typeof data === 'string' ? (JSON.parse(data) as { type: string; error?: string }) : null;
        if (message?.type !== 'reply') return;
        socket.close();
        resolve(message.error ?? '');
      };
    }));
    expect(refused).toMatch(/^tendons\[0\] = 1: expected -0\.\d+ to 0\.\d+ m$/);
  });
});

describe.skipIf(!program)('an arm that sags', () => {
  const opened = opened_before(() => started(example('10_sagging_arm')), 'live');

  test('is without its weight until it is reset', async () => {
    const { page, complaints } = opened;
    await slide(page, '#arm-bends-0', 0.8);
    await until(async () => Math.abs((await server_state(page)).bends[0] - 0.8) < 1e-2);
    const heavy = await server_state(page);
    await page.locator('#weight').click();
    await page.waitForSelector('.badge[data-kind="weightless"]');
    await until(async () => (await server_state(page)).is_weightless);
    const light = await server_state(page);
    expect(distance(light.tip, heavy.tip)).toBeGreaterThan(3e-3);
    expect(await page.locator('#weight').isChecked()).toBe(false);
    await page.locator('#weight').click();
    await until(async () => (await page.locator('.badge[data-kind="weightless"]').count()) === 0);
    await until(async () => distance((await server_state(page)).tip, heavy.tip) < 1e-3);
    await page.locator('#weight').click();
    await page.waitForSelector('.badge[data-kind="weightless"]');
    await page.getByRole('button', { name: 'Reset' }).click();
    await until(async () => (await page.locator('.badge[data-kind="weightless"]').count()) === 0);
    expect(await page.locator('#weight').isChecked()).toBe(true);
    expect(complaints).toEqual([]);
  });
});

describe.skipIf(!program)('a watched run of an elastic arm', () => {
  const opened = opened_before(
    () => started(['run', example('11_helical_tendon'), '--set', 'task.0.duration=60', '--view', '--speed', '0']), 'live');

  test('shows how it truly lies, and its tensions', async () => {
    const { page, complaints } = opened;
    const seen = async () => {
      const state = await server_state(page);
      return { ...state, bend: Math.hypot(...state.bends), force: state.actuators[0]?.[1] ?? 0 };
    };
    await until(async () => (await seen()).bend > 0.3, 60000, 'the run did not go on');
    const { actuators, force, tip, bend, is_running } = await seen();
    expect(is_running).toBe(true);
    expect(actuators).toHaveLength(2);
    expect(force).toBeGreaterThan(0);
    // For an arc with this bend, the tip would be in one plane with the base's axis, at this height.
    const height = (0.5 * Math.sin(bend)) / bend;
    expect(Math.abs(tip[1] - height) + Math.abs(tip[0])).toBeGreaterThan(2e-3);
    await page.getByRole('button', { name: 'Tendons' }).click();
    await until(async () => / N$/.test((await page.locator('.pull .force').allTextContents())[0] ?? ''), 4000, 'no tension is shown');
    expect(await page.locator('#actuator-0').isDisabled()).toBe(true);
    expect(await page.locator('#weight').isDisabled()).toBe(true);
    // So does the history: the plots show the rod.
    const legend = async (): Promise<number[]> => {
      const texts = await page.locator('.plot').first().locator('.legend li').allTextContents();
      return texts.map((text) => Number(/[−\d.]+$/.exec(text)?.[0].replace('−', '-')));
    };
    await page.getByLabel('Plot 1 shows').selectOption('tip');
    // The run goes on between both readings.
    await until(async () => distance(await legend(), (await seen()).tip) < 0.02, 10000, 'the plot shows another tip');
    await page.getByLabel('Plot 1 shows').selectOption('tensions');
    await until(async () => (await legend())[0] > 0, 4000, 'no tension is plotted');
    expect(complaints).toEqual([]);
  }, 120000);
});
