import { readFileSync } from 'node:fs';
import type { Plugin } from 'vite';
import { defineConfig } from 'vitest/config';

/** What is in the bundle of others': their licences ask to come with it. */
const bundled = ['three', 'preact', '@preact/signals', '@preact/signals-core', 'uplot'];

/** As for the tests in a browser themselves: test/e2e/browser.ts. */
const patience = Number(process.env.FLEXURA_PATIENCE ?? 1);

function licences(): Plugin {
  return {
    name: 'licences',
    generateBundle() {
      const text = (name: string): string => readFileSync(new URL(`node_modules/${name}/LICENSE`, import.meta.url), 'utf8');
      const escaped = (line: string): string => line.replace(/&/g, '&amp;').replace(/</g, '&lt;');
      const parts = bundled.map((name) => `<h2>${name}</h2>\n<pre>${escaped(text(name).trim())}</pre>\n`);
      const source = `<!doctype html>\n<html lang="en"><meta charset="utf-8"><title>Licences</title>\n${parts.join('')}</html>\n`;
      this.emitFile({ type: 'asset', fileName: 'licences.html', source });
    },
  };
}

// The page is served by the program itself under a strict content security policy: nothing inline, every part a file.
export default defineConfig({
  base: './',
  plugins: [licences()],
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact', legalComments: 'none' },
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: false,
    cssCodeSplit: false,
    chunkSizeWarningLimit: 1000,
    reportCompressedSize: true,
  },
  test: {
    // Two browsers at a time: much of what they do is to wait.
    maxWorkers: 2,
    minWorkers: 1,
    projects: [
      {
        extends: true,
        test: { name: 'unit', include: ['test/unit/**/*.test.ts'], environment: 'node', testTimeout: 60_000 * patience },
      },
      {
        extends: true,
        test: {
          name: 'e2e',
          include: ['test/e2e/**/*.test.ts'],
          setupFiles: ['test/e2e/setup.ts'],
          // The files of a worker share its browser and what they import.
          poolOptions: { forks: { isolate: false } },
          environment: 'node',
          testTimeout: 30_000 * patience,
          hookTimeout: 60_000 * patience,
        },
      },
      {
        extends: true,
        test: { name: 'speed', include: ['test/speed/**/*.test.ts'], environment: 'node', testTimeout: 60_000, hookTimeout: 60_000 },
      },
    ],
  },
});
