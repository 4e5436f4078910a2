// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from 'vitest/config';
import { viteSingleFile } from 'vite-plugin-singlefile';
import { looksPlugin } from './src/frame/looks_css';

export default defineConfig({
  plugins: [looksPlugin(), viteSingleFile({ removeViteModuleLoader: true })],
  test: { testTimeout: 240_000, hookTimeout: 240_000, maxWorkers: 2, minWorkers: 1 },
  build: {
    rollupOptions: { input: 'page.html' },
    target: 'es2022',
    emptyOutDir: true,
    chunkSizeWarningLimit: 2000,
  },
});
