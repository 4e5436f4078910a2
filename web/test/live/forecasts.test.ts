// SPDX-License-Identifier: Apache-2.0
// What comes: the steps of the override, the next hour of heat, and the encoders behind the estimates.
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from './browser';
import { show, until as untilIn } from './look';
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
beforeEach(() => {
  mock.layer.wanted = 'act';
  mock.layer.pathKnown = true;
});
afterEach(async () => {
  expect(opened.complaints).toEqual([]);
  await opened.context.close();
});

async function at(view: string): Promise<void> {
  opened = await open(address);
  page = opened.page;
  await show(page, view);
}
const until = (expression: string) => untilIn(page, expression);
const text = (selector: string) => page.textContent(selector);
const rows = (selector: string) => page.$$eval(`${selector} tbody tr`, (all) => all.map((r) => [...r.children].map((c) => c.textContent ?? '')));

describe('the steps of the override', () => {
  it('have the error of each, held and now, from the fastest down', async () => {
    await at('contour');
    await until(`document.querySelectorAll('#steps .step-row').length === 15`);
    const labels = await page.$$eval('#steps .label', (all) => all.map((e) => e.textContent));
    expect(labels[0]).toBe('110 %');
    expect(labels.at(-1)).toBe('10 %');
    expect(await page.$$eval('#steps .step-row.in-force', (all) => all.length)).toBe(1);
    expect(await text('#steps .step-row .value')).toMatch(/µm$/);
    expect(await text('#steps .step-row .step-change')).toMatch(/µm$/);
  });

  it('say that nothing is foreseen where no path is known', async () => {
    await at('contour');
    await until(`document.querySelectorAll('#steps .step-row').length === 15`);
    mock.layer.pathKnown = false;
    await until(`document.querySelector('#steps').hidden && /path ahead is unknown, so/.test(document.querySelector('#steps-none').textContent)`);
  });
});

describe('heat', () => {
  it('shows the next hour, and what was and will be corrected', async () => {
    await at('thermal');
    await until(`document.querySelector('#outlook-of').textContent.includes('last 10')`);
    expect(await text('#next-correction')).toMatch(/Z to −3\.0\sµm in 14\smin/);
    expect(await rows('#corrections-come')).toEqual([['Z', expect.stringMatching(/in 14\smin/), '−4.0 → −3.0'], ['Z', expect.stringMatching(/in 32\smin/), '−3.0 → −2.0']]);
    expect((await rows('#corrections-done')).map((r) => r[0])).toEqual(['Y', 'Z']);
    await page.waitForSelector('#thermal-cyclogram canvas');
    expect(await page.$$eval('.histories canvas', (all) => all.length)).toBe(3);
  });
});

describe('the encoders', () => {
  it('are shown with their calibration, its curve and what it leaves', async () => {
    await at('motion');
    await page.waitForSelector('#calibration-X canvas');
    const [x, y, z, c] = await rows('#encoders');
    expect(x?.join(' ')).toMatch(/incremental ×4, edges stamped to 100 ns.*0\.1\sµm.*7.412.000 of 8.000.000 lines/);
    expect(y?.join(' ')).toContain('not applied');
    expect(z?.join(' ')).toContain('none');
    expect(c?.join(' ')).toMatch(/counts alone.*°.*no bounds/);
    expect(await page.$$eval('#encoders canvas', (all) => all.length)).toBe(1);
  });
});
