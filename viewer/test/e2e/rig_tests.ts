// Tests of a live rig with a tendon-driven arm and two cameras, from the fake server or the program.
import { expect, test } from 'vitest';
import type { FakeServer } from '../fake/server';
import { opened_before, type Served } from './opened';
import { frustum_tests } from './rig_frustum_tests';
import { drag_tests, focus_tests, pick_tests, point_tests, slider_tests, steer_tests } from './rig_move_tests';
import { page_tests } from './rig_page_tests';
import { picture_tests, plot_tests, time_tests } from './rig_picture_tests';
import { eye_tests, orbit_tests, view_tests } from './rig_view_tests';

export interface Whose {
  /** Run tests of the page itself: keys, views, layout. */
  page: boolean;
  /** Run tests that involve the server: arm motion, picture content. */
  server: boolean;
}

/** Tests of a live rig in sequence in one page; `faked` returns the fake server for inspection. */
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
  // These tests need rendered pictures of the program.
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
