// SPDX-License-Identifier: Apache-2.0
// The live page: `index.html` and its assets, which the program embeds and serves.
import { defineConfig } from 'vite';
import { looksPlugin } from './src/frame/looks_css';

export default defineConfig({
  base: '/',
  plugins: [
    looksPlugin(),
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
    // One script and one style, under the names that the program serves.
    cssCodeSplit: false,
    rollupOptions: {
      input: 'live.html',
      output: { entryFileNames: 'live.js', assetFileNames: 'live[extname]', inlineDynamicImports: true },
    },
  },
});
