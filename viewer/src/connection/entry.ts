// Being let in: the token buys a cookie, and a cookie from before may still do.

export interface Entry {
  /** Where the program serves, with a slash at its end. */
  base: string;
  token(): string | null;
  /** The token is wrong, though the cookie lets in. */
  forget?(): void;
}

export type EntryOutcome = { kind: 'in' } | { kind: 'unreachable' } | { kind: 'refused'; why: string };

export async function enter(entry: Entry): Promise<EntryOutcome> {
  const token = entry.token();
  try {
    let status = token === null ? await try_cookie(entry.base) : await buy_cookie(entry.base, token);
    if (status === 401 && token !== null) {
      // An address that is wrong, or another's, ends no session that is good without it.
      status = await try_cookie(entry.base);
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

async function buy_cookie(base: string, token: string): Promise<number> {
  // What no token is made of need not be sent, and in a header could not.
  if (!/^[0-9a-fA-F]+$/.test(token)) return 401;
  const answer = await fetch(new URL('session', base), {
    method: 'POST',
    headers: { Authorization: `Bearer ${token}` },
    credentials: 'same-origin',
  });
  return answer.status;
}

async function try_cookie(base: string): Promise<number> {
  const answer = await fetch(new URL('series', base), { credentials: 'same-origin', cache: 'no-store' });
  return answer.status;
}

function refusal(had_token: boolean): string {
  return had_token
    ? 'The program does not know this page’s token: it was started again, or the address is an old one.'
    : 'This page came without a token.';
}
