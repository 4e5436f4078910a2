// SPDX-License-Identifier: Apache-2.0
// The page as the program serves it, on the simulated machine, in a browser.
import { execFileSync } from 'node:child_process';
import { readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from '../live/browser';
import { until as untilIn } from '../live/look';
import { PROGRAM, ROOMS, Running } from './running';

const running = new Running();

let opened: Open;

const text = (selector: string) => opened.page.textContent(selector);
const until = (expression: string) => untilIn(opened.page, expression);
const go = (view: string) => opened.page.evaluate(`location.hash = '#/${view}'`);

beforeAll(async () => {
  await running.start(ROOMS);
  opened = await open(running.address, `/#key=${running.key}`, { loggedIn: false });
});
afterAll(async () => {
  running.stop();
  await closeBrowser();
});

it('shows the machine at work', async () => {
  await until(`document.querySelector('#mode-badge')?.textContent === 'Observe'`);
  expect(opened.page.url()).not.toContain(running.key);
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
  expect(readFileSync(running.machine, 'utf8')).toContain('limit_um = 12.5');
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

it('sets the modulation at once, in act when that is confirmed, and keeps it over a change of the file', async () => {
  await go('chatter');
  await opened.page.click('[data-mode=act]:not(.badge)');
  await opened.page.click('dialog .strong');
  await until(`document.querySelector('#mode-badge').textContent === 'Act'`);
  await until(`document.querySelector('#law')?.value === 'triangle'`);
  await opened.page.selectOption('#law', 'sine');
  await opened.page.fill('#lower', '90');
  await opened.page.fill('#upper', '100');
  await opened.page.click('#set-modulation');
  await opened.page.click('dialog .strong');
  await until(`document.querySelector('.toasts').textContent.includes('The modulation is set.')`);
  expect(readFileSync(running.machine, 'utf8')).not.toContain('sine');
  await opened.page.click('#hand-back');
  await until(`document.querySelector('#mode-badge').textContent === 'Observe'`);
  await go('contour');
  await opened.page.fill('[data-key="contour.limit_um"] input', '13');
  await opened.page.click('#review');
  await opened.page.click('#apply');
  await opened.page.waitForSelector('dialog', { state: 'detached' });
  await go('chatter');
  await until(`document.querySelector('#law')?.value === 'sine'`);
  expect(await opened.page.inputValue('#upper')).toBe('100');
});

it('takes a measured size, and says what became of it', async () => {
  await go('thermal');
  await opened.page.waitForSelector('#measured-axis');
  expect(await opened.page.textContent('#measured-axis')).toBe('Z');
  await opened.page.fill('#measured-value', '0.25');
  await opened.page.click('#measured button');
  await until(`document.querySelector('#verdict-of-reading').textContent.includes('re-zeroed')`);
  await opened.page.fill('#measured-value', '5000');
  await opened.page.click('#measured button');
  await until(`document.querySelector('#verdict-of-reading').textContent.includes('rejected')`);
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
  expect(await text('#events')).toContain('page: local (engineer) set the modulation: sine, ±5.263 %, period 2 s, mean 95 % of the programmed speed');
  expect(await text('#events')).toContain('page: local (engineer) entered a measured size: Z is +5000 µm off, sd 1 µm; rejected: too far from the forecast');
  expect(opened.complaints).toEqual([]);
});

it('lets nobody in who does not know the key', async () => {
  expect((await fetch(`${running.address}/api/v1/status`)).status).toBe(401);
  const wrong = await fetch(`${running.address}/api/v1/session`, { method: 'POST', headers: { 'Content-Type': 'application/json' }, body: '{"key":"guess"}' });
  expect(wrong.status).toBe(401);
  const foreign = await fetch(`${running.address}/api/v1/session`, { method: 'POST', headers: { 'Content-Type': 'application/json', Origin: 'http://evil.example' }, body: JSON.stringify({ key: running.key }) });
  expect(foreign.status).toBe(403);
});

it('leaves a record that shows both, and decides the same again', async () => {
  await running.end();
  const [name] = readdirSync(join(running.folder, 'runs')).filter((f) => f.endsWith('.sqlite'));
  const record = join(running.folder, 'runs', name ?? '');
  const steadyrest = (...of: string[]) => execFileSync(PROGRAM, ['record', ...of], { encoding: 'utf8' });
  const shown = steadyrest('show', record);
  expect(shown).toContain('wish: page: local (engineer) set the modulation: sine');
  expect(shown).toContain('wish: page: local (engineer) entered a measured size: Z is +0.25 µm off, sd 1 µm\n');
  expect(JSON.parse(steadyrest('replay', record, '--json'))).toMatchObject({ different: 0, first_difference: null, gap_after: null, wishes: 3 });
});
