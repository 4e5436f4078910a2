// SPDX-License-Identifier: Apache-2.0
// Pictures of the page for people: npm run screenshots -- FOLDER [report.html]
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { makeReport } from '../fixture';
import { fill, openFromDisk } from './browser';

const folder = process.argv[2] ?? 'screenshots';
const html = process.argv[3] ? readFileSync(process.argv[3], 'utf8') : fill(makeReport(16000));
mkdirSync(folder, { recursive: true });
for (const colorScheme of ['light', 'dark'] as const) {
  const { page, close, complaints } = await openFromDisk(html, { colorScheme });
  await page.screenshot({ path: join(folder, `${colorScheme}.png`), fullPage: true });
  if (colorScheme === 'light') {
    await page.locator('#path-without').hover({ position: { x: 300, y: 200 } });
    await page.locator('#course').hover({ position: { x: 400, y: 100 } });
    await page.screenshot({ path: join(folder, 'course.png') });
    await page.setViewportSize({ width: 480, height: 900 });
    await page.waitForTimeout(300);
    await page.screenshot({ path: join(folder, 'narrow.png'), fullPage: true });
    await page.setViewportSize({ width: 1280, height: 900 });
  }
  // What the printer gets.
  await page.evaluate(() => window.dispatchEvent(new Event('beforeprint')));
  await page.emulateMedia({ media: 'print' });
  await page.screenshot({ path: join(folder, `${colorScheme}-print.png`), fullPage: true });
  console.log(colorScheme, complaints);
  await close();
}
