// The token is in the address's fragment (after #), which the browser never sends; it is removed from the address bar
// at once. The program exchanges a valid token for a session cookie that scripts cannot read, so reloading works and
// other tabs have access too.

/** Returns whether a text has the form of a token: 128 bits in hexadecimal digits. */
export function is_token(text: string): boolean {
  return /^[0-9a-fA-F]{32}$/.test(text);
}

/**
 * Removes `#token=...` from the address, even if the value is no valid token, and returns it; null if there is none.
 */
export function take_token(location: Location, history: History): string | null {
  const token = /^#token=(.*)$/.exec(location.hash)?.[1];
  if (token === undefined) return null;
  history.replaceState(null, '', location.pathname + location.search);
  return token;
}

/** Extracts the token from a pasted text: a complete address or the digits alone. Null if there is none. */
export function pasted_token(text: string): string | null {
  return /(?:^|token=)([0-9a-fA-F]{32})$/.exec(text.trim())?.[1] ?? null;
}
