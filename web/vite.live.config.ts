// SPDX-License-Identifier: Apache-2.0
// The live page: `index.html` and hashed assets, which the program embeds and serves.
import { defineConfig } from 'vite';

export default defineConfig({
  base: '/',
  plugins: [
    {
      name: 'index-html',
      enforce: 'post',
      generateBundle(_, bundle) {
        const page = bundle['live.html'];
        if (page) {
          page.fileName = 'index.html';
        }
      },
    },
  ],
  build: {
    outDir: 'dist-live',
    emptyOutDir: true,
    target: 'es2022',
    // Anything inline would break the content-security policy.
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 1200,
    rollupOptions: { input: 'live.html' },
  },
});
