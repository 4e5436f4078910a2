// SPDX-License-Identifier: Apache-2.0
// What the page shows of the vibration: its course, and the line in words.
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, beforeEach, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from './browser';
import { EVIDENCE } from './layer';
import { colours, show, until as untilIn } from './look';
import { Mock } from './mock';

const mock = new Mock();
let address = '';
let opened: Open;
let page: Page;

beforeAll(async () => {
  address = await mock.start();
  mock.logIn('viewer');
});
afterAll(async () => {
  await closeBrowser();
  await mock.stop();
});
beforeEach(async () => {
  opened = await open(address);
  page = opened.page;
  await show(page, 'chatter');
});
afterEach(async () => {
  mock.layer.hears = true;
  expect(opened.complaints).toEqual([]);
  await opened.context.close();
});
const until = (expression: string) => untilIn(page, expression);

it('the course of the spectrum is drawn with its legend', async () => {
  await until(`document.querySelector('.waterfall-panel').offsetHeight > 0`);
  await page.waitForTimeout(1000);
  expect((await colours(page))['waterfall']).toBeGreaterThan(8);
  expect(await page.$$eval('.waterfall-panel .key', (all) => all.map((e) => e.textContent))).toEqual(['tooth orders', 'other orders of the spindle', 'Chatter', 'mode of the process']);
  expect(await page.$$eval('.waterfall-panel .scale em', (all) => all.map((e) => e.textContent).at(-1))).toBe('0');
});

it('the line is told with its order, its confidence and the nearest mode', async () => {
  await until(`document.querySelector('#chatter-line').textContent !== ''`);
  const { nearest_order, from_order_sd_hz } = EVIDENCE.line;
  expect(await page.textContent('#chatter-line')).toBe(`931\u00a0Hz: 22.1\u00a0Hz ± ${from_order_sd_hz} below order ${nearest_order} · confidence\u00a097\u00a0% · 9.2\u00a0Hz above the mode at 922\u00a0Hz`);
  expect(await page.textContent('#chatter-signal')).toBe('Spindle by its orders: 5199.6 ± 0.4\u00a0rpm');
});

it('without a sensor there is no course', async () => {
  mock.layer.hears = false;
  await page.reload();
  await show(page, 'chatter');
  await until(`document.querySelector('#chatter-now').textContent.startsWith('Nothing listens')`);
  await page.waitForTimeout(600);
  expect(await page.$eval('.waterfall-panel', (e) => (e as HTMLElement).offsetHeight)).toBe(0);
});
