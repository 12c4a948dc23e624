import { defineConfig } from 'vitest/config';
import { schema } from './build/schema.ts';

/** The page in a browser, on the program as it is built: `make build` first. */
export default defineConfig({
  plugins: [schema()],
  test: { include: ['test/e2e/**/*.test.ts'], testTimeout: 60_000, hookTimeout: 60_000, maxWorkers: 2 },
});
