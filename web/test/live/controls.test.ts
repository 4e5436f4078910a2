// SPDX-License-Identifier: Apache-2.0
// Every control used, as each role.
import { readFile } from 'node:fs/promises';
import type { Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, beforeEach, describe, expect, it } from 'vitest';
import type { Role } from '../../src/live/api/types';
import { type Open, closeBrowser, open } from './browser';
import { accessibilityFaults, beyond, show, tooSmall, until as untilIn } from './look';
import { MODULATION } from './layer';
import { Mock } from './mock';

const mock = new Mock();
let address = '';
let opened: Open;
let page: Page;

beforeAll(async () => {
  address = await mock.start();
});
afterAll(async () => {
  await closeBrowser();
  await mock.stop();
});
beforeEach(() => {
  mock.asked.length = 0;
  mock.layer.wanted = 'observe';
  mock.limit_um = 10;
});
afterEach(async () => {
  const { complaints } = opened;
  await opened.context.close();
  expect(complaints.filter((c) => !/status of 4\d\d/.test(c))).toEqual([]);
});

async function as(role: Role, view = 'now', width = 1440): Promise<void> {
  mock.logIn(role);
  opened = await open(address, `/#/${view}`, { width });
  page = opened.page;
  await page.waitForFunction(() => document.querySelector('#mode-badge')?.textContent !== '–');
}

const last = () => mock.asked.at(-1);
const until = (expression: string) => untilIn(page, expression);
const text = (selector: string) => page.textContent(selector);

describe('the mode', () => {
  it('changes to advise at once, to act only when confirmed', async () => {
    await as('operator');
    await page.click('[data-mode=advise]:not(.badge)');
    await until(`document.querySelector('#mode-badge').textContent === 'Advise'`);
    await page.click('[data-mode=act]:not(.badge)');
    expect(await text('dialog h2')).toBe('Let the layer act?');
    expect(await text('dialog')).toContain('VMC with SINUMERIK 840D');
    expect(await accessibilityFaults(page)).toEqual([]);
    await page.keyboard.press('Escape');
    await page.waitForSelector('dialog', { state: 'detached' });
    expect(mock.asked.map((a) => a.body)).toEqual([{ mode: 'advise' }]);
    await page.click('[data-mode=act]:not(.badge)');
    await page.click('dialog .strong');
    await until(`document.querySelector('#mode-badge').textContent === 'Act'`);
    expect(last()?.body).toEqual({ mode: 'act', confirm: true });
    await until(`document.querySelector('#say').textContent === 'The layer is in control'`);
    expect(await text('.toasts')).toContain('The mode is now Act.');
  });
  it.each(['viewer', 'operator', 'engineer'] as const)('is handed back in one press by a %s', async (role) => {
    mock.layer.wanted = 'act';
    await as(role, 'machine', 390);
    await page.click('#hand-back');
    await until(`document.querySelector('#mode-badge').textContent === 'Observe'`);
    expect(mock.asked).toEqual([{ method: 'POST', path: 'hand-back', body: {} }]);
    expect(await text('#say')).toBe('The operator is in control');
  });
  it.each(['the act dialog', 'the settings', 'the review'])('is handed back in one press while %s is open', async (dialog) => {
    await as('engineer', 'contour', 390);
    if (dialog === 'the review') {
      await page.fill('[data-key="contour.limit_um"] input', '12');
      await page.click('#review');
      await page.waitForSelector('dialog .diff');
    } else {
      await page.click(dialog === 'the settings' ? '#settings' : '[data-mode=act]:not(.badge)');
    }
    expect(await beyond(page)).toEqual([]);
    expect(await tooSmall(page)).toEqual([]);
    await page.click('dialog .hand-back');
    await expect.poll(() => last()?.path).toBe('hand-back');
  });
  it('says within a dialog what became of it', async () => {
    await as('viewer');
    await page.click('#settings');
    await page.click('dialog .hand-back');
    await until(`document.querySelector('dialog .toasts')?.textContent === 'Handing back to the panel.'`);
    const { x, y } = (await page.locator('dialog').boundingBox()) ?? { x: 0, y: 0 };
    await page.mouse.click(x + 6, y + 6);
    expect(await page.isVisible('dialog')).toBe(true);
    await page.mouse.click(x - 20, y + 6);
    await page.waitForSelector('dialog', { state: 'detached' });
    expect(await page.isVisible('.toasts')).toBe(true);
  });
  it('says what to do when handing back does not get through', async () => {
    await as('viewer');
    await page.route('**/api/v1/hand-back', (route) => route.abort());
    await page.click('#hand-back');
    await until(`document.querySelector('.toasts [role=alert]').textContent.includes('Use the machine’s own panel.')`);
    opened.complaints.length = 0;
  });
  it('is handed back from the keyboard', async () => {
    mock.layer.wanted = 'act';
    await as('viewer');
    await page.focus('#hand-back');
    await page.keyboard.press('Enter');
    await until(`document.querySelector('#mode-badge').textContent === 'Observe'`);
  });
});

