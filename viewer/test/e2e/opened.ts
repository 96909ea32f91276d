// The page shared by the tests of a file, and its server.
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

/** Shared by all files of a worker (vite.config.ts), and closed with it. */
let browser: Promise<Browser> | null = null;
/** The page of the running file. */
let shared: Opened | null = null;

/**
 * Opens an address in the file's page. A new page would take twice as long. Each server has its own port, so nothing
 * that the page has stored is found again on the next one.
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

/** Gives the next file a fresh page. */
export async function leave(): Promise<void> {
  await shared?.page.context().close();
  shared = null;
}

/** For the tests of the group in which it is called: opens their page before the first test. */
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

/** For the tests of a file: each gets a new fake rig and a newly loaded page, and must cause no browser errors. */
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

/** Starts the fake server of a rig, or of a recording of it. */
export async function faked(rig = spatial_rig(), kind: 'live' | 'recording' = 'live'): Promise<FakeServer> {
  const server = new FakeServer(dist, rig, kind);
  await server.start();
  return server;
}

/** Starts the program with an experiment file or with complete arguments. */
export async function started(what: string | string[] = ['view']): Promise<Served> {
  const served = new Program(what);
  await served.start();
  return served;
}

/**
 * Records an experiment file and starts the program on the results; `status` is the expected exit status of the run.
 */
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
