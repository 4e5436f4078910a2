// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vitest/config';
import { viteSingleFile } from 'vite-plugin-singlefile';

export default defineConfig({
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  test: { testTimeout: 240_000, hookTimeout: 240_000, fileParallelism: false },
  build: {
    rollupOptions: { input: 'page.html' },
    target: 'es2022',
    emptyOutDir: true,
    chunkSizeWarningLimit: 2000,
  },
});
