import { expect, test, vi } from 'vitest';
import { is_token, pasted_token, take_token } from '../../src/connection/address';
import { Backoff } from '../../src/connection/backoff';
import { enter } from '../../src/connection/entry';
import { Latest } from '../../src/connection/latest';

test('a token leaves the address bar, also what is none', () => {
  const replaced: string[] = [];
  const history = { replaceState: (_: unknown, __: string, to: string) => replaced.push(to) } as unknown as History;
  const take = (hash: string): string | null => take_token({ hash, pathname: '/', search: '' } as Location, history);
  expect(take('#/teach')).toBe(null);
  expect(replaced).toEqual([]);
  expect(take('#token=00ff00ff')).toBe('00ff00ff');
  expect(take('#token=')).toBe('');
  expect(replaced).toEqual(['/', '/']);
});

test('a pasted address or token is taken, other text is not', () => {
  const token = 'ab'.repeat(16);
  expect(pasted_token(' http://127.0.0.1:8421/#token=' + token + '\n')).toBe(token);
  expect(pasted_token(token)).toBe(token);
  for (const other of ['http://127.0.0.1:8421/', '', token + 'a']) expect(pasted_token(other)).toBe(null);
  expect(is_token(token)).toBe(true);
  for (const other of ['', token.slice(1), token + 'a', 'a'.repeat(100000), 'g'.repeat(32)]) expect(is_token(other)).toBe(false);
});

test('a token is tried once, beside the cookie, and then forgotten', async () => {
  const good = 'ab'.repeat(16);
  const wrong = 'cd'.repeat(16);
  let cookie: string | null = null;
  let token: string | null = null;
  const asked: (string | undefined)[] = [];
  vi.stubGlobal('fetch', (_: URL, { credentials, headers }: RequestInit) => {
    const header = (headers as Record<string, string>)['Authorization'];
    asked.push(header);
    expect(credentials).toBe('same-origin');
    const is_shown = header === `Bearer ${good}`;
    if (is_shown) cookie = good;  // The program would set its cookie.
    return Promise.resolve({ status: is_shown || cookie === good ? 404 : 401 });
  });
  const come_with = async (tried: string | null): Promise<string> => {
    token = tried;
    const settle = (settled: string): void => void (settled === token && (token = null));
    const { kind } = await enter({ base: 'http://127.0.0.1:1/', token: () => token, settle }, 1000);
    expect(token).toBe(null);
    return kind;
  };
  try {
    expect(await come_with(null)).toBe('refused');
    expect(await come_with(wrong)).toBe('refused');
    expect(await come_with('zz')).toBe('refused');
    expect(asked).toEqual([undefined, `Bearer ${wrong}`, undefined]);
    expect(await come_with(good)).toBe('in');
    expect(await come_with(null)).toBe('in');
    for (const bad of [wrong, 'zz', '']) expect(await come_with(bad)).toBe('in');
  } finally {
    vi.unstubAllGlobals();
  }
});

test('attempts come less and less often, up to a limit, and soon again after success', () => {
  const backoff = new Backoff(250, 5000, () => 0.5);
  expect([1, 2, 3, 4, 5, 6, 7].map(() => backoff.next())).toEqual([250, 500, 1000, 2000, 4000, 5000, 5000]);
  backoff.reset();
  expect(backoff.next()).toBe(250);
});

test('of what is asked while one is outstanding, only the newest is sent', async () => {
  const sent: number[] = [];
  const release: (() => void)[] = [];
  const latest = new Latest<number>((value) => {
    sent.push(value);
    return new Promise<void>((resolve) => release.push(resolve));
  });
  [1, 2, 3, 4].forEach((value) => latest.ask(value));
  expect(sent).toEqual([1]);
  release[0]();
  await new Promise((resolve) => setTimeout(resolve));
  expect(sent).toEqual([1, 4]);
  release[1]();
  await new Promise((resolve) => setTimeout(resolve));
  latest.ask(5);
  expect(sent).toEqual([1, 4, 5]);
});

test('a refusal is told and does not stop what waits', async () => {
  const told: string[] = [];
  const latest = new Latest<number>(
    (value) => (value === 1 ? Promise.reject(new Error('no')) : Promise.resolve(value)),
    (result, error) => told.push(error ? error.message : String(result)),
  );
  latest.ask(1);
  latest.ask(2);
  await new Promise((resolve) => setTimeout(resolve, 5));
  expect(told).toEqual(['no', '2']);
});
