// SPDX-License-Identifier: Apache-2.0
// Every control used, as each role.
import { readFile } from 'node:fs/promises';
import { describe, expect, it } from 'vitest';
import { accessibilityFaults, beyond, show, tooSmall } from './look';
import { Visit } from './visit';

const visit = new Visit();
const { mock, as, last, until, text } = visit;

describe('the mode', () => {
  it('changes to advise at once, to act only when confirmed', async () => {
    await as('operator');
    await visit.page.click('[data-mode=advise]:not(.badge)');
    await until(`document.querySelector('#mode-badge').textContent === 'Advise'`);
    await visit.page.click('[data-mode=act]:not(.badge)');
    expect(await text('dialog h2')).toBe('Let the layer act?');
    expect(await text('dialog')).toContain('VMC with SINUMERIK 840D');
    expect(await accessibilityFaults(visit.page)).toEqual([]);
    await visit.page.keyboard.press('Escape');
    await visit.page.waitForSelector('dialog', { state: 'detached' });
    expect(mock.asked.map((a) => a.body)).toEqual([{ mode: 'advise' }]);
    await visit.page.click('[data-mode=act]:not(.badge)');
    await visit.page.click('dialog .strong');
    await until(`document.querySelector('#mode-badge').textContent === 'Act'`);
    expect(last()?.body).toEqual({ mode: 'act', confirm: true });
    await until(`document.querySelector('#say').textContent === 'The layer is in control'`);
    expect(await text('.toasts')).toContain('The mode is now Act.');
  });
  it.each(['viewer', 'operator', 'engineer'] as const)('is handed back in one press by a %s', async (role) => {
    mock.layer.wanted = 'act';
    await as(role, 'machine', 390);
    await visit.page.click('#hand-back');
    await until(`document.querySelector('#mode-badge').textContent === 'Observe'`);
    expect(mock.asked).toEqual([{ method: 'POST', path: 'hand-back', body: {} }]);
    expect(await text('#say')).toBe('The operator is in control');
  });
  it.each(['the act dialog', 'the settings', 'the review'])('is handed back in one press while %s is open', async (dialog) => {
    await as('engineer', 'contour', 390);
    if (dialog === 'the review') {
      await visit.page.fill('[data-key="contour.limit_um"] input', '12');
      await visit.page.click('#review');
      await visit.page.waitForSelector('dialog .diff');
    } else {
      await visit.page.click(dialog === 'the settings' ? '#settings' : '[data-mode=act]:not(.badge)');
    }
    expect(await beyond(visit.page)).toEqual([]);
    expect(await tooSmall(visit.page)).toEqual([]);
    await visit.page.click('dialog .hand-back');
    await expect.poll(() => last()?.path).toBe('hand-back');
  });
  it('says within a dialog what became of it', async () => {
    await as('viewer');
    await visit.page.click('#settings');
    await visit.page.click('dialog .hand-back');
    await until(`document.querySelector('dialog .toasts')?.textContent === 'Handing back to the panel.'`);
    const { x, y } = (await visit.page.locator('dialog').boundingBox()) ?? { x: 0, y: 0 };
    await visit.page.mouse.click(x + 6, y + 6);
    expect(await visit.page.isVisible('dialog')).toBe(true);
    await visit.page.mouse.click(x - 20, y + 6);
    await visit.page.waitForSelector('dialog', { state: 'detached' });
    expect(await visit.page.isVisible('.toasts')).toBe(true);
  });
  it('says what to do when handing back does not get through', async () => {
    await as('viewer');
    await visit.page.route('**/api/v1/hand-back', (route) => route.abort());
    await visit.page.click('#hand-back');
    await until(`document.querySelector('.toasts [role=alert]').textContent.includes('Use the machine’s own panel.')`);
    visit.excuse();
  });
  it('is handed back from the keyboard', async () => {
    mock.layer.wanted = 'act';
    await as('viewer');
    await visit.page.focus('#hand-back');
    await visit.page.keyboard.press('Enter');
    await until(`document.querySelector('#mode-badge').textContent === 'Observe'`);
  });
});

