// Key bindings and their descriptions for the help. There is one list (bindings.ts), so the help is always complete.

export interface Binding {
  /** `event.code` or `event.key`, with the prefixes "Shift+" and "Alt+". The help lists each of them. */
  keys: string[];
  what: string;
  group: string;
  /** Also from a focused field or dialog, unless one types text there. */
  anywhere?: boolean;
  run(event: KeyboardEvent): void;
}

/** Labels in the help for keys without a printed one, for the numpad, and for keys given by position. */
const labels: Record<string, string> = {
  ArrowLeft: '←', ArrowRight: '→', ArrowUp: '↑', ArrowDown: '↓', PageUp: 'Page Up', PageDown: 'Page Down', Escape: 'Esc', '-': '−',
  NumpadAdd: 'Numpad +', NumpadSubtract: 'Numpad −', NumpadDecimal: 'Numpad .',
  BracketLeft: '1st right of P', BracketRight: '2nd right of P',
};

/** Returns the label of a key in the help. */
export function label_of(key: string): string {
  const parts = key.length > 1 ? key.split(/\+(?=.)/) : [key];
  return parts.map((part) => labels[part] ?? part.replace(/^Numpad(\d)$/, 'Numpad $1').replace(/^[a-z]$/, (letter) => letter.toUpperCase())).join(' ');
}

/** Returns the content of the help: groups with their actions and keys. */
export function help_of(bindings: Binding[]): { group: string; rows: { keys: string[]; what: string }[] }[] {
  return [...new Set(bindings.map(({ group }) => group))].map((group) => ({
    group,
    rows: bindings.filter((binding) => binding.group === group).map(({ keys, what }) => ({ keys: keys.map(label_of), what })),
  }));
}

export interface KeyOptions {
  enabled(binding: Binding): boolean;
}

/** Returns the names under which a pressed key may be bound. */
export function names_of(event: Pick<KeyboardEvent, 'key' | 'code' | 'shiftKey' | 'altKey' | 'ctrlKey' | 'metaKey'>): string[] {
  if (event.ctrlKey || event.metaKey) return [];
  const alt = event.altKey ? 'Alt+' : '';
  const shift = event.shiftKey ? 'Shift+' : '';
  // Characters that need Shift on some keyboards ("+", "?") are matched by the character.
  const plain = event.key.length === 1 ? alt + event.key.toLowerCase() : '';
  return [alt + shift + event.code, alt + shift + event.key, plain].filter(Boolean);
}

export class KeyMap {
  readonly bindings: Binding[] = [];
  private readonly by_name = new Map<string, Binding>();

  constructor(private readonly options: KeyOptions) {}

  add(...bindings: Binding[]): void {
    for (const binding of bindings) {
      for (const key of binding.keys) {
        if (this.by_name.has(key)) throw new Error(`the key ${key} is bound twice`);
        this.by_name.set(key, binding);
      }
      this.bindings.push(binding);
    }
  }

  handle = (event: KeyboardEvent): void => {
    if (event.defaultPrevented) return;
    const binding = names_of(event).map((name) => this.by_name.get(name)).find(Boolean);
    if (!binding || !this.options.enabled(binding)) return;
    if (binding.anywhere ? types_text(event) : taken_by_control(event)) return;
    event.preventDefault();
    binding.run(event);
  };
}

/** Whether the key writes something in the focused field: letters in one for numbers do not. */
export function types_text(event: KeyboardEvent): boolean {
  const { target } = event;
  if (event.key.length > 1 || !(target instanceof HTMLElement)) return false;
  if (target.isContentEditable || target.tagName === 'TEXTAREA') return true;
  return target instanceof HTMLInputElement && target.type === 'text' && target.inputMode !== 'decimal';
}

/** What a slider does itself: all the others are the page's. */
const slid_by = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', 'Home', 'End', 'PageUp', 'PageDown'];
const typed_into = ['INPUT', 'SELECT', 'TEXTAREA'];
const pressed = ['BUTTON', 'A', 'SUMMARY'];

/**
 * Returns whether a focused control handles a key itself. Without this, typing and pressing buttons with Space would
 * fail.
 */
export function taken_by_control(event: KeyboardEvent): boolean {
  const target = event.target;
  if (!(target instanceof HTMLElement) || event.key === 'F1' || event.key === 'Escape') return false;
  if (target.isContentEditable || target.closest('dialog')) return true;
  if (target instanceof HTMLInputElement && target.type === 'checkbox') return event.code === 'Space';
  if (target instanceof HTMLInputElement && target.type === 'range') return !event.altKey && slid_by.includes(event.key);
  if (typed_into.includes(target.tagName)) return true;
  if (target.getAttribute('role') === 'tab') return ['Space', 'Enter', 'ArrowLeft', 'ArrowRight'].includes(event.code);
  return pressed.includes(target.tagName) && ['Space', 'Enter'].includes(event.code);
}
