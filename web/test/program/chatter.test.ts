// SPDX-License-Identifier: Apache-2.0
// A slot that chatters, on the simulated machine: what the page shows of it while the layer acts.
import { afterAll, beforeAll, expect, it } from 'vitest';
import { type Open, closeBrowser, open } from '../live/browser';
import { colours, until as untilIn } from '../live/look';
import { Running } from './running';

const running = new Running();
let opened: Open;

const until = (expression: string) => untilIn(opened.page, expression);
const text = (selector: string) => opened.page.textContent(selector);

beforeAll(async () => {
  await running.start('', ['--program', 'examples/programs/slot.mpf', '--process', 'examples/processes/slot-922hz.toml', '--depth-mm', '0.6', '--mode', 'act']);
  opened = await open(running.address, `/#key=${running.key}`, { loggedIn: false });
});
afterAll(async () => {
  running.stop();
  await closeBrowser();
});

it('shows the better step, and how loud it was before', async () => {
  await until(`document.querySelector('#mode-badge')?.textContent === 'Act'`);
  await opened.page.evaluate(`location.hash = '#/chatter'`);
  await until(`document.querySelector('#chatter-now').textContent.includes('Spindle at 90 % against chatter')`);
  await until(`/[5-9]\\d/.test(document.querySelector('.vibration .before .value').textContent)`);
  await until(`document.querySelector('#chatter-now').textContent.startsWith('The cut is quiet')`);
  await until(`/^\\d(\\.\\d)?\\D/.test(document.querySelector('.vibration .level .value').textContent)`);
});

it('draws the course of the spectrum, and knows the speed by its orders', async () => {
  await until(`document.querySelector('.waterfall-panel').offsetHeight > 0`);
  await until(`/^Spindle by its orders: 45\\d\\d\\.\\d ± \\d/.test(document.querySelector('#chatter-signal').textContent)`);
  expect((await colours(opened.page))['waterfall']).toBeGreaterThan(20);
});

it('has the stability lobes with the cut in them, once they are computed', async () => {
  await until(`document.querySelector('.lobes-panel canvas') !== null`);
  const map = (await opened.page.evaluate(`fetch('/api/v1/chatter/lobes').then((r) => r.json())`)) as { lobes: { map: { speed_rpm: number[] }; depth_mm: number } };
  expect(map.lobes.depth_mm).toBe(0.6);
  const [slowest = 0, fastest = 0] = [map.lobes.map.speed_rpm[0], map.lobes.map.speed_rpm.at(-1)];
  expect(slowest).toBeLessThan(4500);
  expect(fastest).toBeGreaterThan(5000);
});

it('says what the planner decides', async () => {
  await until(`/Set the spindle override to \\d+ %: \\d+ rpm/.test(document.querySelector('#plan-words')?.textContent)`);
  expect(await text('.plan-panel')).toContain('Planned for 5000 rpm and a depth of 0.6 mm.');
});

it('offers no modulation: the layer sets the speed', async () => {
  expect(await text('#modulation-none')).toBe('The layer sets the spindle speed itself when it hears chatter.');
  expect(opened.complaints).toEqual([]);
});