describe('a role that is too low', () => {
  it('leaves a viewer the sight of everything, and says why', async () => {
    await as('viewer');
    expect(await visit.page.isDisabled('[data-mode=act]:not(.badge)')).toBe(true);
    expect(await text('.modes .why')).toBe('Needs the role operator. You are logged in as viewer.');
    await show(visit.page, 'chatter');
    expect(await visit.page.isDisabled('#modulation button')).toBe(true);
    expect(await text('.modulation-panel .why')).toContain('Needs the role operator');
    expect(await visit.page.locator('.modulation-panel .why').count()).toBe(1);
    await show(visit.page, 'thermal');
    expect(await visit.page.isDisabled('#measured button')).toBe(true);
    await show(visit.page, 'record/circle-r10.sqlite');
    expect(await visit.page.isDisabled('#replay')).toBe(true);
    expect(await text('.replay-panel .why')).toContain('Needs the role engineer');
    for (const width of [390, 1024]) {
      await visit.page.setViewportSize({ width, height: 768 });
      await visit.page.waitForTimeout(500);
      expect(await beyond(visit.page)).toEqual([]);
    }
  });
  it('lets an operator stage and look, not apply', async () => {
    await as('operator', 'contour');
    await visit.page.fill('[data-key="contour.limit_um"] input', '12');
    await visit.page.click('#review');
    await visit.page.waitForSelector('dialog .diff');
    expect(await visit.page.isDisabled('#apply')).toBe(true);
    expect(await text('dialog .why')).toBe('Needs the role engineer. You are logged in as operator.');
    expect(await visit.page.isDisabled('dialog .actions button:first-child')).toBe(false);
  });
});

describe('staged changes', () => {
  it('are shown as a difference, then applied', async () => {
    await as('engineer', 'contour');
    await visit.page.fill('[data-key="contour.limit_um"] input', '12,5');
    await visit.page.selectOption('[data-key="contour.strategy"] select', 'balanced');
    expect(await text('#staged p')).toBe('2 changes staged');
    expect(await text('[data-key="contour.limit_um"] .before')).toBe('in force 10');
    await show(visit.page, 'machine');
    expect(await visit.page.inputValue('[data-key="contour.limit_um"] input')).toBe('12.5');
    await visit.page.click('#review');
    await visit.page.waitForSelector('dialog .diff .plus');
    expect(await text('dialog .diff')).toContain('+limit_um = 12.5');
    expect(await text('dialog .findings')).toContain('Raise contour.limit_um');
    expect(await tooSmall(visit.page)).toEqual([]);
    expect(await accessibilityFaults(visit.page)).toEqual([]);
    await visit.page.click('#apply');
    await visit.page.waitForSelector('dialog', { state: 'detached' });
    expect(last()?.path).toBe('machine/apply');
    expect(last()?.body).toMatchObject({ changes: { 'contour.limit_um': 12.5, 'contour.strategy': 'balanced' }, sha256_before: expect.any(String) as string });
    await until(`document.querySelector('#staged').hidden`);
    // The file as it is now, not as it was when the view was opened.
    await until(`document.querySelector('[data-key="contour.limit_um"] input').value === '12.5'`);
    await show(visit.page, 'contour');
    await visit.page.fill('[data-key="contour.limit_um"] input', '11');
    expect(await text('[data-key="contour.limit_um"] .before')).toBe('in force 12.5');
    await visit.page.click('#review');
    await visit.page.click('#apply');
    await until(`document.querySelector('#staged').hidden && document.querySelector('[data-key="contour.limit_um"] input').value === '11'`);
    expect(await text('[data-key="contour.limit_um"] .before')).toBe('');
  });
  it('are applied in act as reviewed', async () => {
    mock.layer.wanted = 'act';
    await as('engineer', 'contour');
    await visit.page.fill('[data-key="contour.limit_um"] input', '12');
    await visit.page.click('#review');
    await visit.page.click('#apply');
    await visit.page.waitForSelector('dialog', { state: 'detached' });
    expect(last()).toMatchObject({ path: 'machine/apply', body: { confirm: true } });
  });
  it('that somebody else applies show at once', async () => {
    await as('viewer', 'machine');
    await visit.page.click('[data-section=chatter] summary');
    mock.limit_um = 14;
    mock.sayHello();
    await until(`document.querySelector('[data-key="contour.limit_um"] input').value === '14'`);
    // What was opened stays open, and the keyboard where it was.
    expect(await visit.page.getAttribute('[data-section=chatter]', 'open')).toBe('');
    expect(await visit.page.evaluate(`document.activeElement.closest('[data-section]').dataset.section`)).toBe('chatter');
    await show(visit.page, 'contour');
    mock.limit_um = 15;
    mock.sayHello();
    await until(`document.querySelector('[data-key="contour.limit_um"] input').value === '15'`);
  });
  it('that are refused say where and why', async () => {
    await as('engineer', 'contour');
    await visit.page.fill('[data-key="contour.limit_um"] input', '5000');
    await visit.page.click('#review');
    expect(await visit.page.waitForSelector('dialog .refusals').then((e) => e.textContent())).toContain('line 7: contour.limit_um is 5000');
    expect(await visit.page.isDisabled('#apply')).toBe(true);
  });
  it('that need a restart say so', async () => {
    await as('engineer', 'machine');
    await visit.page.click('[data-section=envelope] summary');
    await visit.page.selectOption('[data-key="envelope.layer_may_exceed_panel"] select', 'true');
    await visit.page.click('#review');
    expect(await visit.page.waitForSelector('dialog .fault').then((e) => e.textContent())).toContain('takes effect after a restart');
  });
  it('are looked at again when the file has changed meanwhile', async () => {
    await as('engineer', 'contour');
    mock.changedMeanwhile = true;
    await visit.page.fill('[data-key="contour.limit_um"] input', '11');
    await visit.page.click('#review');
    await visit.page.click('#apply');
    expect(await visit.page.waitForSelector('dialog .fault').then((e) => e.textContent())).toContain('changed in the meantime');
    await visit.page.click('#apply');
    await visit.page.waitForSelector('dialog', { state: 'detached' });
  });
  it('are dropped with one press, and what is no number is not staged', async () => {
    await as('engineer', 'contour');
    await visit.page.fill('[data-key="contour.limit_um"] input', '11');
    await visit.page.click('#discard');
    expect(await visit.page.isHidden('#staged')).toBe(true);
    expect(await visit.page.inputValue('[data-key="contour.limit_um"] input')).toBe('10');
    await visit.page.fill('[data-key="contour.limit_um"] input', 'ten');
    expect(await visit.page.getAttribute('[data-key="contour.limit_um"] input', 'aria-invalid')).toBe('true');
    expect(await visit.page.isHidden('#staged')).toBe(true);
    await visit.page.fill('[data-key="contour.limit_um"] input', '12');
    expect(await visit.page.isVisible('#staged')).toBe(true);
    await visit.page.fill('[data-key="contour.limit_um"] input', '');
    expect(await visit.page.isHidden('#staged')).toBe(true);
  });
  it('may be the whole text', async () => {
    await as('engineer', 'machine');
    await visit.page.click('#machine-as [data-value=text]');
    await visit.page.fill('#whole-text', 'name = "other"\n');
    await visit.page.waitForSelector('#staged:not([hidden])');
    await visit.page.click('#review');
    await visit.page.waitForSelector('dialog .diff');
    expect(last()).toMatchObject({ path: 'machine/check', body: { text: 'name = "other"\n' } });
  });
});

