// SPDX-License-Identifier: Apache-2.0
// The page as the program serves it, on the simulated machine, in a browser. STEADYREST_PROGRAM names the program.
import { type ChildProcess, spawn } from 'node:child_process';
import { copyFileSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from '../live/browser';
import { until as untilIn } from '../live/look';
import { PROGRAM, ROOT, started } from './run';

const folder = mkdtempSync(join(tmpdir(), 'steadyrest-page-'));
const machine = join(folder, 'machine.toml');

let run: ChildProcess;
let address = '';
let key = '';
let opened: Open;

const text = (selector: string) => opened.page.textContent(selector);
const until = (expression: string) => untilIn(opened.page, expression);
const go = (view: string) => opened.page.evaluate(`location.hash = '#/${view}'`);

beforeAll(async () => {
  copyFileSync(join(ROOT, 'examples/machines/vmc-840d.toml'), machine);
  run = spawn(PROGRAM, ['run', '--machine', machine, '--program', 'examples/programs/rib-pocket.mpf', '--repeat', '--record', join(folder, 'runs'), '--socket', join(folder, 's'), '--listen', '0'], { cwd: ROOT });
  [address, key] = await started(run);
  opened = await open(address, `/#key=${key}`, { loggedIn: false });
});
afterAll(async () => {
  run.kill('SIGTERM');
  await closeBrowser();
  rmSync(folder, { recursive: true, force: true });
});

it('shows the machine at work', async () => {
  await until(`document.querySelector('#mode-badge')?.textContent === 'Observe'`);
  expect(opened.page.url()).not.toContain(key);
  expect(await text('h1')).toContain('VMC with SINUMERIK 840D');
  await until(`/Cutting/.test(document.body.textContent)`);
  await until(`document.querySelector('#connection').textContent.includes('Live')`);
});

it('lets the layer act when that is confirmed, and takes it back with one press', async () => {
  await opened.page.click('[data-mode=act]:not(.badge)');
  await opened.page.click('dialog .strong');
  await until(`document.querySelector('#mode-badge').textContent === 'Act'`);
  await opened.page.click('#hand-back');
  await until(`document.querySelector('#mode-badge').textContent === 'Observe'`);
});

it('applies a change of the machine file while it runs', async () => {
  await go('contour');
  await opened.page.fill('[data-key="contour.limit_um"] input', '12.5');
  await opened.page.click('#review');
  expect(await text('dialog .diff')).toContain('+limit_um = 12.5');
  await opened.page.click('#apply');
  await opened.page.waitForSelector('dialog', { state: 'detached' });
  expect(readFileSync(machine, 'utf8')).toContain('limit_um = 12.5');
  await go('now');
  await until(String.raw`/12\.5\sµm/.test(document.body.textContent)`);
});

it('has every view, and the record of this run with who did what', async () => {
  for (const view of ['chatter', 'thermal', 'motion', 'machine']) {
    await go(view);
    await opened.page.waitForTimeout(500);
  }
  await go('record');
  await opened.page.click('#records a');
  await until(`document.querySelector('#events')?.textContent.includes('page: local (engineer) asked for act')`);
  expect(await text('#events')).toContain('page: local (engineer) handed back');
  expect(opened.complaints).toEqual([]);
});

it('lets nobody in who does not know the key', async () => {
  expect((await fetch(`${address}/api/v1/status`)).status).toBe(401);
  const wrong = await fetch(`${address}/api/v1/session`, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: '{"key":"guess"}' });
  expect(wrong.status).toBe(401);
  const foreign = await fetch(`${address}/api/v1/session`, { method: 'POST', headers: { 'Content-Type': 'application/json', Origin: 'http://evil.example' }, body: JSON.stringify({ key }) });
  expect(foreign.status).toBe(403);
});
