// The token comes behind the address's #, which never leaves the browser; it is taken out of the address bar at once
// and kept for this tab only, so that reloading works.
const key = 'flexura.token';
/** The one that this tab had before, which may be the right one. */
const key_before = 'flexura.token.before';

/** What a token is kept in. */
export type TokenStorage = Pick<Storage, 'getItem' | 'setItem' | 'removeItem'>;

/** This tab's storage; where that is switched off, the page's own memory, which ends with the page. */
export function storage_of_tab(tab: () => TokenStorage): TokenStorage {
  try {
    const storage = tab();
    storage.getItem(key);
    return storage;
  } catch {
    const kept = new Map<string, string>();
    return {
      getItem: (name) => kept.get(name) ?? null,
      setItem: (name, value) => void kept.set(name, value),
      removeItem: (name) => void kept.delete(name),
    };
  }
}

/** Tokens are 128 bits in hexadecimal digits. */
export function is_token(text: string): boolean {
  return /^[0-9a-fA-F]{32}$/.test(text);
}

function keep(token: string, storage: TokenStorage): void {
  const before = storage.getItem(key);
  if (before !== null && before !== token) storage.setItem(key_before, before);
  storage.setItem(key, token);
}

/** Takes `#token=...` out of the address; true when there was one. What is no token is one that lets nobody in. */
export function take_token(location: Location, history: History, storage: TokenStorage): boolean {
  const token = /^#token=(.*)$/.exec(location.hash)?.[1];
  if (token === undefined) return false;
  keep(token, storage);
  history.replaceState(null, '', location.pathname + location.search);
  return true;
}

/** Forgets a token that lets nobody in: the one before counts again, if there was any. */
export function forget_token(storage: TokenStorage): void {
  const before = storage.getItem(key_before);
  storage.removeItem(key_before);
  if (before === null) storage.removeItem(key);
  else storage.setItem(key, before);
}

export function kept_token(storage: TokenStorage): string | null {
  return storage.getItem(key);
}

/** Keeps the token in what someone pasted: the whole address or the digits alone. False when there is none. */
export function keep_pasted(text: string, storage: TokenStorage): boolean {
  const token = /(?:^|token=)([0-9a-fA-F]{32})$/.exec(text.trim())?.[1];
  if (!token) return false;
  keep(token, storage);
  return true;
}