describe('a role that is too low', () => {
  it('leaves a viewer the sight of everything, and says why', async () => {
    await as('viewer');
    expect(await page.isDisabled('[data-mode=act]:not(.badge)')).toBe(true);
    expect(await text('.modes .why')).toBe('Needs the role operator. You are logged in as viewer.');
    await show(page, 'chatter');
    expect(await page.isDisabled('#modulation button')).toBe(true);
    expect(await text('.modulation-panel .why')).toContain('Needs the role operator');
    expect(await page.locator('.modulation-panel .why').count()).toBe(1);
    await show(page, 'thermal');
    expect(await page.isDisabled('#measured button')).toBe(true);
    await show(page, 'record/circle-r10.sqlite');
    expect(await page.isDisabled('#replay')).toBe(true);
    expect(await text('.replay-panel .why')).toContain('Needs the role engineer');
    for (const width of [390, 1024]) {
      await page.setViewportSize({ width, height: 768 });
      await page.waitForTimeout(500);
      expect(await beyond(page)).toEqual([]);
    }
  });
  it('lets an operator stage and look, not apply', async () => {
    await as('operator', 'contour');
    await page.fill('[data-key="contour.limit_um"] input', '12');
    await page.click('#review');
    await page.waitForSelector('dialog .diff');
    expect(await page.isDisabled('#apply')).toBe(true);
    expect(await text('dialog .why')).toBe('Needs the role engineer. You are logged in as operator.');
    expect(await page.isDisabled('dialog .actions button:first-child')).toBe(false);
  });
});