describe('records', () => {
  it('are found, sorted and opened', async () => {
    await as('engineer', 'record');
    await visit.page.waitForSelector('#records');
    expect(await visit.page.locator('#records tbody tr').count()).toBe(4);
    expect(await text('#records')).toContain('slot <test>.sqlite');
    await visit.page.click('#records thead th:nth-child(5) button');
    expect(await text('#records tbody tr:first-child th')).toContain('rib-pocket');
    await visit.page.fill('#search', 'circle');
    await until(`document.querySelectorAll('#records tbody tr').length === 1`);
    await visit.page.click('#records a');
    await until(`document.querySelector('.record-name')?.textContent === 'circle-r10.sqlite'`);
    await until(`document.querySelector('#events')?.textContent.includes('asked for act')`);
  });
  it('that are damaged say why, and offer nothing', async () => {
    await as('engineer', 'record');
    await until(`document.querySelector('#records')?.textContent.includes('damaged: file is not a database')`);
    const torn = visit.page.locator('#records tbody tr', { hasText: 'torn.sqlite' });
    expect(await torn.locator('a, button').count()).toBe(0);
    expect(await torn.textContent()).toContain('1.2\u00a0MB');
    await visit.page.click('#records thead th:nth-child(2) button');
    expect(await text('#records tbody tr:last-child')).toContain('torn.sqlite');
    await visit.page.evaluate(`location.hash = '#/record/torn.sqlite'`);
    await until(`document.querySelector('.run-panel')?.textContent.includes('file is not a database')`);
    expect(await visit.page.isVisible('#replay')).toBe(false);
    expect(await visit.page.isVisible('.exports')).toBe(false);
  });
  it('have a slider also where the first try failed', async () => {
    await as('engineer', 'record');
    let tries = 0;
    await visit.page.route('**/data?**', (route) => (++tries === 1 ? route.abort() : route.continue()));
    await visit.page.evaluate(`location.hash = '#/record/circle-r10.sqlite'`);
    await visit.page.click('.course-panel .problem button');
    await until(`document.querySelector('#time-shown').textContent === '0.0 … 1834.0 s'`);
    // The whole run is asked for once.
    expect(tries).toBe(2);
    visit.excuse();
  });
  it('are played through, exported and decided again', async () => {
    await as('engineer', 'record/rib-pocket-2026-01-02.sqlite');
    await until(`document.querySelector('#time-shown').textContent === '0.0 … 1834.0 s'`);
    expect(await visit.page.isDisabled('#time-slider')).toBe(true);
    await visit.page.selectOption('#time-window', '60');
    await visit.page.click('#later');
    expect(await text('#time-shown')).toBe('30.0 … 90.0 s');
    await visit.page.focus('#time-slider');
    await visit.page.keyboard.press('End');
    expect(await text('#time-shown')).toBe('1774.0 … 1834.0 s');
    await visit.page.click('#earlier');
    await visit.page.selectOption('#quantity', 'feed_percent');
    await until(`document.querySelector('#course-name').textContent === 'Feed override, %'`);
    for (const format of ['sqlite', 'csv', 'hdf5']) {
      const [download] = await Promise.all([visit.page.waitForEvent('download'), visit.page.click(`#export-${format}`)]);
      expect(download.url()).toMatch(new RegExp(`/export\\?format=${format}$`));
      expect((await readFile(await download.path())).length).toBeGreaterThan(0);
    }
    await visit.page.click('#replay');
    await until(`document.querySelector('#replayed').textContent.includes('all the same')`);
  });
});

