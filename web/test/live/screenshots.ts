// SPDX-License-Identifier: Apache-2.0
// Pictures of every view for people: npm run screenshots:live -- FOLDER [view …]
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
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
for (const [size, [width, height, look]] of Object.entries(SIZES)) {
  const { page, context, complaints } = await open(address, '/', { width, height, settings: { language: 'en', look, units: 'mm' } });
  await page.waitForTimeout(FILL_MS);
  for (const view of VIEWS.filter((v) => chosen.length === 0 || chosen.includes(v))) {
    await page.goto(`${address}/#/${view}`);
    await page.waitForTimeout(1500);
    await page.screenshot({ path: join(folder, `${view.replace(/\/.*/, '-one')}-${size}.png`), fullPage: true });
  }
  console.log(size, complaints);
  await context.close();
}
await closeBrowser();
await mock.stop();
