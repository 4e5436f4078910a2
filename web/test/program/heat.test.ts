// SPDX-License-Identifier: Apache-2.0
// A machine that warms up, as the program serves it.
import { afterAll, beforeAll, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from '../live/browser';
import { until as untilIn } from '../live/look';
import { Running } from './running';

const running = new Running();
let opened: Open;
const until = (expression: string) => untilIn(opened.page, expression);

/** 45 µm at 6000 rpm within half an hour. */
const HEAT = `
[thermal]
enabled = true
max_offset_um = 60
slope_um_min = 60
[[thermal.axis]]
name = "Z"
[[thermal.axis.mode]]
tau_min = 8
speeds_rpm = [0, 6000]
levels_um = [0, 45]
`;

beforeAll(async () => {
  await running.start(HEAT);
  opened = await open(running.address, `/#key=${running.key}`, { loggedIn: false });
});
afterAll(async () => {
  running.stop();
  await closeBrowser();
});

it('foresees the next hour, and corrects nothing in observe', async () => {
  await until(`document.querySelector('#mode-badge')?.textContent === 'Observe'`);
  await opened.page.evaluate(`location.hash = '#/thermal'`);
  await until(String.raw`/the last|as it does now/.test(document.querySelector('#outlook-of')?.textContent)`);
  await until(`document.querySelector('#thermal-Z canvas') !== null`);
  expect(await opened.page.textContent('#next-correction')).toContain('none within the hour');
});

it('lists what is corrected and what comes once it acts, also after a reload', async () => {
  await opened.page.click('[data-mode=act]:not(.badge)');
  await opened.page.click('dialog .strong');
  await opened.page.waitForFunction(() => document.querySelectorAll('#corrections-done tbody tr').length > 1, undefined, { timeout: 60_000 });
  const first = () => opened.page.$$eval('#corrections-done tbody tr', (rows) => rows.at(-1)?.lastElementChild?.textContent);
  expect(await first()).toBe('0.0 → −1.0');
  expect(await opened.page.textContent('#corrections-come tbody')).toMatch(/^Zin/);
  await opened.page.reload();
  await until(`document.querySelectorAll('#corrections-done tbody tr').length > 1`);
  expect(await first()).toBe('0.0 → −1.0');
  expect(opened.complaints).toEqual([]);
});
