// SPDX-License-Identifier: Apache-2.0
// Compares each view with its stored picture in pictures/, while the layer is paused. After an intended change, run
// `npm run pictures:live` and look at the new pictures.
import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from './browser';
import { VIEWS, show } from './look';
import { Mock } from './mock';
import { compare } from './pictures';

const FOLDER = fileURLToPath(new URL('pictures', import.meta.url));
const OUT = process.env['STEADYREST_PICTURES_OUT'] ?? fileURLToPath(new URL('../../../out/pictures', import.meta.url));
const UPDATE = process.env['STEADYREST_UPDATE_PICTURES'] === '1';
const MOST = 0.006;
const SIZE = { width: 1280, height: 1500, scale: 0.5 };

const nameOf = (view: string) => view.replace(/\/.*/, '-one');

describe.each(['light', 'dark'])('in the look %s', (look) => {
  const mock = new Mock();
  let shown: Open;
  let blank: Open;

  beforeAll(async () => {
    let seed = 1;
    mock.layer.random = () => (seed = (seed * 48_271) % 2_147_483_647) / 2_147_483_647;
    mock.still = true;
    mock.layer.wanted = 'act';
    const address = await mock.start();
    mock.logIn('engineer');
    shown = await open(address, '/', { ...SIZE, settings: { language: 'en', look, units: 'mm' } });
    await shown.page.waitForSelector('#view .panel');
    mock.play(60);
    blank = await open('about:blank', '', { loggedIn: false });
  });
  afterAll(async () => {
    await closeBrowser();
    await mock.stop();
  });

  // One dark view shows that the look is taken; the rest of the colours are tested by axe-core.
  it.each(look === 'light' ? VIEWS : ['now'])('%s is as in its picture', async (view) => {
    await show(shown.page, view);
    await shown.page.waitForTimeout(1000);
    const actual = await shown.page.screenshot({ animations: 'disabled', caret: 'hide' });
    const name = `${nameOf(view)}-${look}`;
    const file = join(FOLDER, `${name}.png`);
    if (UPDATE) {
      mkdirSync(FOLDER, { recursive: true });
      writeFileSync(file, actual);
      return;
    }
    expect(existsSync(file), `${file} is missing; npm run pictures:live makes it`).toBe(true);
    const { share, difference } = await compare(blank.page, readFileSync(file), actual);
    if (share > MOST) {
      mkdirSync(OUT, { recursive: true });
      writeFileSync(join(OUT, `${name}-actual.png`), actual);
      writeFileSync(join(OUT, `${name}-difference.png`), difference);
    }
    expect(share, `the view ${view} differs from ${file}; see ${OUT}/${name}-actual.png and ${name}-difference.png, and npm run pictures:live if it is meant`).toBeLessThanOrEqual(MOST);
  });

  it('a panel that is not there is noticed', async () => {
    if (UPDATE) {
      return;
    }
    await show(shown.page, 'now');
    await shown.page.waitForTimeout(1000);
    await shown.page.evaluate(() => document.querySelector('#view .panel')?.replaceChildren());
    const { share } = await compare(blank.page, readFileSync(join(FOLDER, `now-${look}.png`)), await shown.page.screenshot());
    expect(share).toBeGreaterThan(2 * MOST);
  });
});
