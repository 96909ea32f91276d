import { expect, test } from 'vitest';
import { fitted, limits_of, standard_of } from '../../src/ui/sizes';

const windows = [[1440, 900], [1280, 720], [1024, 768], [901, 600], [2560, 1440]].map(([width, height]) => ({ width, height }));

test('areas have their standard sizes until they are dragged', () => {
  for (const extent of windows.slice(0, 3)) expect(fitted({}, extent)).toEqual(standard_of(extent));
});

test('nothing vanishes, whatever was stored', () => {
  for (const extent of windows) {
    for (const size of [-50, 0, 330, 1e6, NaN, Infinity, 'wide', null]) {
      const { left, right, plots } = fitted({ left: size, right: size, plots: size }, extent);
      expect(left).toBeGreaterThanOrEqual(240);
      expect(right).toBeGreaterThanOrEqual(200);
      expect(plots).toBeGreaterThanOrEqual(110);
      expect(extent.width - left - right).toBeGreaterThanOrEqual(300);
      expect(extent.height - plots - 94).toBeGreaterThanOrEqual(160);
    }
  }
});

test('a dragged size is kept where there is room', () => {
  expect(fitted({ left: 500, plots: 300 }, { width: 1440, height: 900 })).toEqual({ left: 500, right: 336, plots: 300 });
  expect(fitted({ left: 500 }, { width: 1024, height: 768 })).toEqual({ left: 500, right: 224, plots: 177 });
});

test('limits leave room for the others', () => {
  const extent = { width: 1440, height: 900 };
  expect(limits_of('left', standard_of(extent), extent)).toEqual([240, 804]);
  expect(limits_of('right', standard_of(extent), extent)).toEqual([200, 840]);
  expect(limits_of('plots', standard_of(extent), extent)).toEqual([110, 646]);
});
