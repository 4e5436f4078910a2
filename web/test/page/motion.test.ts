// SPDX-License-Identifier: Apache-2.0
// The pages that the motion verbs wrote, in a real browser, opened from disk.
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { type Bench, scenes } from '../../src/motion/data';
import { digits, short } from '../../src/frame/numbers';
import { type OpenPage, closeBrowser, haveWritten, openFromDisk, writtenHtml } from './browser';

afterAll(closeBrowser);

describe('numbers', () => {
  it('have three digits, and a power of ten where they are far from one', () => {
    expect([0.0123456, 1, 12345.6, 0, null, -2.5].map((v) => digits(v))).toEqual(['0.0123', '1.00', '12346', '0', '–', '−2.50']);
    expect(digits(1.234e-7)).toBe('1.23·10⁻⁷');
  });
  it('lose their noughts on axes', () => {
    expect([0.5, 100, 20, 0.0001, 2e-6].map(short)).toEqual(['0.5', '100', '20', '0.0001', '2·10⁻⁶']);
  });
});

describe.runIf(haveWritten)('the page of motion bench', () => {
  let open: OpenPage;
  let bench: Bench;
  beforeAll(async () => {
    open = await openFromDisk(writtenHtml('bench'));
    bench = JSON.parse((await open.page.textContent('#report-data')) ?? '') as Bench;
  });
  afterAll(() => open.close());

  it('shows a row for each of the JSON, with its RMS', async () => {
    for (const quantity of ['velocity', 'acceleration'] as const) {
      await open.page.click(`#results-of button[data-value="${quantity}"]`);
      const shown = await open.page.locator('#results tbody tr td:nth-of-type(2)').allTextContents();
      expect(shown).toEqual(bench.rows.map((r) => digits(r[quantity].rms)));
    }
  });

  it('switches the scene of the lag', async () => {
    for (const scene of scenes(bench)) {
      await open.page.click(`#scene button[data-value="${scene}"]`);
      expect(await open.page.textContent('#key-lag-0')).toContain('kalman + limits');
      expect(await open.page.textContent('#what')).toBe(bench.scenes.find((s) => s.name === scene)?.what);
    }
  });

  it('shows the requirement that is chosen', async () => {
    await open.page.click('#quantity button[data-value="a"]');
    await open.page.click('#end button[data-value="fine"]');
    await open.page.click('#judge button[data-value="guaranteed"]');
    await open.page.click('#cycle button[data-value="2500"]');
    expect(await open.page.textContent('#requirement caption')).toContain('6.25 mm/s²');
    const chosen = bench.requirement.filter((r) => r.acceleration && r.fine && r.jerk_mm_s3 === 5000 && r.cycle_hz === 2500);
    for (const verdict of ['met', 'forbidden', 'missed']) {
      const cells = await open.page.locator(`#requirement td.${verdict}`).count();
      expect(cells, verdict).toBe(chosen.filter((r) => r.guaranteed === verdict).length);
    }
  });
});
