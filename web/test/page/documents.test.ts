// SPDX-License-Identifier: Apache-2.0
// The pictures of README and docs against what the program shows today: the words in them, which are kept in
// docs/pictures.json, to the letter, and the picture itself. After an intended change run `npm run pictures:docs`
// with STEADYREST_PROGRAM and look at the new pictures.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { afterAll, describe, expect, it } from 'vitest';
import { compare } from '../live/pictures';
import { closeBrowser, openFromDisk } from './browser';

const ROOT = fileURLToPath(new URL('../../..', import.meta.url));
const WORDS = join(ROOT, 'docs/pictures.json');
const PROGRAM = process.env['STEADYREST_PROGRAM'] ?? '';
const UPDATE = process.env['STEADYREST_UPDATE_PICTURES'] === '1';
const MOST = 0.006;
const WIDTH = 1240;
/** Of a picture; the report's shows its trade-off, too. */
const HEIGHT: Record<string, number> = { 'docs/report.png': 1090 };

const PICTURES: Record<string, string> = {
  'docs/report.png': 'cut examples/programs/rib-pocket.mpf --machine examples/machines/vmc-840d.toml',
  'docs/chatter-lobes.png':
    'chatter lobes examples/processes/slot-922hz.toml --speeds-rpm 2000:12000:401 --depths-mm 0:4:161 -o {folder}/lobes.csv --speed-rpm 5000 --depth-mm 1 --machine examples/machines/vmc-840d.toml',
};

const words = JSON.parse(UPDATE ? '{}' : readFileSync(WORDS, 'utf8')) as Record<string, string[]>;

function reportOf(command: string): string {
  const folder = mkdtempSync(join(tmpdir(), 'steadyrest-documents-'));
  try {
    execFileSync(PROGRAM, [...command.replace('{folder}', folder).split(' '), '--report', join(folder, 'report'), '--force'], { cwd: ROOT, stdio: 'pipe' });
    return readFileSync(join(folder, 'report/report.html'), 'utf8');
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

describe.skipIf(PROGRAM === '')('the pictures of README and docs', () => {
  afterAll(closeBrowser);

  it.each(Object.entries(PICTURES))('%s shows what the program says today', async (name, command) => {
    const height = HEIGHT[name] ?? 868;
    const { page, close } = await openFromDisk(reportOf(command), { width: WIDTH, height });
    await page.waitForTimeout(1000);
    const shown = await page.evaluate((bottom) => {
      const inSight = (element: Element) => element.getBoundingClientRect().bottom < bottom && element.getBoundingClientRect().height > 0;
      return [...document.querySelectorAll<HTMLElement>('h1, h2, h3, p, dt, dd, figcaption, .figure, .card, .subtitle')].filter(inSight).map((element) => element.innerText.replace(/\s+/g, ' ').trim());
    }, height);
    const actual = await page.screenshot({ animations: 'disabled', caret: 'hide' });
    if (UPDATE) {
      words[name] = shown;
      writeFileSync(join(ROOT, name), actual);
      writeFileSync(WORDS, `${JSON.stringify(words, undefined, 2)}\n`);
    } else {
      expect(shown).toEqual(words[name]);
      expect((await compare(page, readFileSync(join(ROOT, name)), actual)).share).toBeLessThan(MOST);
    }
    await close();
  }, 120_000);
});
