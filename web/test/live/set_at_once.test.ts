// SPDX-License-Identifier: Apache-2.0
// What is set at once: the modulation of the spindle's speed, and measured sizes.
import { afterEach, describe, expect, it } from 'vitest';
import { MODULATION } from './layer';
import { accessibilityFaults, show } from './look';
import { Visit } from './visit';

const visit = new Visit();
const { mock, as, last, until, text } = visit;

describe('chatter', () => {
  const SINE = { law: 'sine', amplitude_ratio: 0.2, mean_ratio: 1, period_s: 2 };
  const fill = async () => {
    await visit.page.waitForSelector('#modulation');
    await visit.page.selectOption('#law', 'sine');
    await visit.page.fill('#lower', '80');
    await visit.page.fill('#upper', '120');
    await visit.page.fill('#frequency', '0.5');
    expect(await text('#modulation-is')).toBe('Mean 100 %, amplitude ±20 % of it (RVA), period 2 s.');
  };
  afterEach(() => {
    mock.layer.modulation = { ...MODULATION };
  });
  it('is set by an operator at once, in bounds and frequency', async () => {
    await as('operator', 'chatter');
    await fill();
    expect(await visit.page.isDisabled('#modulation-into-file')).toBe(true);
    expect(await text('.modulation-panel .why')).toContain('Needs the role engineer');
    await visit.page.click('#set-modulation');
    await until(`document.querySelector('.toasts').textContent.includes('The modulation is set.')`);
    expect(last()).toEqual({ method: 'POST', path: 'modulation', body: SINE });
    await visit.page.reload();
    await until(`document.querySelector('#law')?.value === 'sine'`);
  });
  it('asks first where the layer acts', async () => {
    mock.layer.wanted = 'act';
    await as('operator', 'chatter');
    await fill();
    await visit.page.click('#set-modulation');
    expect(await text('dialog h2')).toBe('Change the spindle speed now?');
    expect(await text('dialog p')).toContain('New modulation: sine. Mean 100 %, amplitude ±20 % of it (RVA), period 2 s.');
    expect(await accessibilityFaults(visit.page)).toEqual([]);
    await visit.page.keyboard.press('Escape');
    await visit.page.waitForSelector('dialog', { state: 'detached' });
    expect(mock.asked).toEqual([]);
    await visit.page.click('#set-modulation');
    await visit.page.click('dialog .strong');
    await visit.page.waitForSelector('dialog', { state: 'detached' });
    await until(`document.querySelector('.toasts').textContent.includes('The modulation is set.')`);
    expect(last()).toEqual({ method: 'POST', path: 'modulation', body: { ...SINE, confirm: true } });
  });
  it('shows why the layer refuses a modulation', async () => {
    await as('operator', 'chatter');
    await visit.page.fill('#lower', '1');
    await visit.page.fill('#upper', '199');
    await visit.page.click('#set-modulation');
    await until(`document.querySelector('.modulation-panel .fault').textContent.includes('allowed: 0 … 0.9')`);
  });
  it('goes into the machine file by an engineer, as it differs from the file', async () => {
    mock.layer.modulation = { law: 'sine', amplitude_ratio: 0.2, mean_ratio: 1, period_s: 2 };
    await as('engineer', 'chatter');
    await fill();
    await visit.page.click('#modulation-into-file');
    await visit.page.click('#review');
    await visit.page.waitForSelector('dialog .diff');
    expect(last()?.body).toEqual({ changes: { 'chatter.law': 'sine', 'chatter.amplitude_percent': 20, 'chatter.mean_percent': 100 } });
  });
  it('tells what makes no modulation', async () => {
    await as('engineer', 'chatter');
    await visit.page.fill('#lower', '130');
    expect(await text('.modulation-panel .fault')).toContain('The lower bound');
    await visit.page.click('#modulation button');
    expect(mock.asked).toEqual([]);
  });
  it('shows how loud it was before the layer stepped in', async () => {
    mock.layer.wanted = 'act';
    await as('viewer', 'chatter');
    await until(`document.querySelector('.vibration .before .value').textContent.includes('92')`);
    await until(`document.querySelector('#chatter-now').textContent === 'The cut chatters at 931\u00a0Hz · Spindle at 90 % against chatter'`);
    mock.layer.wanted = 'observe';
    await until(`document.querySelector('#chatter-now').textContent.endsWith('Better: spindle at 90 %')`);
  });
  it('is changed by somebody else while a button has the keyboard, not while somebody types', async () => {
    await as('operator', 'chatter');
    await visit.page.waitForSelector('#modulation');
    await visit.page.focus('#set-modulation');
    mock.layer.modulation = { ...SINE, law: 'sine' };
    mock.sayHello();
    await until(`document.querySelector('#law').value === 'sine' && document.activeElement.id === 'set-modulation'`);
    await visit.page.fill('#lower', '77');
    mock.layer.modulation = { ...MODULATION };
    mock.sayHello();
    await visit.page.waitForTimeout(400);
    expect(await visit.page.inputValue('#lower')).toBe('77');
  });
  it('asks for the map no longer when another view is open', async () => {
    mock.studied = 0.4;
    await as('viewer', 'now');
    let asked = 0;
    await visit.page.route('**/chatter/lobes', async (route) => {
      asked += 1;
      await new Promise((done) => setTimeout(done, 300));
      await route.continue();
    });
    await visit.page.evaluate(`location.hash = '#/chatter'`);
    await expect.poll(() => asked).toBe(1);
    await show(visit.page, 'now');
    await visit.page.waitForTimeout(1500);
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
    await visit.page.waitForSelector('#measured');
    await visit.page.selectOption('#measured-axis', 'Z');
    await visit.page.fill('#measured-value', '−4,2');
    await visit.page.click('#measured button');
    await until(`document.querySelector('#verdict-of-reading').textContent === 'A probe reading re-zeroed the thermal model.'`);
    expect(last()?.body).toEqual({ axis: 'Z', displacement_um: -4.2, sd_um: 1 });
    await visit.page.fill('#measured-value', '99');
    // What was said of the size before is gone.
    expect(await text('#verdict-of-reading')).toBe('');
    await visit.page.click('#measured button');
    await until(`document.querySelector('#verdict-of-reading').textContent.includes('rejected')`);
    await visit.page.fill('#measured-value', 'much');
    await visit.page.click('#measured button');
    expect(await text('.measured-panel .fault')).toBe('Enter a number.');
  });
  it('is asked about first where the layer acts', async () => {
    mock.layer.wanted = 'act';
    await as('operator', 'thermal');
    await visit.page.waitForSelector('#measured');
    await visit.page.fill('#measured-value', '4');
    await visit.page.click('#measured button');
    expect(await text('dialog p')).toContain('The layer acts on VMC with SINUMERIK 840D. If Y 4.0\u00a0µm is plausible');
    await visit.page.keyboard.press('Escape');
    await visit.page.waitForSelector('dialog', { state: 'detached' });
    expect(mock.asked).toEqual([]);
    await visit.page.click('#measured button');
    await visit.page.click('dialog .strong');
    await until(`document.querySelector('#verdict-of-reading').textContent.includes('re-zeroed')`);
    expect(last()?.body).toEqual({ axis: 'Y', displacement_um: 4, sd_um: 1, confirm: true });
  });
  it('tells how long ago each was, the newest first', async () => {
    await as('viewer', 'thermal');
    await until(`document.querySelectorAll('#readings li').length === 2`);
    const said = await visit.page.$$eval('#readings li', (all) => all.map((e) => e.textContent));
    expect(said[0]).toMatch(/^Z 41\.0\sµm 3\smin ago: .*rejected/);
    expect(said[1]).toMatch(/^Z −3\.9\sµm 16\smin ago: .*re-zeroed/);
  });
  it('that is implausible too often switches the correction off, which both views say', async () => {
    await as('viewer', 'thermal');
    await until(`document.querySelector('.thermal-row') !== null`);
    expect(await visit.page.isHidden('#thermal-off')).toBe(true);
    mock.layer.heatSwitchedOff = true;
    for (const view of ['thermal', 'now']) {
      await show(visit.page, view);
      await until(`document.querySelector('#thermal-off').checkVisibility() && document.querySelector('#thermal-off').textContent.startsWith('Nothing is corrected against heat')`);
    }
    mock.layer.heatSwitchedOff = false;
    await until(`document.querySelector('#thermal-off').hidden`);
  });
});
