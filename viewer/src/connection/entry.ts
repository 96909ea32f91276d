// Being let in: with a token that is new to the page, or the cookie that it has from before.
import { is_token } from './address';

export interface Entry {
  /** Where the program serves, with a slash at its end. */
  base: string;
  /** What the address brought or someone pasted, until it is settled. */
  token(): string | null;
  /** Whether that lets in, and so belongs into the cookie. */
  settle(token: string, is_good: boolean): void;
}

export type EntryOutcome = { kind: 'in' } | { kind: 'unreachable' } | { kind: 'refused'; why: string };

/** Each question waits so long for its answer, ms: a network that goes away without a word answers none. */
export async function enter(entry: Entry, answer_ms: number): Promise<EntryOutcome> {
  const ask = async (options: RequestInit): Promise<number> =>
    (await fetch(new URL('series', entry.base), { cache: 'no-store', ...options, signal: AbortSignal.timeout(answer_ms) })).status;
  const token = entry.token();
  try {
    let status = 401;
    if (token !== null) {
      // What is no token need not be sent, and in a header could not. The cookie stays out: it may be the better one.
      if (is_token(token)) status = await ask({ credentials: 'omit', headers: { Authorization: `Bearer ${token}` } });
      entry.settle(token, status !== 401);
    }
    // An address that is wrong, or another's, ends no session that is good without it.
    if (status === 401) status = await ask({ credentials: 'same-origin' });
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
