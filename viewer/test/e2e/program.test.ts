// The page with the real program.
import { type AddressInfo, connect, createServer, type Socket } from 'node:net';
import { fileURLToPath } from 'node:url';
import { afterAll, describe, expect, test } from 'vitest';
import { until } from './browser';
import { started, visit } from './opened';
import { Program, program } from './program';
import { rig_tests } from './rig_tests';

const rig = fileURLToPath(new URL('rig.toml', import.meta.url));

/** A TCP tunnel from its port to another one, like `ssh -L`. */
interface Tunnel {
  port: number;
  to: number;
  close(): Promise<void>;
}

async function open_tunnel(): Promise<Tunnel> {
  const ends = new Set<Socket>();
  const server = createServer((near) => {
    const far = connect(tunnel.to, '127.0.0.1');
    for (const [one, other] of [[near, far], [far, near]]) {
      ends.add(one);
      one.on('error', () => other.destroy()).on('close', () => other.destroy());
      one.pipe(other);
    }
  });
  const tunnel: Tunnel = {
    port: 0,
    to: 0,
    close: () => new Promise((resolve) => {
      server.close(() => resolve());
      for (const end of ends) end.destroy();
    }),
  };
  await new Promise<void>((resolve) => server.listen(0, '127.0.0.1', resolve));
  tunnel.port = (server.address() as AddressInfo).port;
  return tunnel;
}

describe.skipIf(!program)('the program', () => {
  describe('with its rig', () => {
    rig_tests(() => started(rig), { page: false, server: true });
  });

  describe('behind a tunnel', () => {
    let [tunnel, served]: [Tunnel?, Program?] = [];

    afterAll(async () => {
      await tunnel?.close();
      await served?.stop();
    });

    // As docs/command-line.md describes `ssh -L` with a different local port.
    test('the page works under another port, once that is named', async () => {
      tunnel = await open_tunnel();
      served = new Program(['view', rig, '--name', `127.0.0.1:${tunnel.port}`]);
      await served.start();
      tunnel.to = served.port;
      const { page, complaints } = await visit(served.url.replace(`:${served.port}`, `:${tunnel.port}`));
      await page.waitForSelector('.badge[data-kind="live"]');
      await until(async () => (await page.locator('.picture .none').count()) === 0, 15000, 'no picture came');
      expect(new URL(page.url()).port).toBe(String(tunnel.port));
      expect(complaints).toEqual([]);
    });
  });

  describe('started again', () => {
    const served = new Program(rig);

    afterAll(() => served.stop());

    test('the page says that it needs the new address, and starts afresh with it', async () => {
      await served.start();
      const { page, complaints } = await visit(served.url);
      const badge = () => page.locator('.badge').first().getAttribute('data-kind');
      await until(async () => (await badge()) === 'live');
      await served.end();
      await until(async () => (await badge()) === 'lost');
      await served.start(served.port);
      await until(async () => (await page.locator('[role="alertdialog"]').count()) > 0, 20000, 'the page did not ask');
      await page.goto(served.url);
      await until(async () => (await badge()) === 'live');
      await until(async () => /started again/.test((await page.locator('.notices').textContent()) ?? ''));
      expect(await page.locator('.entrance').count()).toBe(0);
      expect(complaints).toEqual([]);
    });
  });
});
