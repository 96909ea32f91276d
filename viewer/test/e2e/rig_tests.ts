// What one does with a live rig that has an arm with tendons and two cameras: the fake one, or the program's.
import { expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import { opened_before, type Served } from './opened';
import { move_tests, pick_tests } from './rig_move_tests';
import { page_tests } from './rig_page_tests';
import { picture_tests, time_tests } from './rig_picture_tests';
import { eye_tests, view_tests } from './rig_view_tests';

/** The tests of a live rig, one after the other in one page; `fake`, where it is that one, can be looked into. */
export function rig_tests(start: () => Promise<Served>, fake: () => FakeServer | null = () => null): void {
  const opened = opened_before(start, 'live', {});

  test('the token leaves the address', () => {
    expect(opened.page.url()).not.toContain('token');
  });

  view_tests(opened);
  move_tests(opened, fake);
  pick_tests(opened);
  picture_tests(opened, fake);
  eye_tests(opened, fake);
  time_tests(opened);
  page_tests(opened);

  test('the browser had nothing to complain of, the security policy neither', () => {
    expect(opened.complaints).toEqual([]);
  });
}
