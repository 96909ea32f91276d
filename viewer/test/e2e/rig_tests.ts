// What one does with a live rig that has an arm with tendons and two cameras: the fake one, or the program's.
import { expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import { opened_before, type Served } from './opened';
import { frustum_tests } from './rig_frustum_tests';
import { drag_tests, focus_tests, pick_tests, point_tests, slider_tests, steer_tests } from './rig_move_tests';
import { page_tests } from './rig_page_tests';
import { picture_tests, plot_tests, time_tests } from './rig_picture_tests';
import { eye_tests, orbit_tests, view_tests } from './rig_view_tests';

export interface Whose {
  /** What the page does whoever serves it: its keys, its views, its room. */
  page: boolean;
  /** What is the server’s doing, too: where the arm goes, what is in the pictures. */
  server: boolean;
}

/** The tests of a live rig, one after the other in one page; `faked` gives that one, to be looked into. */
export function rig_tests(start: () => Promise<Served>, whose: Whose, faked?: () => FakeServer | null): void {
  const fake = faked ?? (() => null);
  const opened = opened_before(start, 'live');

  test('the token leaves the address', () => {
    expect(opened.page.url()).not.toContain('token');
  });

  orbit_tests(opened);
  if (whose.page) view_tests(opened);
  slider_tests(opened, fake);
  if (whose.page) focus_tests(opened);
  if (whose.server) steer_tests(opened);
  drag_tests(opened, fake);
  if (whose.page) pick_tests(opened);
  if (whose.server) {
    point_tests(opened);
    picture_tests(opened);
  }
  // Of the program's pictures, which are drawn.
  if (!faked) frustum_tests(opened);
  if (whose.page) plot_tests(opened, fake);
  eye_tests(opened, fake, whose);
  if (whose.page) {
    time_tests(opened);
    page_tests(opened);
  }

  test('the browser had nothing to complain of, the security policy neither', () => {
    expect(opened.complaints).toEqual([]);
  });

  test('what is not the page’s own does not run, and nothing is asked of others', async () => {
    const { ran, stopped } = await opened.page.evaluate(async () => {
      const violated: string[] = [];
      addEventListener('securitypolicyviolation', ({ effectiveDirective }) => violated.push(effectiveDirective));
      document.body.dataset['ran'] = 'nothing';
      const script = document.createElement('script');
      script.textContent = 'document.body.dataset.ran = "a script"';
      const button = document.createElement('button');
      button.setAttribute('onclick', 'document.body.dataset.ran = "a handler"');
      button.setAttribute('style', 'color: red');
      const elsewhere = 'http://127.0.0.1:9/';
      const frame = document.createElement('iframe');
      frame.src = elsewhere;
      document.body.append(script, button, frame);
      button.click();
      const image = new Image();
      image.src = `${elsewhere}picture.png`;
      await fetch(elsewhere).catch(() => null);
      await new Promise((done) => setTimeout(done, 200));
      for (const strange of [script, button, frame]) strange.remove();
      return { ran: document.body.dataset['ran'], stopped: violated };
    });
    expect(ran).toBe('nothing');
    expect([...new Set(stopped)].sort()).toEqual(
      ['connect-src', 'frame-src', 'img-src', 'script-src-attr', 'script-src-elem', 'style-src-attr']);
  });
}