describe('staged changes', () => {
  it('are shown as a difference, then applied', async () => {
    await as('engineer', 'contour');
    await page.fill('[data-key="contour.limit_um"] input', '12,5');
    await page.selectOption('[data-key="contour.strategy"] select', 'balanced');
    expect(await text('#staged p')).toBe('2 changes staged');
    expect(await text('[data-key="contour.limit_um"] .before')).toBe('in force 10');
    await show(page, 'machine');
    expect(await page.inputValue('[data-key="contour.limit_um"] input')).toBe('12.5');
    await page.click('#review');
    await page.waitForSelector('dialog .diff .plus');
    expect(await text('dialog .diff')).toContain('+limit_um = 12.5');
    expect(await text('dialog .findings')).toContain('Raise contour.limit_um');
    expect(await tooSmall(page)).toEqual([]);
    expect(await accessibilityFaults(page)).toEqual([]);
    await page.click('#apply');
    await page.waitForSelector('dialog', { state: 'detached' });
    expect(last()?.path).toBe('machine/apply');
    expect(last()?.body).toMatchObject({ changes: { 'contour.limit_um': 12.5, 'contour.strategy': 'balanced' }, sha256_before: expect.any(String) as string });
    await until(`document.querySelector('#staged').hidden`);
    // The file as it is now, not as it was when the view was opened.
    await until(`document.querySelector('[data-key="contour.limit_um"] input').value === '12.5'`);
    await show(page, 'contour');
    await page.fill('[data-key="contour.limit_um"] input', '11');
    expect(await text('[data-key="contour.limit_um"] .before')).toBe('in force 12.5');
    await page.click('#review');
    await page.click('#apply');
    await until(`document.querySelector('#staged').hidden && document.querySelector('[data-key="contour.limit_um"] input').value === '11'`);
    expect(await text('[data-key="contour.limit_um"] .before')).toBe('');
  });
  it('are applied in act as reviewed', async () => {
    mock.layer.wanted = 'act';
    await as('engineer', 'contour');
    await page.fill('[data-key="contour.limit_um"] input', '12');
    await page.click('#review');
    await page.click('#apply');
    await page.waitForSelector('dialog', { state: 'detached' });
    expect(last()).toMatchObject({ path: 'machine/apply', body: { confirm: true } });
  });
  it('that somebody else applies show at once', async () => {
    await as('viewer', 'machine');
    await page.click('[data-section=chatter] summary');
    mock.limit_um = 14;
    mock.sayHello();
    await until(`document.querySelector('[data-key="contour.limit_um"] input').value === '14'`);
    // What was opened stays open, and the keyboard where it was.
    expect(await page.getAttribute('[data-section=chatter]', 'open')).toBe('');
    expect(await page.evaluate(`document.activeElement.closest('[data-section]').dataset.section`)).toBe('chatter');
    await show(page, 'contour');
    mock.limit_um = 15;
    mock.sayHello();
    await until(`document.querySelector('[data-key="contour.limit_um"] input').value === '15'`);
  });
  it('that are refused say where and why', async () => {
    await as('engineer', 'contour');
    await page.fill('[data-key="contour.limit_um"] input', '5000');
    await page.click('#review');
    expect(await page.waitForSelector('dialog .refusals').then((e) => e.textContent())).toContain('line 7: contour.limit_um is 5000');
    expect(await page.isDisabled('#apply')).toBe(true);
  });
  it('that need a restart say so', async () => {
    await as('engineer', 'machine');
    await page.click('[data-section=envelope] summary');
    await page.selectOption('[data-key="envelope.layer_may_exceed_panel"] select', 'true');
    await page.click('#review');
    expect(await page.waitForSelector('dialog .fault').then((e) => e.textContent())).toContain('takes effect after a restart');
  });
  it('are looked at again when the file has changed meanwhile', async () => {
    await as('engineer', 'contour');
    mock.changedMeanwhile = true;
    await page.fill('[data-key="contour.limit_um"] input', '11');
    await page.click('#review');
    await page.click('#apply');
    expect(await page.waitForSelector('dialog .fault').then((e) => e.textContent())).toContain('changed in the meantime');
    await page.click('#apply');
    await page.waitForSelector('dialog', { state: 'detached' });
  });
  it('are dropped with one press, and what is no number is not staged', async () => {
    await as('engineer', 'contour');
    await page.fill('[data-key="contour.limit_um"] input', '11');
    await page.click('#discard');
    expect(await page.isHidden('#staged')).toBe(true);
    expect(await page.inputValue('[data-key="contour.limit_um"] input')).toBe('10');
    await page.fill('[data-key="contour.limit_um"] input', 'ten');
    expect(await page.getAttribute('[data-key="contour.limit_um"] input', 'aria-invalid')).toBe('true');
    expect(await page.isHidden('#staged')).toBe(true);
    await page.fill('[data-key="contour.limit_um"] input', '12');
    expect(await page.isVisible('#staged')).toBe(true);
    await page.fill('[data-key="contour.limit_um"] input', '');
    expect(await page.isHidden('#staged')).toBe(true);
  });
  it('may be the whole text', async () => {
    await as('engineer', 'machine');
    await page.click('#machine-as [data-value=text]');
    await page.fill('#whole-text', 'name = "other"\n');
    await page.waitForSelector('#staged:not([hidden])');
    await page.click('#review');
    await page.waitForSelector('dialog .diff');
    expect(last()).toMatchObject({ path: 'machine/check', body: { text: 'name = "other"\n' } });
  });
});

