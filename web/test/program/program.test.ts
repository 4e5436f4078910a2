// SPDX-License-Identifier: Apache-2.0
// The page as the program serves it, on the simulated machine, in a browser. STEADYREST_PROGRAM names the program.
import { type ChildProcess, spawn } from 'node:child_process';
import { appendFileSync, copyFileSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from '../live/browser';
import { until as untilIn } from '../live/look';

const PROGRAM = process.env['STEADYREST_PROGRAM'] ?? '';
const ROOT = fileURLToPath(new URL('../../..', import.meta.url));
const folder = mkdtempSync(join(tmpdir(), 'steadyrest-page-'));
const machine = join(folder, 'machine.toml');

let run: ChildProcess;
let address = '';
let key = '';
let opened: Open;

/** Where the program says that its page is. */
function started(): Promise<[string, string]> {
  return new Promise((resolve, reject) => {
    let said = '';
    run.stderr?.on('data', (part: Buffer) => {
      said += part.toString();
      const found = /Page: (http:\/\/[^/]+)\/#key=(\S+)/.exec(said);
      if (found) {
        resolve([found[1] ?? '', found[2] ?? '']);
      }
    });
    run.on('exit', () => reject(new Error(`the program ended: ${said}`)));
  });
}

const text = (selector: string) => opened.page.textContent(selector);
const until = (expression: string) => untilIn(opened.page, expression);
const go = (view: string) => opened.page.evaluate(`location.hash = '#/${view}'`);

beforeAll(async () => {
  copyFileSync(join(ROOT, 'examples/machines/vmc-840d.toml'), machine);
  appendFileSync(machine, '\n[thermal]\nenabled = true\nmax_offset_um = 60\nslope_um_min = 30\n[[thermal.axis]]\nname = "Z"\n[[thermal.axis.mode]]\ntau_min = 8\nspeeds_rpm = [0, 6000]\nlevels_um = [0, 45]\n');
  run = spawn(PROGRAM, ['run', '--machine', machine, '--program', 'examples/programs/rib-pocket.mpf', '--repeat', '--record', join(folder, 'runs'), '--socket', join(folder, 's'), '--listen', '0'], { cwd: ROOT });
  [address, key] = await started();
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

it('says what each step of the override would give, and what the encoders are', async () => {
  await go('contour');
  await until(`document.querySelectorAll('#steps .step-row').length === 23`);
  await until(String.raw`[...document.querySelectorAll('#steps .step-row .value')].every((e) => /^[\d.]+\sµm$/.test(e.textContent))`);
  expect(await opened.page.$$eval('#steps .step-row.in-force', (all) => all.length)).toBe(1);
  await go('motion');
  await until(`document.querySelectorAll('#encoders tbody tr').length === 3`);
  expect(await text('#encoders tbody')).toContain('edges stamped to 100 ns');
});

it('warms up in the next hour, and says when the offset moves', async () => {
  await go('thermal');
  await until(String.raw`/the last|as it does now/.test(document.querySelector('#outlook-of')?.textContent)`);
  await until(`document.querySelector('#thermal-Z canvas') !== null`);
  expect(await text('#next-correction')).toContain('none within the hour'); // nothing is corrected in observe
  await opened.page.click('[data-mode=act]:not(.badge)');
  await opened.page.click('dialog .strong');
  await until(String.raw`/^Z(in|\d)/.test(document.querySelector('#corrections-come tbody tr')?.textContent)`);
  await opened.page.click('#hand-back');
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
