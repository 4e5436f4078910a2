// SPDX-License-Identifier: Apache-2.0
// How long until the page shows something (first contentful paint), beside an empty page of the same server.
// npm run paint:live [-- VISITS]
import { closeBrowser, open } from './browser';
import { Mock } from './mock';

const visits = Number(process.argv[2] ?? 10);
const EMPTY = '<!doctype html><title>empty</title><p>empty';

async function paint_ms(address: string, empty: boolean): Promise<number> {
  const { page, context } = await open(address, '/', { before: async (blank) => (empty ? blank.route('**/*', (route) => route.fulfill({ contentType: 'text/html', body: EMPTY })) : undefined) });
  const paint = await page.waitForFunction(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
  const ms = Number(await paint.jsonValue());
  await context.close();
  return ms;
}

const median = (of: number[]) => of.sort((a, b) => a - b)[Math.floor(of.length / 2)] ?? NaN;

const mock = new Mock();
mock.logIn('viewer');
const address = await mock.start();
const shown: number[] = [];
const empty: number[] = [];
for (let i = 0; i < visits; ++i) {
  shown.push(await paint_ms(address, false));
  empty.push(await paint_ms(address, true));
}
console.log(`first paint, median of ${visits}: ${median(shown).toFixed(0)} ms, an empty page ${median(empty).toFixed(0)} ms; the slowest ${Math.max(...shown).toFixed(0)} ms`);
await closeBrowser();
await mock.stop();