describe('chatter', () => {
  const SINE = { law: 'sine', amplitude_ratio: 0.2, mean_ratio: 1, period_s: 2 };
  const fill = async () => {
    await page.waitForSelector('#modulation');
    await page.selectOption('#law', 'sine');
    await page.fill('#lower', '80');
    await page.fill('#upper', '120');
    await page.fill('#frequency', '0.5');
    expect(await text('#modulation-is')).toBe('Mean 100 %, amplitude ±20 % of it (RVA), period 2 s.');
  };
  afterEach(() => {
    mock.layer.modulation = { ...MODULATION };
  });
  it('is set by an operator at once, in bounds and frequency', async () => {
    await as('operator', 'chatter');
    await fill();
    expect(await page.isDisabled('#modulation-into-file')).toBe(true);
    expect(await text('.modulation-panel .why')).toContain('Needs the role engineer');
    await page.click('#set-modulation');
    await until(`document.querySelector('.toasts').textContent.includes('The modulation is set.')`);
    expect(last()).toEqual({ method: 'POST', path: 'modulation', body: SINE });
    await page.reload();
    await until(`document.querySelector('#law')?.value === 'sine'`);
  });
  it('asks first where the layer acts', async () => {
    mock.layer.wanted = 'act';
    await as('operator', 'chatter');
    await fill();
    await page.click('#set-modulation');
    expect(await text('dialog h2')).toBe('Change the spindle speed now?');
    expect(await text('dialog p')).toContain('New modulation: sine. Mean 100 %, amplitude ±20 % of it (RVA), period 2 s.');
    expect(await accessibilityFaults(page)).toEqual([]);
    await page.keyboard.press('Escape');
    await page.waitForSelector('dialog', { state: 'detached' });
    expect(mock.asked).toEqual([]);
    await page.click('#set-modulation');
    await page.click('dialog .strong');
    await page.waitForSelector('dialog', { state: 'detached' });
    await until(`document.querySelector('.toasts').textContent.includes('The modulation is set.')`);
    expect(last()).toEqual({ method: 'POST', path: 'modulation', body: { ...SINE, confirm: true } });
  });
  it('shows why the layer refuses a modulation', async () => {
    await as('operator', 'chatter');
    await page.fill('#lower', '1');
    await page.fill('#upper', '199');
    await page.click('#set-modulation');
    await until(`document.querySelector('.modulation-panel .fault').textContent.includes('allowed: 0 … 0.9')`);
  });
  it('goes into the machine file by an engineer, as it differs from the file', async () => {
    mock.layer.modulation = { law: 'sine', amplitude_ratio: 0.2, mean_ratio: 1, period_s: 2 };
    await as('engineer', 'chatter');
    await fill();
    await page.click('#modulation-into-file');
    await page.click('#review');
    await page.waitForSelector('dialog .diff');
    expect(last()?.body).toEqual({ changes: { 'chatter.law': 'sine', 'chatter.amplitude_percent': 20, 'chatter.mean_percent': 100 } });
  });
  it('tells what makes no modulation', async () => {
    await as('engineer', 'chatter');
    await page.fill('#lower', '130');
    expect(await text('.modulation-panel .fault')).toContain('The lower bound');
    await page.click('#modulation button');
    expect(mock.asked).toEqual([]);
  });
  it('shows how loud it was before the layer stepped in', async () => {
    mock.layer.wanted = 'act';
    await as('viewer', 'chatter');
    await until(`document.querySelector('.vibration .before .value').textContent.includes('92')`);
    await until(`document.querySelector('#chatter-now').textContent === 'The cut chatters at 922 Hz · Spindle at 90 % against chatter'`);
    mock.layer.wanted = 'observe';
    await until(`document.querySelector('#chatter-now').textContent.endsWith('Better: spindle at 90 %')`);
  });
  it('is changed by somebody else while a button has the keyboard, not while somebody types', async () => {
    await as('operator', 'chatter');
    await page.waitForSelector('#modulation');
    await page.focus('#set-modulation');
    mock.layer.modulation = { ...SINE, law: 'sine' };
    mock.sayHello();
    await until(`document.querySelector('#law').value === 'sine' && document.activeElement.id === 'set-modulation'`);
    await page.fill('#lower', '77');
    mock.layer.modulation = { ...MODULATION };
    mock.sayHello();
    await page.waitForTimeout(400);
    expect(await page.inputValue('#lower')).toBe('77');
  });
  it('asks for the map no longer when another view is open', async () => {
    mock.studied = 0.4;
    await as('viewer', 'now');
    let asked = 0;
    await page.route('**/chatter/lobes', async (route) => {
      asked += 1;
      await new Promise((done) => setTimeout(done, 300));
      await route.continue();
    });
    await page.evaluate(`location.hash = '#/chatter'`);
    await expect.poll(() => asked).toBe(1);
    await show(page, 'now');
    await page.waitForTimeout(1500);
    expect(asked).toBe(1);
    mock.studied = 1;
  });
  it('tells how far map and plan are, and shows them when they are there', async () => {
    mock.studied = 0.4;
    await as('viewer', 'chatter');
    await until(`document.querySelector('#lobes-computing')?.textContent === 'Computing … 40 %'`);
    await until(`document.querySelector('.plan-panel').textContent.includes('Computing … 40 %')`);
    mock.studied = 1;
    await until(`document.querySelector('#plan-words')?.textContent === 'Set the spindle override to 90 %: 4680 rpm.'`);
    await until(`document.querySelector('.lobes-panel canvas') !== null`);
    expect(await text('.plan-panel')).toContain('Stable there up to 1.84\u00a0mm.'.replace('\u00a0', ' '));
  });
  it('does without a map', async () => {
    mock.withLobes = false;
    await as('operator', 'chatter');
    await until(`document.querySelector('.lobes-panel').textContent.includes('Start with --process FILE.')`);
    mock.withLobes = true;
  });
});

