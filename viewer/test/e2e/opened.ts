// The page that the tests of a file share, and who serves it.
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, beforeEach, expect } from 'vitest';
import { spatial_rig } from '../fake/rigs';
import { FakeServer } from '../fake/server';
import { dist, launch, open_page, type Opened } from './browser';
import { Program } from './program';

export interface Served {
  readonly url: string;
  stop(): Promise<void>;
}

/** Of all files that a worker runs (vite.config.ts), and ended with it. */
let browser: Promise<Browser> | null = null;
/** Of the file that runs. */
let shared: Opened | null = null;

/**
 * Shows an address in the file's page. A page of its own would cost twice as much; each server has a port of its own, so
 * nothing that the page has stored is found again at the next one.
 */
export async function visit(url: string, { width = 1280, height = 720, dark = true } = {}): Promise<Opened> {
  if (!shared) {
    browser ??= launch();
    shared = await open_page(await browser, url, { width, height, dark });
    return shared;
  }
  const { page, complaints } = shared;
  await page.context().clearCookies();
  await page.setViewportSize({ width, height });
  await page.emulateMedia({ colorScheme: dark ? 'dark' : 'light' });
  complaints.length = 0;
  await page.goto(url);
  return shared;
}

/** The next file gets a page that nobody has touched. */
export async function leave(): Promise<void> {
  await shared?.page.context().close();
  shared = null;
}

/** Of the tests of the group where it is called: their page is there from the first of them on. */
export function opened_before(start: () => Promise<Served>, kind: 'recording' | 'live'): Opened {
  const opened = {} as Opened;
  let served: Served;

  beforeAll(async () => {
    served = await start();
    Object.assign(opened, await visit(served.url));
    await opened.page.waitForSelector(`.badge[data-kind="${kind}"]`);
    await opened.page.waitForSelector('.section .slider');
  });

  afterAll(async () => {
    await served?.stop();
  });

  return opened;
}

export interface Fresh {
  server: FakeServer;
  page: Page;
}

/** Of the tests of a file: each finds a fake rig of its own, to which the page has just come; the browser complains of none. */
export function fresh_before_each(use: (fresh: Fresh) => void): void {
  let server: FakeServer;
  let opened: Opened;

  beforeEach(async () => {
    server = await faked();
    opened = await visit(server.url);
    await opened.page.waitForSelector('.badge[data-kind="live"]');
    await opened.page.waitForSelector('.section .slider');
    use({ server, page: opened.page });
  });

  afterEach(async () => {
    expect(opened.complaints).toEqual([]);
    await server.stop();
  });
}

/** The fake server of a rig, or of a recording of it. */
export async function faked(rig = spatial_rig(), kind: 'live' | 'recording' = 'live'): Promise<FakeServer> {
  const server = new FakeServer(dist, rig, kind);
  await server.start();
  return server;
}

/** The program, asked for an experiment's file or by whole words. */
export async function started(what: string | string[] = ['view']): Promise<Served> {
  const served = new Program(what);
  await served.start();
  return served;
}

/** The program on what it recorded of an experiment's file; `status` is how the run ends. */
export async function recorded(file: string, status = 0): Promise<Served> {
  const made = new Program();
  const shown = await started(['view', made.record(file, status)]);
  return {
    url: shown.url,
    stop: async () => {
      await shown.stop();
      await made.stop();
    },
  };
}
