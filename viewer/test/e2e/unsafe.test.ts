// The timeline of an unsafe run must agree with `flexura check` for the same file.
import { spawnSync } from 'node:child_process';
import { fileURLToPath } from 'node:url';
import { describe, expect, test } from 'vitest';
import { slide, until } from './browser';
import { opened_before, recorded } from './opened';
import { program } from './program';

const file = fileURLToPath(new URL('unsafe.toml', import.meta.url));

interface Violation {
  start: number;
  end: number;
  text: string;
}

describe.skipIf(!program)('a run that was unsafe', () => {
  const opened = opened_before(() => recorded(file, 1), 'recording');

  test('has a band for each violation, as long as it lasts', async () => {
    const { page, complaints } = opened;
    const checked = spawnSync(program!, ['check', '--json', file], { encoding: 'utf8' });
    expect(checked.status).toBe(1);
    const { violations } = JSON.parse(checked.stdout) as { violations: Violation[] };
    expect(violations).toHaveLength(5);
    const line = (await page.locator('.line').boundingBox())!;
    const duration = Number(await page.locator('#scrub').getAttribute('max'));
    expect(duration).toBe(6);
    const seconds = (px: number): number => (px / line.width) * duration;
    const bands = await page.locator('.mark[data-level="error"]').evaluateAll((all) => all.map((band) => {
      const { left, width } = band.getBoundingClientRect();
      return { left, width, title: (band as HTMLElement).title };
    }));
    expect(bands).toHaveLength(violations.length);
    const a_pixel = seconds(1);
    for (const { start, end, text } of violations) {
      const own = bands.filter(({ title }) => title.endsWith(text));
      expect(own, text).toHaveLength(1);
      expect(Math.abs(seconds(own[0].left - line.x) - start), text).toBeLessThan(a_pixel);
      expect(Math.abs(seconds(own[0].width) - (end - start)), text).toBeLessThan(a_pixel);
    }
    const badge = page.locator('.badge[data-kind="unsafe"]');
    for (const { time, is_unsafe } of [{ time: 1, is_unsafe: false }, { time: 3, is_unsafe: true }, { time: 5.5, is_unsafe: true }]) {
      expect(violations.some(({ start, end }) => start <= time && time <= end)).toBe(is_unsafe);
      await slide(page, '#scrub', time);
      await until(async () => (await badge.count()) === (is_unsafe ? 1 : 0), 8000, `at ${time} s`);
    }
    expect(complaints).toEqual([]);
  });
});
