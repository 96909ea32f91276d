// Region, colour and base of the arm in a camera's pictures.
import { expect, test } from 'vitest';
import { Finder, found_text, no_color } from '../../src/panels/finder';
import type { Corner, SceneCamera } from '../../src/protocol/types';
import { RegionTool } from '../../src/state/region_tool';
import { lines_of, most_corners, options_of, outline_of, quoted, Seeing } from '../../src/state/seeing';

const front: SceneCamera = { name: 'front', width: 640, height: 480, channels: 3 };

function made(camera: SceneCamera = front, answer: () => Promise<unknown> = async () => ({ color: [200, 30, 40], number: 1 })) {
  const seeing = new Seeing();
  seeing.take([camera], 'one');
  const asked: unknown[] = [];
  const request = async <Result>(what: string, values: Record<string, unknown>): Promise<Result> => {
    asked.push([what, values]);
    return (await answer()) as Result;
  };
  return { seeing, asked, finder: new Finder(camera, { seeing, link: { request } }) };
}

test('a rectangle is dragged, or clicked at two corners', () => {
  const { finder, seeing } = made();
  for (const drags of [true, false]) {
    finder.choose('rectangle');
    finder.press([300.2, 200.4], 4);
    finder.move([100, 50]);
    expect(finder.layers({})[0].points).toHaveLength(4);
    if (!drags) finder.release([301, 200], 4), finder.press([100, 50], 4);
    finder.release([100, 50], 4);
    expect(seeing.choice_of('front')).toEqual({ region: [[100, 50], [300, 200]] });
    expect(finder.tool.value).toBeNull();
    seeing.clear('front');
  }
});

test('a polygon is closed by Enter, by a double click and at its first corner', () => {
  const corners: Corner[] = [[10, 10], [200, 20], [150, 220]];
  const ends: ((finder: Finder) => void)[] = [
    (finder) => expect(finder.key('Enter', null)).toBe(true),
    (finder) => (finder.press([150, 220], 4), finder.close()),
    (finder) => finder.press([11, 11], 4),
  ];
  for (const end of ends) {
    const { finder, seeing } = made();
    finder.choose('polygon');
    for (const corner of corners) finder.press(corner, 4);
    end(finder);
    expect(seeing.choice_of('front')).toEqual({ region: corners });
  }
});

test('what is no region is refused in words, and nothing is lost', () => {
  const { finder, seeing } = made();
  seeing.set('front', { region: [[1, 1], [100, 100]] });
  finder.choose('polygon');
  finder.press([10, 10], 4);
  finder.press([20, 90], 4);
  finder.close();
  expect(finder.said.value).toBe('A polygon needs at least three corners.');
  finder.key('Backspace', null);
  finder.key('Escape', null);
  expect(finder.key('Escape', null)).toBe(false);
  finder.choose('rectangle');
  finder.press([10, 10], 2);
  finder.release([13, 300], 2);
  expect(finder.said.value).toContain('at least 8 rows and columns');
  expect(seeing.choice_of('front')).toEqual({ region: [[1, 1], [100, 100]] });
});

test('a region has a largest number of corners', () => {
  const tool = new RegionTool('polygon');
  for (let i = 0; i <= most_corners; ++i) tool.press([10 * i, (i * i) % 97], 2);
  expect(tool.corners).toHaveLength(most_corners);
  expect(tool.problem).toContain(`at most ${most_corners} corners`);
  expect(tool.close()).toHaveLength(most_corners);
});

test('a colour is asked of the program, and refusals are said', async () => {
  const { finder, seeing, asked } = made();
  finder.choose('color');
  finder.press([12.2, 700], 4);
  await Promise.resolve().then(() => {}).then(() => {});
  expect(asked).toEqual([['color', { camera: 'front', u: 12, v: 479 }]]);
  expect(seeing.choice_of('front')).toEqual({ color: [200, 30, 40] });
  const refused = made(front, () => Promise.reject(new Error('no picture was sent yet')));
  refused.finder.choose('color');
  refused.finder.press([1, 1], 4);
  await Promise.resolve().then(() => {}).then(() => {});
  expect(refused.finder.said.value).toBe('no picture was sent yet');
});

test('a gray picture has no colour: the page says what helps instead', () => {
  const { finder, seeing } = made({ ...front, channels: 1 });
  finder.choose('color');
  expect(finder.tool.value).toBeNull();
  expect(finder.said.value).toBe(no_color);
  finder.choose('base');
  finder.press([320, 470], 4);
  expect(seeing.choice_of('front')).toEqual({ base: [320, 470] });
});

test('the experiment’s settings are used until something else is chosen', () => {
  const seeing = new Seeing();
  const camera: SceneCamera = { ...front, seeing: { region: [[0, 0], [50, 50]], color: [1, 2, 3] } };
  seeing.take([camera], 'one');
  expect(seeing.choice_of('front')).toEqual({ region: [[0, 0], [50, 50]], color: [1, 2, 3] });
  expect(seeing.sent_of('front')).toBeUndefined();
  seeing.set('front', { color: undefined });
  expect(seeing.sent_of('front')).toEqual({ region: [[0, 0], [50, 50]] });
  seeing.clear('front');
  expect(seeing.sent_of('front')).toEqual({});
  seeing.take([camera], 'one');
  expect(seeing.sent_of('front')).toEqual({});
  seeing.restore('front');
  expect(seeing.is_changed('front')).toBe(false);
  seeing.clear('front');
  seeing.take([{ ...camera, width: 320 }], 'one');
  expect(seeing.is_changed('front')).toBe(false);
});

test('settings are taken away as options and as lines of a file', () => {
  const choice = { region: [[10, 20], [300, 400]] as Corner[], color: [200, 30, 40] as [number, number, number], base: [5, 6] as Corner };
  expect(options_of(choice)).toBe('--region 10,20,300,400 --color 200,30,40 --base 5,6');
  expect(options_of({ base: [5, 6] }, 'empty room.png')).toBe("--background 'empty room.png' --base 5,6");
  expect(options_of({})).toBe('');
  expect(lines_of('a "b"', choice)).toBe('[[seeing]]\ncamera = "a \\"b\\""\nregion = [[10, 20], [300, 400]]\ncolor = [200, 30, 40]');
  expect(lines_of('front', { base: [5, 6] })).toBe('');
  expect(outline_of([[1, 2], [3, 4]])).toEqual([[1, 2], [3, 2], [3, 4], [1, 4]]);
  expect(quoted("it's.png")).toBe("'it'\\''s.png'");
});

test('what was found is one line', () => {
  const result = { found: true, reason: '', notes: [], number: 1, layers: [{ id: 'axis', kind: 'polyline', points: [[0, 0], [3, 4], [3, 14]] }] };
  expect(found_text(result)).toBe('Found: an axis of 15 px, from (0, 0) to (3, 14).');
  expect(found_text({ ...result, found: false, reason: 'the picture is blank' })).toBe('Not found: the picture is blank');
  expect(found_text(null)).toBe('Searching …');
});
