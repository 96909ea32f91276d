import { signal } from '@preact/signals';
import { beforeEach, expect, test, vi } from 'vitest';
import { bindings_of, is_in_sight } from '../../src/keys/bindings';
import { help_of, KeyMap, label_of, names_of, type Binding } from '../../src/keys/keys';
import type { App } from '../../src/ui/app';

class FakeElement {
  isContentEditable = false;
  type = '';
  constructor(public tagName: string, private readonly role = '') {}
  closest(): null {
    return null;
  }
  getAttribute(name: string): string | null {
    return name === 'role' && this.role ? this.role : null;
  }
}

class FakeInput extends FakeElement {
  constructor(type: string) {
    super('INPUT');
    this.type = type;
  }
}

beforeEach(() => {
  vi.stubGlobal('HTMLElement', FakeElement);
  vi.stubGlobal('HTMLInputElement', FakeInput);
});

function press(map: KeyMap, key: string, code: string, target: FakeElement | null = null, more = {}): boolean {
  let prevented = false;
  map.handle({
    key, code, target, shiftKey: false, altKey: false, ctrlKey: false, metaKey: false, defaultPrevented: false,
    preventDefault: () => (prevented = true), ...more,
  } as unknown as KeyboardEvent);
  return prevented;
}

function binding(keys: string[], run: () => void): Binding {
  return { keys, what: 'it', group: 'Test', run };
}

test('a key runs what it is bound to, by place or by what it writes', () => {
  const ran: string[] = [];
  const map = new KeyMap({ enabled: () => true });
  map.add(binding(['Space'], () => ran.push('space')), binding(['+'], () => ran.push('plus')), binding(['t'], () => ran.push('t')));
  expect(press(map, ' ', 'Space')).toBe(true);
  press(map, '+', 'BracketRight');
  press(map, '+', 'Equal', null, { shiftKey: true });
  press(map, 'T', 'KeyT', null, { shiftKey: true });
  expect(ran).toEqual(['space', 'plus', 'plus', 't']);
  expect(press(map, 'x', 'KeyX')).toBe(false);
});

test('the browser’s own keys stay the browser’s', () => {
  expect(names_of({ key: 'r', code: 'KeyR', ctrlKey: true, shiftKey: false, altKey: false, metaKey: false })).toEqual([]);
  expect(names_of({ key: 'ArrowLeft', code: 'ArrowLeft', ctrlKey: false, shiftKey: false, altKey: true, metaKey: false })).toContain('Alt+ArrowLeft');
});

test('a focused field and a focused button keep their keys', () => {
  let ran = 0;
  const map = new KeyMap({ enabled: () => true });
  map.add(binding(['Space'], () => ++ran), binding(['ArrowRight'], () => ++ran), binding(['Escape'], () => ++ran));
  press(map, ' ', 'Space', new FakeElement('BUTTON'));
  press(map, 'ArrowRight', 'ArrowRight', new FakeElement('INPUT'));
  press(map, 'ArrowRight', 'ArrowRight', new FakeElement('BUTTON', 'tab'));
  expect(ran).toBe(0);
  press(map, 'ArrowRight', 'ArrowRight', new FakeElement('BUTTON'));
  press(map, 'Escape', 'Escape', new FakeElement('INPUT'));
  expect(ran).toBe(2);
});

test('a slider keeps what slides it, and nothing else', () => {
  const ran: string[] = [];
  const map = new KeyMap({ enabled: () => true });
  for (const key of ['Space', 'h', 'ArrowRight', 'Home', 'PageUp', 'Alt+ArrowLeft']) map.add(binding([key], () => ran.push(key)));
  const slider = new FakeInput('range');
  for (const key of ['ArrowRight', 'Home', 'PageUp']) press(map, key, key, slider);
  expect(ran).toEqual([]);
  press(map, ' ', 'Space', slider);
  press(map, 'h', 'KeyH', slider);
  press(map, 'ArrowLeft', 'ArrowLeft', slider, { altKey: true });
  expect(ran).toEqual(['Space', 'h', 'Alt+ArrowLeft']);
  press(map, 'h', 'KeyH', new FakeInput('text'));
  expect(ran).toHaveLength(3);
});

test('on the teaching page only the page’s own keys do anything', () => {
  const on = (group: string, route: 'viewer' | 'teach'): boolean => is_in_sight({ ...binding(['x'], () => {}), group }, route);
  for (const group of ['Time', 'View', 'Rig']) expect([on(group, 'viewer'), on(group, 'teach')]).toEqual([true, false]);
  expect(on('Page', 'teach')).toBe(true);
});

test('all keys can be switched off', () => {
  const on = signal(false);
  let ran = 0;
  const map = new KeyMap({ enabled: () => on.value });
  map.add(binding(['F1'], () => ++ran));
  expect(press(map, 'F1', 'F1')).toBe(false);
  on.value = true;
  press(map, 'F1', 'F1');
  expect(ran).toBe(1);
});

test('no key is bound twice', () => {
  const map = new KeyMap({ enabled: () => true });
  map.add(binding(['h'], () => {}));
  expect(() => map.add(binding(['h'], () => {}))).toThrow(/twice/);
});

const all = (): Binding[] => bindings_of({ viewer: { playback: {} } } as unknown as App);

test('every key that is bound is in the help, each under a name of its own', () => {
  const bindings = all();
  const listed = help_of(bindings).flatMap(({ rows }) => rows.flatMap(({ keys, what }) => keys.map((key) => `${key}: ${what}`)));
  const bound = bindings.flatMap(({ keys, what }) => keys.map((key) => `${label_of(key)}: ${what}`));
  expect(bound.length).toBeGreaterThan(40);
  expect([...listed].sort()).toEqual([...bound].sort());
  expect(new Set(bindings.flatMap(({ keys }) => keys.map(label_of))).size).toBe(bound.length);
});

test('the help writes keys as they are called', () => {
  expect(['+', '=', '-', 'a', 'Numpad4', 'NumpadAdd', 'Alt+Shift+ArrowLeft', 'PageUp', 'F1', ']', 'BracketRight'].map(label_of)).toEqual(
    ['+', '=', '−', 'A', 'Numpad 4', 'Numpad +', 'Alt Shift ←', 'Page Up', 'F1', ']', '2nd right of P']);
});