describe('the plots of the reports', () => {
  it.each(['chatter', 'thermal', 'record/rib-pocket-2026-01-02.sqlite'])('zoom and save on %s', async (view) => {
    await as('viewer', view);
    const figure = visit.page.locator('figure').first();
    await figure.locator('canvas').waitFor();
    const names = [];
    for (const tool of ['in', 'out', 'whole']) {
      await figure.locator(`[data-tool=${tool}]`).click();
    }
    for (const tool of ['png', 'csv']) {
      const [download] = await Promise.all([visit.page.waitForEvent('download'), figure.locator(`[data-tool=${tool}]`).click()]);
      names.push(download.suggestedFilename());
      expect((await readFile(await download.path())).length).toBeGreaterThan(100);
    }
    expect(names).toEqual([expect.stringMatching(/\.png$/), expect.stringMatching(/\.csv$/)]);
  });
});

describe('settings', () => {
  it('switch language, look and units at once, and last', async () => {
    await as('engineer');
    await visit.page.click('#settings');
    await visit.page.selectOption('#set-language', 'de');
    expect(await text('nav a[data-view=now]')).toBe('Jetzt');
    expect(await visit.page.getAttribute('html', 'lang')).toBe('de');
    await visit.page.click('#settings');
    await visit.page.selectOption('#set-language', 'ru');
    await until(`document.querySelector('#error-limit').textContent === '10.0\u00a0мкм'`);
    await visit.page.click('#settings');
    await visit.page.selectOption('#set-language', 'de');
    await visit.page.click('#settings');
    await visit.page.selectOption('#set-units', 'inch');
    await until(`document.querySelector('#error-limit').textContent === '0.394\u00a0mil'`);
    await visit.page.click('#settings');
    await visit.page.selectOption('#set-look', 'contrast');
    expect(await visit.page.evaluate('getComputedStyle(document.body).backgroundColor')).toBe('rgb(0, 0, 0)');
    await visit.page.reload();
    await visit.page.waitForSelector('nav');
    expect(await text('nav a[data-view=motion]')).toBe('Achsen');
    expect(await visit.page.getAttribute('html', 'data-look')).toBe('contrast');
    await show(visit.page, 'contour');
    await until(`document.querySelector('#reasons, .limits h2').textContent.includes('Grenzen')`);
  });
  it('keep the session where letting go of it did not get through', async () => {
    await as('engineer');
    await visit.page.route('**/api/v1/session', (route) => (route.request().method() === 'DELETE' ? route.abort() : route.continue()));
    await visit.page.click('#settings');
    await visit.page.click('#log-out');
    await until(`document.querySelector('.toasts [role=alert]').textContent === 'Failed: The server cannot be reached.'`);
    expect(await visit.page.isVisible('#hand-back')).toBe(true);
    visit.excuse();
  });
  it('let go of the session', async () => {
    await as('engineer');
    await visit.page.click('#settings');
    expect(await text('dialog')).toContain('anna, engineer');
    await visit.page.click('#log-out');
    await visit.page.waitForSelector('#by-password');
    expect(await text('.log-in .fault')).toBe('You have been logged out.');
  });
});
