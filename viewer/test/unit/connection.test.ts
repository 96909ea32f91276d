import { expect, test } from 'vitest';
import { forget_token, is_token, keep_pasted, kept_token, storage_of_tab, take_token } from '../../src/connection/address';
import { Backoff } from '../../src/connection/backoff';
import { Latest } from '../../src/connection/latest';

function storage(): Storage {
  const kept = new Map<string, string>();
  return { getItem: (k: string) => kept.get(k) ?? null, setItem: (k: string, v: string) => void kept.set(k, v), removeItem: (k: string) => void kept.delete(k) } as unknown as Storage;
}

test('the token leaves the address bar and stays with the tab', () => {
  const kept = storage();
  const replaced: string[] = [];
  const history = { replaceState: (_: unknown, __: string, to: string) => replaced.push(to) } as unknown as History;
  const at = (hash: string): Location => ({ hash, pathname: '/', search: '' }) as Location;
  expect(take_token(at('#/teach'), history, kept)).toBe(false);
  expect(take_token(at('#token=00ff00ff'), history, kept)).toBe(true);
  expect(kept_token(kept)).toBe('00ff00ff');
  expect(replaced).toEqual(['/']);
});

test('a token that lets nobody in leaves the address bar too, and the one before counts again', () => {
  const kept = storage();
  const replaced: string[] = [];
  const history = { replaceState: (_: unknown, __: string, to: string) => replaced.push(to) } as unknown as History;
  const take = (hash: string): boolean => take_token({ hash, pathname: '/', search: '' } as Location, history, kept);
  expect(take('#token=zz')).toBe(true);
  expect(take('#token=')).toBe(true);
  expect(replaced).toEqual(['/', '/']);
  expect(kept_token(kept)).toBe('');
  forget_token(kept);
  forget_token(kept);
  expect(kept_token(kept)).toBe(null);
  take('#token=00ff');
  take('#token=zz');
  forget_token(kept);
  expect(kept_token(kept)).toBe('00ff');
});

test('a pasted address or token is taken, other text is not', () => {
  const kept = storage();
  const token = 'ab'.repeat(16);
  expect(keep_pasted(' http://127.0.0.1:8421/#token=' + token + '\n', kept)).toBe(true);
  expect(kept_token(kept)).toBe(token);
  expect(keep_pasted(token, kept)).toBe(true);
  expect(keep_pasted('http://127.0.0.1:8421/', kept)).toBe(false);
  expect(keep_pasted('', kept)).toBe(false);
  expect(keep_pasted(token + 'a', kept)).toBe(false);
  expect(is_token(token)).toBe(true);
  for (const other of ['', token.slice(1), token + 'a', 'a'.repeat(100000), 'g'.repeat(32)]) expect(is_token(other)).toBe(false);
});

test('without the tab’s storage the page remembers for itself', () => {
  const kept = storage_of_tab(() => {
    throw new DOMException('switched off', 'SecurityError');
  });
  const token = 'cd'.repeat(16);
  expect(keep_pasted(token, kept)).toBe(true);
  expect(kept_token(kept)).toBe(token);
  forget_token(kept);
  expect(kept_token(kept)).toBe(null);
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