describe('a measured size', () => {
  it('is entered in the units shown, and judged', async () => {
    await as('operator', 'thermal');
    await page.waitForSelector('#measured');
    await page.selectOption('#measured-axis', 'Z');
    await page.fill('#measured-value', '−4,2');
    await page.click('#measured button');
    await until(`document.querySelector('#verdict-of-reading').textContent === 'A probe reading re-zeroed the thermal model.'`);
    expect(last()?.body).toEqual({ axis: 'Z', displacement_um: -4.2, sd_um: 1 });
    await page.fill('#measured-value', '99');
    // What was said of the size before is gone.
    expect(await text('#verdict-of-reading')).toBe('');
    await page.click('#measured button');
    await until(`document.querySelector('#verdict-of-reading').textContent.includes('rejected')`);
    await page.fill('#measured-value', 'much');
    await page.click('#measured button');
    expect(await text('.measured-panel .fault')).toBe('Enter a number.');
  });
  it('is asked about first where the layer acts', async () => {
    mock.layer.wanted = 'act';
    await as('operator', 'thermal');
    await page.waitForSelector('#measured');
    await page.fill('#measured-value', '4');
    await page.click('#measured button');
    expect(await text('dialog p')).toContain('The layer acts on VMC with SINUMERIK 840D. If Y 4.0\u00a0µm is plausible');
    await page.keyboard.press('Escape');
    await page.waitForSelector('dialog', { state: 'detached' });
    expect(mock.asked).toEqual([]);
    await page.click('#measured button');
    await page.click('dialog .strong');
    await until(`document.querySelector('#verdict-of-reading').textContent.includes('re-zeroed')`);
    expect(last()?.body).toEqual({ axis: 'Y', displacement_um: 4, sd_um: 1, confirm: true });
  });
  it('tells how long ago each was, the newest first', async () => {
    await as('viewer', 'thermal');
    await until(`document.querySelectorAll('#readings li').length === 2`);
    const said = await page.$$eval('#readings li', (all) => all.map((e) => e.textContent));
    expect(said[0]).toMatch(/^Z 41\.0\sµm 3\smin ago: .*rejected/);
    expect(said[1]).toMatch(/^Z −3\.9\sµm 16\smin ago: .*re-zeroed/);
  });
  it('that is implausible too often switches the correction off, which both views say', async () => {
    await as('viewer', 'thermal');
    await until(`document.querySelector('.thermal-row') !== null`);
    expect(await page.isHidden('#thermal-off')).toBe(true);
    mock.layer.heatSwitchedOff = true;
    for (const view of ['thermal', 'now']) {
      await show(page, view);
      await until(`document.querySelector('#thermal-off').checkVisibility() && document.querySelector('#thermal-off').textContent.startsWith('Thermal correction is off until the run ends')`);
    }
    mock.layer.heatSwitchedOff = false;
    await until(`document.querySelector('#thermal-off').hidden`);
  });
});

