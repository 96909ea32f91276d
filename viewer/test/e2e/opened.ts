// A page that the tests of a group share, and who serves it.
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

/** Of the tests of the group where it is called: their page is there from the first of them on, and gone after the last. */
export function opened_before(
  start: () => Promise<Served>, kind: 'recording' | 'live', size: { width?: number; height?: number } = { width: 1280, height: 720 },
): Opened {
  const opened = {} as Opened;
  let browser: Browser;
  let served: Served;

  beforeAll(async () => {
    browser = await launch();
    served = await start();
    Object.assign(opened, await open_page(browser, served.url, size));
    await opened.page.waitForSelector(`.badge[data-kind="${kind}"]`);
    await opened.page.waitForSelector('.section .slider');
  });

  afterAll(async () => {
    await browser?.close();
    await served?.stop();
  });

  return opened;
}

export interface Fresh {
  server: FakeServer;
  page: Page;
}

/** Of the tests of a file: each gets a page of its own, of a fake rig of its own; the browser complains of none. */
export function fresh_before_each(use: (fresh: Fresh) => void): void {
  let browser: Browser;
  let server: FakeServer;
  let opened: Opened;

  beforeAll(async () => {
    browser = await launch();
  });

  afterAll(async () => {
    await browser?.close();
  });

  beforeEach(async () => {
    server = await faked();
    opened = await open_page(browser, server.url, { width: 1280, height: 720 });
    await opened.page.waitForSelector('.badge[data-kind="live"]');
    await opened.page.waitForSelector('.section .slider');
    use({ server, page: opened.page });
  });

  afterEach(async () => {
    expect(opened.complaints).toEqual([]);
    await opened.page.context().close();
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
