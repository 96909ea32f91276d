import { expect, test } from 'vitest';
import { draw_layers, overlays } from '../../src/overlays/registry';
import type { Layer } from '../../src/protocol/types';

/** A drawing context that records all calls. */
function recorder(): { context: CanvasRenderingContext2D; calls: string[] } {
  const calls: string[] = [];
  const context = new Proxy({}, {
    get: (_, name) => (...values: number[]) => calls.push(`${String(name)}(${values.join()})`),
    set: (_, name, value) => calls.push(`${String(name)}=${String(value)}`) > 0,
  }) as unknown as CanvasRenderingContext2D;
  return { context, calls };
}

const layers: Layer[] = [
  { id: 'axis', kind: 'polyline', points: [[1, 2], [3, 4]], closed: true, dashed: true, color: '#112233' },
  { id: 'markers', kind: 'points', points: [[10, 20]] },
  { id: 'circle', kind: 'ellipse', center: [5, 6], axes: [7, 8], angle: 0.5 },
  { id: 'features', kind: 'lines', lines: [[[1, 1], [2, 3]], [[5, 5], [6, 7], [8, 9]]], dashed: true, color: '#445566' },
  { id: 'mask', kind: 'runs', rows: [[3, 10, 14]] },
];

test('the kinds of the protocol are drawn', () => {
  const { context, calls } = recorder();
  draw_layers(context, layers, 2);
  expect(calls).toContain('lineTo(3,4)');
  expect(calls).toContain('closePath()');
  expect(calls).toContain('setLineDash(12,10)');
  expect(calls.some((call) => call.startsWith('ellipse(5,6,7,8,0.5,'))).toBe(true);
  expect(calls).toContain('fillRect(9.5,2.5,5,1)');
  expect(calls).toContain('strokeStyle=#112233');
  expect(calls.filter((call) => call === 'save()')).toHaveLength(layers.length);
  expect(calls.filter((call) => call === 'restore()')).toHaveLength(layers.length);
});

test('lines that do not hang together are not joined', () => {
  const { context, calls } = recorder();
  draw_layers(context, layers.filter(({ kind }) => kind === 'lines'), 1);
  const drawn = calls.filter((call) => /^(moveTo|lineTo|stroke)\(/.test(call));
  expect(drawn).toEqual(['moveTo(1,1)', 'lineTo(2,3)', 'moveTo(5,5)', 'lineTo(6,7)', 'lineTo(8,9)', 'stroke()']);
  expect(calls).toContain('setLineDash(4,3)');
});

test('a circle that the axis is not found to be part of is dashed', () => {
  const dashes = (verified?: boolean): string[] => {
    const { context, calls } = recorder();
    draw_layers(context, [{ ...layers[2], verified }], 2);
    return calls.filter((call) => call.startsWith('setLineDash'));
  };
  expect(dashes(false)).toEqual(['setLineDash(12,10)']);
  expect(dashes(true)).toEqual([]);
  expect(dashes(undefined)).toEqual([]);
});

test('pixel (0, 0) is the middle of the first one', () => {
  const { context, calls } = recorder();
  draw_layers(context, [layers[0]], 1);
  expect(calls).toContain('translate(0.5,0.5)');
});

test('a kind that is not known is passed over', () => {
  const { context, calls } = recorder();
  draw_layers(context, [{ id: 'x', kind: 'hologram' }], 1);
  expect(calls).toEqual([]);
  expect(new Set(overlays.map(({ kind }) => kind)).size).toBe(overlays.length);
});
