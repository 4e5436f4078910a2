// SPDX-License-Identifier: Apache-2.0
// Rooms share through frame/ and plot/, never with one another.
import { readFileSync, readdirSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { describe, expect, it } from 'vitest';

const SOURCE = fileURLToPath(new URL('../../src', import.meta.url));
const MAY_IMPORT: Record<string, string[]> = { frame: [], plot: ['frame'], cut: ['frame', 'plot'], motion: ['frame', 'plot'], chatter: ['frame', 'plot'], thermal: ['frame', 'plot'] };

describe.each(Object.entries(MAY_IMPORT))('the folder %s', (folder, allowed) => {
  it('imports only what is beneath it', () => {
    const files = readdirSync(`${SOURCE}/${folder}`).filter((f) => f.endsWith('.ts'));
    expect(files.length).toBeGreaterThan(0);
    for (const file of files) {
      const text = readFileSync(`${SOURCE}/${folder}/${file}`, 'utf8');
      for (const [, other = ''] of text.matchAll(/from '\.\.\/([^/']+)/g)) {
        expect(allowed, `${folder}/${file}`).toContain(other);
      }
    }
  });
});

it('every folder has its rule', () => {
  const folders = readdirSync(SOURCE, { withFileTypes: true }).filter((e) => e.isDirectory()).map((e) => e.name);
  expect(folders.sort()).toEqual(Object.keys(MAY_IMPORT).sort());
});
