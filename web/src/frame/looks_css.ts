// SPDX-License-Identifier: Apache-2.0
// looks.ts as a style sheet, made by both builds: `import 'virtual:looks.css'`.
import type { Plugin } from 'vite';
import { COLOURS, type Look, SCHEME, SHARED } from './looks';

const ID = 'virtual:looks.css';
const RESOLVED = '\0looks.css';

const declared = (of: object): string => Object.entries(of).map(([name, value]) => `  --${name}: ${value};\n`).join('');

/** What the system asks for, until a page sets `data-look` on its root. Paper is white. */
export function looksCss(): string {
  const looks = (Object.keys(COLOURS) as Look[]).map((look) => `:root:root[data-look='${look}'] {\n${declared(COLOURS[look])}  color-scheme: ${SCHEME[look]};\n}\n`);
  return `:root {\n${declared(SHARED)}${declared(COLOURS.light)}  color-scheme: light dark;\n}\n@media (prefers-color-scheme: dark) {\n:root:not(.printing) {\n${declared(COLOURS.dark)}}\n}\n${looks.join('')}`;
}

export function looksPlugin(): Plugin {
  return {
    name: 'looks',
    resolveId: (id) => (id === ID ? RESOLVED : undefined),
    load: (id) => (id === RESOLVED ? looksCss() : undefined),
  };
}
