import { defineConfig } from 'vitest/config';

/** The page in a browser, on the program as it is built: `make build` first. */
export default defineConfig({
  test: { include: ['test/e2e/**/*.test.ts'], testTimeout: 60_000, hookTimeout: 60_000, fileParallelism: false },
});
