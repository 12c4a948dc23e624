import { defineConfig } from 'vitest/config';
import { compress } from './build/compress.ts';
import { examples } from './build/examples.ts';
import { schema } from './build/schema.ts';

export default defineConfig({
  // Relative, so that the page works behind any prefix.
  base: './',
  plugins: [examples(), schema(), compress()],
  oxc: { jsx: { runtime: 'automatic', importSource: 'preact' } },
  build: {
    target: 'es2022',
    sourcemap: false,
    modulePreload: { polyfill: false },
    assetsInlineLimit: 0,
    license: { fileName: 'licences.json' },
  },
  server: {
    proxy: Object.fromEntries(
      [
        '/simulate',
        '/convert',
        '/analytic',
        '/target',
        '/corridor',
        '/footprint',
        '/sites',
        '/validation',
        '/licences',
        '/docs',
        '/guide',
        '/problems',
        '/warnings',
        '/openapi.json',
        '/health',
      ].map((path) => [path, 'http://127.0.0.1:8080']),
    ),
  },
  test: { include: ['test/unit/**/*.test.ts'] },
});
