// SPDX-License-Identifier: Apache-2.0
// Pictures of every view for people: npm run screenshots:live -- FOLDER [view …]
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import type { Page } from 'playwright-core';
import { closeBrowser, open } from './browser';
import { Mock } from './mock';

const [folder = 'screenshots', ...chosen] = process.argv.slice(2);
const VIEWS = ['now', 'contour', 'chatter', 'thermal', 'motion', 'record', 'record/rib-pocket-2026-01-02.sqlite', 'machine'];
const SIZES = { desktop: [1440, 900, 'light'], panel: [1024, 768, 'light'], phone: [390, 844, 'light'], dark: [1440, 900, 'dark'], contrast: [1024, 768, 'contrast'] } as const;
const FILL_MS = 6000;

mkdirSync(folder, { recursive: true });
const mock = new Mock();
const address = await mock.start();
mock.logIn('engineer');
mock.layer.wanted = 'act';
/** What no address leads to: dialogs, staged changes, a viewer, a lost connection, the log-in. */
async function moments(size: string, page: Page): Promise<void> {
  const shot = (name: string) => page.screenshot({ path: join(folder, `${name}-${size}.png`) });
  const go = async (view: string) => {
    await page.goto(`${address}/#/${view}`);
    await page.waitForTimeout(700);
  };
  await go('contour');
  await page.fill('[data-key="contour.limit_um"] input', '12');
  await shot('staged');
  await page.click('#review');
  await page.waitForSelector('dialog .diff');
  await shot('review');
  await page.keyboard.press('Escape');
  await page.click('#discard');
  await page.click('[data-mode=act]:not(.badge)');
  await shot('act');
  await page.keyboard.press('Escape');
  await page.click('#settings');
  await shot('settings');
  await page.keyboard.press('Escape');
  await go('machine');
  await page.click('#machine-as [data-value=text]');
  await shot('text');
  await go('now');
  mock.offline = true;
  mock.drop();
  await page.waitForTimeout(1500);
  await shot('lost');
  mock.offline = false;
  await page.waitForSelector('#missing:not([hidden])');
  await page.waitForTimeout(800);
  await shot('back');
  mock.logIn('viewer');
  await page.reload();
  await page.waitForTimeout(1500);
  await shot('viewer');
  mock.logOut();
  await page.reload();
  await page.waitForTimeout(700);
  await shot('log-in');
  mock.logIn('engineer');
}

for (const [size, [width, height, look]] of Object.entries(SIZES)) {
  const { page, context, complaints } = await open(address, '/', { width, height, settings: { language: 'en', look, units: 'mm' } });
  await page.waitForTimeout(FILL_MS);
  for (const view of VIEWS.filter((v) => chosen.length === 0 || chosen.includes(v))) {
    await page.goto(`${address}/#/${view}`);
    await page.waitForTimeout(1500);
    await page.screenshot({ path: join(folder, `${view.replace(/\/.*/, '-one')}-${size}.png`), fullPage: true });
  }
  if (chosen.length === 0 || chosen.includes('moments')) await moments(size, page);
  console.log(size, complaints);
  await context.close();
}
await closeBrowser();
await mock.stop();
