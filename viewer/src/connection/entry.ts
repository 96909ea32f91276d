// Being let in: the token buys a cookie, and a cookie from before may still do.
import { is_token } from './address';

export interface Entry {
  /** Where the program serves, with a slash at its end. */
  base: string;
  token(): string | null;
  /** The token is wrong, though the cookie lets in. */
  forget?(): void;
}

export type EntryOutcome = { kind: 'in' } | { kind: 'unreachable' } | { kind: 'refused'; why: string };

/** Each question waits so long for its answer, ms: a network that goes away without a word answers none. */
export async function enter(entry: Entry, answer_ms: number): Promise<EntryOutcome> {
  const token = entry.token();
  const ask = (path: string, options: RequestInit): Promise<Response> =>
    fetch(new URL(path, entry.base), { credentials: 'same-origin', ...options, signal: AbortSignal.timeout(answer_ms) });
  try {
    let status = token === null ? await try_cookie(ask) : await buy_cookie(ask, token);
    if (status === 401 && token !== null) {
      // An address that is wrong, or another's, ends no session that is good without it.
      status = await try_cookie(ask);
      if (status !== 401) entry.forget?.();
    }
    if (status === 401) return { kind: 'refused', why: refusal(token !== null) };
    if (status === 403 || status === 421) {
      return { kind: 'refused', why: 'The program refuses pages under this address; use the one that it printed.' };
    }
    // 503: full; whatever else it says, it is there, and the socket will tell.
    return { kind: 'in' };
  } catch {
    return { kind: 'unreachable' };
  }
}

type Ask = (path: string, options: RequestInit) => Promise<Response>;

async function buy_cookie(ask: Ask, token: string): Promise<number> {
  // What is no token need not be sent, and in a header could not.
  if (!is_token(token)) return 401;
  return (await ask('session', { method: 'POST', headers: { Authorization: `Bearer ${token}` } })).status;
}

async function try_cookie(ask: Ask): Promise<number> {
  return (await ask('series', { cache: 'no-store' })).status;
}

function refusal(had_token: boolean): string {
  return had_token
    ? 'The program does not know this page’s token: it was started again, or the address is an old one.'
    : 'This page came without a token.';
}
