// The token comes behind the address's #, which never leaves the browser; it is taken out of the address bar at once.
// The program answers one that lets in with a cookie, which no script reads and which ends with the browser: so reloading works, and another tab comes in too.

/** Tokens are 128 bits in hexadecimal digits. */
export function is_token(text: string): boolean {
  return /^[0-9a-fA-F]{32}$/.test(text);
}

/** Takes `#token=...` out of the address, also what is no token; null when there is nothing of that. */
export function take_token(location: Location, history: History): string | null {
  const token = /^#token=(.*)$/.exec(location.hash)?.[1];
  if (token === undefined) return null;
  history.replaceState(null, '', location.pathname + location.search);
  return token;
}

/** The token in what someone pasted: the whole address or the digits alone. Null when there is none. */
export function pasted_token(text: string): string | null {
  return /(?:^|token=)([0-9a-fA-F]{32})$/.exec(text.trim())?.[1] ?? null;
}
