// Being let in: with a token that is new to the page, or the cookie that it has from before.
import { is_token } from './address';

export interface Entry {
  /** Where the program serves, with a slash at its end. */
  base: string;
  /** What the address brought or someone pasted, until it was tried. */
  token(): string | null;
  /** It was tried: the program has answered it with its cookie, or it lets nobody in. */
  settle(token: string): void;
}

export type EntryOutcome = { kind: 'in' } | { kind: 'unreachable' } | { kind: 'refused'; why: string };

/** The program has so long to answer, ms: a network that goes away without a word never does. */
export async function enter(entry: Entry, answer_ms: number): Promise<EntryOutcome> {
  const token = entry.token();
  try {
    const { status } = await fetch(new URL('series', entry.base), {
      cache: 'no-store',
      // An address that is wrong, or another's, ends no session that the cookie still lets in.
      credentials: 'same-origin',
      // What is no token need not be sent, and in a header could not.
      headers: token !== null && is_token(token) ? { Authorization: `Bearer ${token}` } : {},
      signal: AbortSignal.timeout(answer_ms),
    });
    if (token !== null) entry.settle(token);
    if (status === 401) {
      return { kind: 'refused', why: 'This page has no token that the program knows: it was started again, or the address is not the whole one.' };
    }
    if (status === 403 || status === 421) {
      return { kind: 'refused', why: 'The program refuses pages under this address; use the one that it printed.' };
    }
    // 503: full; whatever else it says, it is there, and the socket will show.
    return { kind: 'in' };
  } catch {
    return { kind: 'unreachable' };
  }
}
