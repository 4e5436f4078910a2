// SPDX-License-Identifier: Apache-2.0
// Rooms share through frame/ and plot/, never with one another. The live page shows what some rooms draw.
import { readFileSync, readdirSync } from 'node:fs';
import { dirname, join, relative, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { describe, expect, it } from 'vitest';

const SOURCE = fileURLToPath(new URL('../../src', import.meta.url));
const MAY_IMPORT: Record<string, string[]> = {
  frame: [], plot: ['frame'], cut: ['frame', 'plot'], motion: ['frame', 'plot'], chatter: ['frame', 'plot'], thermal: ['frame', 'plot'],
  live: ['frame', 'plot', 'cut', 'chatter'],
};

describe.each(Object.entries(MAY_IMPORT))('the folder %s', (folder, allowed) => {
  it('imports only what is beneath it', () => {
    const files = readdirSync(join(SOURCE, folder), { recursive: true, encoding: 'utf8' }).filter((f) => f.endsWith('.ts'));
    expect(files.length).toBeGreaterThan(0);
    for (const file of files) {
      const path = join(SOURCE, folder, file);
      for (const [, other = ''] of readFileSync(path, 'utf8').matchAll(/(?:from|import\() ?'(\.[^']+)'/g)) {
        const [first = ''] = relative(SOURCE, resolve(dirname(path), other)).split('/');
        expect([folder, ...allowed], `${folder}/${file}`).toContain(first);
      }
    }
  });
});

it('every folder has its rule', () => {
  const folders = readdirSync(SOURCE, { withFileTypes: true }).filter((e) => e.isDirectory()).map((e) => e.name);
  expect(folders.sort()).toEqual(Object.keys(MAY_IMPORT).sort());
});