describe('records', () => {
  it('are found, sorted and opened', async () => {
    await as('engineer', 'record');
    await page.waitForSelector('#records');
    expect(await page.locator('#records tbody tr').count()).toBe(4);
    expect(await text('#records')).toContain('slot <test>.sqlite');
    await page.click('#records thead th:nth-child(5) button');
    expect(await text('#records tbody tr:first-child th')).toContain('rib-pocket');
    await page.fill('#search', 'circle');
    await until(`document.querySelectorAll('#records tbody tr').length === 1`);
    await page.click('#records a');
    await until(`document.querySelector('.record-name')?.textContent === 'circle-r10.sqlite'`);
    expect(await text('#events')).toBeDefined();
  });
  it('that are damaged say why, and offer nothing', async () => {
    await as('engineer', 'record');
    await until(`document.querySelector('#records')?.textContent.includes('damaged: file is not a database')`);
    const torn = page.locator('#records tbody tr', { hasText: 'torn.sqlite' });
    expect(await torn.locator('a, button').count()).toBe(0);
    expect(await torn.textContent()).toContain('1.2\u00a0MB');
    await page.click('#records thead th:nth-child(2) button');
    expect(await text('#records tbody tr:last-child')).toContain('torn.sqlite');
    await page.evaluate(`location.hash = '#/record/torn.sqlite'`);
    await until(`document.querySelector('.run-panel')?.textContent.includes('file is not a database')`);
    expect(await page.isVisible('#replay')).toBe(false);
    expect(await page.isVisible('.exports')).toBe(false);
  });
  it('have a slider also where the first try failed', async () => {
    await as('engineer', 'record');
    let tries = 0;
    await page.route('**/data?**', (route) => (++tries === 1 ? route.abort() : route.continue()));
    await page.evaluate(`location.hash = '#/record/circle-r10.sqlite'`);
    await page.click('.course-panel .problem button');
    await until(`document.querySelector('#time-shown').textContent === '0.0 … 1834.0 s'`);
    // The whole run is asked for once.
    expect(tries).toBe(2);
    opened.complaints.length = 0;
  });
  it('are played through, exported and decided again', async () => {
    await as('engineer', 'record/rib-pocket-2026-01-02.sqlite');
    await until(`document.querySelector('#time-shown').textContent === '0.0 … 1834.0 s'`);
    expect(await page.isDisabled('#time-slider')).toBe(true);
    await page.selectOption('#time-window', '60');
    await page.click('#later');
    expect(await text('#time-shown')).toBe('30.0 … 90.0 s');
    await page.focus('#time-slider');
    await page.keyboard.press('End');
    expect(await text('#time-shown')).toBe('1774.0 … 1834.0 s');
    await page.click('#earlier');
    await page.selectOption('#quantity', 'feed_percent');
    await until(`document.querySelector('#course-name').textContent === 'Feed override, %'`);
    for (const format of ['sqlite', 'csv', 'hdf5']) {
      const [download] = await Promise.all([page.waitForEvent('download'), page.click(`#export-${format}`)]);
      expect(download.url()).toMatch(new RegExp(`/export\\?format=${format}$`));
      expect((await readFile(await download.path())).length).toBeGreaterThan(0);
    }
    await page.click('#replay');
    await until(`document.querySelector('#replayed').textContent.includes('all the same')`);
  });
});

describe('the plots of the reports', () => {
  it.each(['chatter', 'thermal', 'record/rib-pocket-2026-01-02.sqlite'])('zoom and save on %s', async (view) => {
    await as('viewer', view);
    const figure = page.locator('figure').first();
    await figure.locator('canvas').waitFor();
    const names = [];
    for (const tool of ['in', 'out', 'whole']) {
      await figure.locator(`[data-tool=${tool}]`).click();
    }
    for (const tool of ['png', 'csv']) {
      const [download] = await Promise.all([page.waitForEvent('download'), figure.locator(`[data-tool=${tool}]`).click()]);
      names.push(download.suggestedFilename());
      expect((await readFile(await download.path())).length).toBeGreaterThan(100);
    }
    expect(names).toEqual([expect.stringMatching(/\.png$/), expect.stringMatching(/\.csv$/)]);
  });
});

describe('settings', () => {
  it('switch language, look and units at once, and last', async () => {
    await as('engineer');
    await page.click('#settings');
    await page.selectOption('#set-language', 'de');
    expect(await text('nav a[data-view=now]')).toBe('Jetzt');
    expect(await page.getAttribute('html', 'lang')).toBe('de');
    await page.click('#settings');
    await page.selectOption('#set-units', 'inch');
    await until(`document.querySelector('#error-limit').textContent === '0.394\u00a0mil'`);
    await page.click('#settings');
    await page.selectOption('#set-look', 'contrast');
    expect(await page.evaluate('getComputedStyle(document.body).backgroundColor')).toBe('rgb(0, 0, 0)');
    await page.reload();
    await page.waitForSelector('nav');
    expect(await text('nav a[data-view=motion]')).toBe('Achsen');
    expect(await page.getAttribute('html', 'data-look')).toBe('contrast');
    await show(page, 'contour');
    await until(`document.querySelector('#reasons, .limits h2').textContent.includes('Grenzen')`);
  });
  it('let go of the session', async () => {
    await as('engineer');
    await page.click('#settings');
    expect(await text('dialog')).toContain('anna, engineer');
    await page.click('#log-out');
    await page.waitForSelector('#by-password');
    expect(await text('.log-in .fault')).toBe('You have been logged out.');
  });
});
