import { expect, test } from 'vitest';
import { PairedPictures } from '../../src/panels/paired';

const picture = (number: number, image = `picture ${number}`) => ({ image, number, time: number / 10 });
const made = () => new PairedPictures<string>((image) => `copy of ${image}`);

test('the newest picture is shown while nothing is measured', () => {
  const paired = made();
  expect(paired.choose(null, null, false)).toBeNull();
  for (const i of [1, 2]) expect(paired.choose(picture(i), null, false)).toEqual(picture(i));
  expect(paired.choose(picture(3), 2, true)).toEqual(picture(3));
});

test('what was measured goes with its own picture until the next is measured', () => {
  const paired = made();
  expect(paired.choose(picture(1), null, true)!.number).toBe(1);
  expect(paired.choose(picture(1), 1, true)!.number).toBe(1);
  expect(paired.choose(picture(2), 1, true)).toMatchObject({ image: 'copy of picture 1', time: 0.1 });
  expect(paired.choose(picture(3), 1, true)!.number).toBe(1);
  expect(paired.choose(picture(3), 2, true)!.number).toBe(2);
  expect(paired.choose(picture(3), null, true)!.number).toBe(3);
  expect(paired.choose(picture(3), 1, false)!.number).toBe(3);
});

test('a result that comes before its picture waits for it', () => {
  const paired = made();
  expect(paired.choose(picture(1), 2, true)!.number).toBe(1);
  expect(paired.choose(picture(2), 2, true)!.number).toBe(2);
});

test('long ago measured pictures are forgotten, and a picture that comes again is the new one', () => {
  const paired = made();
  for (let i = 1; i <= 20; ++i) paired.choose(picture(i), null, true);
  expect(paired.choose(picture(20), 1, true)!.number).toBe(20);
  paired.choose(picture(12, 'again'), null, true);
  expect(paired.choose(picture(20), 12, true)!.image).toBe('copy of again');
});
