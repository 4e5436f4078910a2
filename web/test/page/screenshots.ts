// SPDX-License-Identifier: Apache-2.0
// Pictures of pages for people: npm run screenshots -- FOLDER [report.html …]
import { mkdirSync, readFileSync } from 'node:fs';
import { basename, dirname, join } from 'node:path';
import { makeReport } from '../fixture';
import { closeBrowser, fill, openFromDisk } from './browser';

const [folder = 'screenshots', ...files] = process.argv.slice(2);
const pages = files.length > 0 ? files.map((f) => ({ name: basename(dirname(f)), html: readFileSync(f, 'utf8') })) : [{ name: 'cut', html: fill(makeReport(16000)) }];
mkdirSync(folder, { recursive: true });
for (const { name, html } of pages) {
  const { page, close, complaints } = await openFromDisk(html);
  for (const width of [1440, 1024, 390]) {
    await page.setViewportSize({ width, height: 900 });
    await page.waitForTimeout(300);
    await page.screenshot({ path: join(folder, `${name}-${width}.png`), fullPage: true });
  }
  await page.setViewportSize({ width: 1280, height: 900 });
  await page.pdf({ path: join(folder, `${name}.pdf`), format: 'A4', preferCSSPageSize: true });
  await page.emulateMedia({ colorScheme: 'dark' });
  await page.waitForTimeout(300);
  await page.screenshot({ path: join(folder, `${name}-dark.png`), fullPage: true });
  console.log(name, complaints);
  await close();
}
await closeBrowser();
