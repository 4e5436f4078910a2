// SPDX-License-Identifier: Apache-2.0
// scripts/demo.sh: every view is alive, and at Ctrl-C the record that it names is there.
import { existsSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, expect, it } from 'vitest';
import { closeBrowser, open } from '../live/browser';
import { until as untilIn } from '../live/look';
import { Demo, ROOT } from './running';

const demo = new Demo();
afterAll(async () => {
  await demo.end();
  await closeBrowser();
});

it('fills every view', async () => {
  await demo.start();
  const { page, complaints } = await open(demo.address, `/#key=${demo.key}`, { loggedIn: false });
  const until = (expression: string) => untilIn(page, expression);
  await until(`document.querySelector('#chatter-state')?.textContent.startsWith('The cut')`);
  await until(`document.querySelector('.now-view .thermal')?.textContent.includes('Next correction')`);
  await page.evaluate(`location.hash = '#/chatter'`);
  await until(`document.querySelector('.lobes-panel canvas') !== null && document.querySelector('#plan-words') !== null`);
  await page.evaluate(`location.hash = '#/thermal'`);
  await until(`document.querySelector('#thermal-Z canvas') !== null && document.querySelectorAll('#corrections-come tbody tr').length > 0`);
  await page.evaluate(`location.hash = '#/record'`);
  await until(`document.querySelector('#records')?.textContent.includes('run-')`);
  expect(complaints).toEqual([]);
});

it('keeps the record that it names at the end', async () => {
  const said = await demo.end();
  const record = /record: (\S+\.sqlite)/.exec(said)?.[1] ?? 'none';
  expect(record).toMatch(/^out\/demo\//);
  expect(existsSync(join(ROOT, record))).toBe(true);
  rmSync(join(ROOT, record));
});
