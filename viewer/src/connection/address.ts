// The token comes behind the address's #, which never leaves the browser; it is taken out of the address bar at once
// and kept for this tab only, so that reloading works.
const key = 'flexura.token';

/** Takes `#token=...` out of the address; true when there was one. */
export function take_token(location: Location, history: History, storage: Storage): boolean {
  const token = /^#token=([0-9a-fA-F]+)$/.exec(location.hash)?.[1];
  if (!token) return false;
  storage.setItem(key, token);
  history.replaceState(null, '', location.pathname + location.search);
  return true;
}

export function kept_token(storage: Storage): string | null {
  return storage.getItem(key);
}

/** Keeps the token in what someone pasted: the whole address or the digits alone. False when there is none. */
export function keep_pasted(text: string, storage: Storage): boolean {
  const token = /(?:^|token=)([0-9a-fA-F]{32,})$/.exec(text.trim())?.[1];
  if (!token) return false;
  storage.setItem(key, token);
  return true;
}
