// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vitest/config';
import { viteSingleFile } from 'vite-plugin-singlefile';

export default defineConfig({
  plugins: [viteSingleFile({ removeViteModuleLoader: true })],
  test: { testTimeout: 60_000, hookTimeout: 60_000, fileParallelism: false },
  build: {
    rollupOptions: { input: process.env['STEADYREST_PAGE'] ?? 'report.html' },
    target: 'es2022',
    emptyOutDir: true,
    chunkSizeWarningLimit: 2000,
  },
});
