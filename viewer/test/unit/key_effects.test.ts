// Effects of all keys, with a free view and a simulated clock.
import { signal } from '@preact/signals';
import { PerspectiveCamera, Vector3 } from 'three';
import { beforeEach, expect, test, vi } from 'vitest';
import { bindings_of } from '../../src/keys/bindings';
import { Orbit } from '../../src/scene/orbit';
import { preferences } from '../../src/state/preferences';
import type { App } from '../../src/ui/app';

let orbit: Orbit;
let camera: PerspectiveCamera;
let done: string[];
let mode: 'live' | 'recording';
let is_elastic: boolean;
const push_tool = signal(false);
const enlarged = signal<string | null>(null);
const finding = signal<string | null>(null);

/** Returns an object that records all calls with their arguments. */
function noted(name: string, has: Record<string, unknown> = {}): object {
  return new Proxy(has, {
    get: (known, what: string) => (what in known ? known[what] : (...values: unknown[]) => void done.push(`${name} ${[what, ...values].join(' ')}`)),
  });
}

beforeEach(() => {
  orbit = new Orbit();
  camera = new PerspectiveCamera(40, 1.5, 0.01, 100);
  place();
  done = [];
  mode = 'live';
  is_elastic = false;
  push_tool.value = false;
});

function place(): void {
  orbit.place(camera);
  camera.updateMatrix();
}

function press(key: string): void {
  const app = {
    viewer: {
      playback: noted('time', { mode: signal(mode) }), commander: noted('rig'), picked: signal(0.25), readonly: false, blind: false, finding,
      hello: signal({ controls: is_elastic ? { push: {} } : {} }),
    },
    views: noted('views', { current: signal(null) }),
    view: signal(noted('view', { orbit, camera, state: { samples: new Float32Array(7) } })),
    dialog: signal(null),
    enlarged,
    route: signal('viewer'),
    push_tool,
  } as unknown as App;
  const bound = bindings_of(app).filter(({ keys }) => keys.includes(key));
  expect(bound, key).toHaveLength(1);
  bound[0].run({} as KeyboardEvent);
}

/** Returns the motion of the view's camera in its previous axes: right, up, back. */
function moved_by(key: string): Vector3 {
  const axes = [0, 1, 2].map((column) => new Vector3().setFromMatrixColumn(camera.matrix, column));
  const before = camera.position.clone();
  press(key);
  place();
  const way = camera.position.clone().sub(before);
  return new Vector3(axes[0].dot(way), axes[1].dot(way), axes[2].dot(way));
}

test('keys look at the arm from the front, from the side and from above', () => {
  for (const [keys, toward] of [[['1', 'Numpad1'], [0, 0, 1]], [['3', 'Numpad3'], [-1, 0, 0]], [['7', 'Numpad7'], [0, 1, 0]]] as const) {
    for (const key of keys) {
      press(key);
      place();
      expect(camera.position.clone().sub(orbit.target).normalize().distanceTo(new Vector3(...toward)), key).toBeLessThan(1e-3);
    }
  }
  expect(done).toContain('views free');
});

test('keys turn, rise and sink around what is looked at, and come nearer to it', () => {
  const target = orbit.target.clone();
  const distance = orbit.distance;
  expect(moved_by('Alt+ArrowLeft').x).toBeLessThan(-0.05);
  expect(moved_by('Numpad6').x).toBeGreaterThan(0.05);
  expect(moved_by('Alt+ArrowUp').y).toBeGreaterThan(0.05);
  expect(moved_by('Numpad2').y).toBeLessThan(-0.05);
  expect(orbit.distance).toBe(distance);
  expect(moved_by('PageUp').z).toBeLessThan(-0.05);
  expect(moved_by('PageDown').z).toBeGreaterThan(0.05);
  expect(orbit.target.equals(target)).toBe(true);
});

test('keys move the view in its own plane', () => {
  for (const [key, x, y] of [['Left', -1, 0], ['Right', 1, 0], ['Up', 0, 1], ['Down', 0, -1]] as const) {
    const way = moved_by(`Alt+Shift+Arrow${key}`);
    expect(way.length(), key).toBeGreaterThan(0.01);
    expect(way.normalize().distanceTo(new Vector3(x, y, 0)), key).toBeLessThan(1e-6);
  }
});

test.each([
  [['0', 'a', 'Numpad0'], 'view frame_arm'],
  [['5', 'Numpad5', 'Shift+Home'], 'view frame_cameras'],
  [['.', 'NumpadDecimal'], 'view look_at_arm 0.25'],
  [[']', 'BracketRight'], 'views cycle 1'],
  [['[', 'BracketLeft'], 'views cycle -1'],
  [['Space'], 'time toggle'],
  [['ArrowRight'], 'time step 1'],
  [['ArrowLeft'], 'time step -1'],
  [['Shift+ArrowRight'], 'time skip 0.5'],
  [['Shift+ArrowLeft'], 'time skip -0.5'],
  [['+', '=', 'NumpadAdd'], 'time faster 1'],
  [['-', 'NumpadSubtract'], 'time faster -1'],
  [['Home'], 'time seek 0'],
  [['End'], 'time go_live'],
  [['Backspace'], 'rig plain reset'],
  [['h'], 'rig plain halt'],
  [['r'], 'rig plain run'],
  [['c'], 'rig plain cancel'],
])('%s: %s', (keys, what) => {
  for (const key of keys) {
    done = [];
    press(key);
    expect(done, key).toContain(what);
  }
});

test('an elastic arm is pushed by dragging, until Escape', () => {
  press('g');
  expect(push_tool.value).toBe(false);
  is_elastic = true;
  press('g');
  expect(push_tool.value).toBe(true);
  press('Escape');
  expect(push_tool.value).toBe(false);
  press('g');
  press('g');
  expect(push_tool.value).toBe(false);
});

test('Escape closes the tools of a picture first, then the picture', () => {
  enlarged.value = finding.value = 'front';
  press('Escape');
  expect([enlarged.value, finding.value]).toEqual(['front', null]);
  press('Escape');
  expect(enlarged.value).toBeNull();
});

test('the end of a recording is its last state', () => {
  mode = 'recording';
  press('End');
  expect(done).toEqual(['time seek Infinity']);
});

test('trail, plots and light are switched, and switched back', () => {
  vi.stubGlobal('localStorage', { getItem: () => null, setItem: () => {} });
  const plots = preferences.show_plots.value;
  for (const is_off of [true, false]) {
    press('t');
    press('p');
    expect(preferences.hidden.value.includes('trail')).toBe(is_off);
    expect(preferences.show_plots.value).toBe(is_off ? !plots : plots);
  }
  press('l');
  const chosen = preferences.theme.value;
  press('l');
  expect([chosen, preferences.theme.value].sort()).toEqual(['dark', 'light']);
});
