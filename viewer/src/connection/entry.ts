// Authentication with the program: by a new token, or by the cookie of an earlier one.
import { is_token } from './address';

export interface Entry {
  /** Base address of the program, with a trailing slash. */
  base: string;
  /** The token from the address or the clipboard, until it was tried. */
  token(): string | null;
  /** The token was tried: the program has set its cookie, or has refused the token. */
  settle(token: string): void;
}

export type EntryOutcome = { kind: 'in' } | { kind: 'unreachable' } | { kind: 'refused'; why: string };

/** Authenticates. `answer_ms`: timeout of the answer, ms, needed if the network fails silently. */
export async function enter(entry: Entry, answer_ms: number): Promise<EntryOutcome> {
  const token = entry.token();
  try {
    const { status } = await fetch(new URL('series', entry.base), {
      cache: 'no-store',
      // The cookie is sent as well, so a wrong or foreign token does not end a valid session.
      credentials: 'same-origin',
      // An invalid token is not sent; some characters are not allowed in a header.
      headers: token !== null && is_token(token) ? { Authorization: `Bearer ${token}` } : {},
      signal: AbortSignal.timeout(answer_ms),
    });
    if (token !== null) entry.settle(token);
    if (status === 401) {
      return { kind: 'refused', why: 'No valid token: the program was restarted, or the address is incomplete.' };
    }
    if (status === 403 || status === 421) {
      return { kind: 'refused', why: 'This address is not allowed; use the one that the program printed.' };
    }
    // 503: too many clients. With any other status the program is reachable, and the socket will report errors.
    return { kind: 'in' };
  } catch {
    return { kind: 'unreachable' };
  }
}
