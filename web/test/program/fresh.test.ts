// SPDX-License-Identifier: Apache-2.0
// Browsers that come and go: what nobody watched is not missing.
import { afterAll, beforeAll, expect, it } from 'vitest';
import { closeBrowser, open } from '../live/browser';
import { until } from '../live/look';
import { Running } from './running';

const running = new Running();

beforeAll(async () => running.start());
afterAll(async () => {
  running.stop();
  await closeBrowser();
});

it('misses nothing of the time before it came', async () => {
  for (let visit = 0; visit < 2; ++visit) {
    const { page, context, complaints } = await open(running.address, `/#key=${running.key}`, { loggedIn: false });
    await until(page, `document.querySelector('#connection')?.textContent === 'Live'`);
    await page.waitForTimeout(1000);
    expect(await page.isHidden('#missing'), (await page.textContent('#missing')) ?? '').toBe(true);
    expect(complaints).toEqual([]);
    await context.close();
    await new Promise((done) => setTimeout(done, 1500));
  }
});
