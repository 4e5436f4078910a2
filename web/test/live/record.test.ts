// SPDX-License-Identifier: Apache-2.0
// Records that ended before their run, or with a run that was killed.
import { afterAll, beforeAll, expect, it } from 'vitest';
import type { RecordRow } from '../../src/live/api/types';
import { RECORDS } from './answers';
import { type Open, closeBrowser, open } from './browser';
import { until as untilIn } from './look';
import { Mock } from './mock';

const mock = new Mock();
let opened: Open;
const until = (expression: string) => untilIn(opened.page, expression);

beforeAll(async () => {
  const address = await mock.start();
  mock.logIn('viewer');
  opened = await open(address);
});
afterAll(async () => {
  await closeBrowser();
  await mock.stop();
});

it('is a trouble among the reasons when the record ends before its run', async () => {
  const { page } = opened;
  await until(`document.querySelector('#reasons [data-reason]') !== null`);
  expect(await page.textContent('#reasons')).not.toContain('Recording');
  mock.layer.recordFault = 'the disk is full';
  await until(`document.querySelector('#reasons .trouble')?.textContent === 'Recording has stopped; the run goes on without it: the disk is full'`);
  mock.layer.recordFault = null;
  await until(`!document.querySelector('#reasons').textContent.includes('Recording')`);
});

it('says which record is being written, and which one was never closed', async () => {
  const killed = { ...(RECORDS[2] as RecordRow), name: 'killed.sqlite', writing: false };
  RECORDS.push(killed);
  await opened.page.evaluate(`location.hash = '#/record'`);
  await until(`document.querySelectorAll('#records tbody tr').length === 5`);
  const states = await opened.page.$$eval('#records tbody tr', (rows) => rows.map((r) => r.lastElementChild?.textContent));
  expect(states).toEqual(['complete', 'with fault', 'being written', 'damaged: file is not a database', 'ended without being closed']);
  RECORDS.pop();
  expect(opened.complaints).toEqual([]);
});
