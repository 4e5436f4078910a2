// SPDX-License-Identifier: Apache-2.0
// The page that `steadyrest motion bench` wrote, in a real browser, opened from disk.
import { existsSync, readFileSync } from 'node:fs';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { type Bench, scenes } from '../../src/bench/data';
import { digits, short } from '../../src/bench/format';
import { type OpenPage, openFromDisk } from '../page/browser';

const template = process.env['STEADYREST_MOTION_BENCH_TEMPLATE'];
const written = process.env['STEADYREST_MOTION_BENCH'];

describe('numbers', () => {
  it('have three digits, and a power of ten where they are far from one', () => {
    expect([0.0123456, 1, 12345.6, 0, null, -2.5].map((v) => digits(v))).toEqual(['0.0123', '1.00', '12346', '0', '–', '−2.50']);
    expect(digits(1.234e-7)).toBe('1.23·10⁻⁷');
  });
  it('lose their noughts on axes', () => {
    expect([0.5, 100, 20, 0.0001, 2e-6].map(short)).toEqual(['0.5', '100', '20', '0.0001', '2·10⁻⁶']);
  });
});

describe.runIf(template !== undefined && existsSync(template))('the template', () => {
  it('says how to fill it', async () => {
    const open = await openFromDisk(readFileSync(template as string, 'utf8'));
    expect(await open.page.textContent('#no-data')).toContain('motion bench');
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});

describe.runIf(written !== undefined && existsSync(written))('the page of motion bench', () => {
  const html = written === undefined ? '' : readFileSync(written, 'utf8');
  let open: OpenPage;
  let bench: Bench;
  beforeAll(async () => {
    open = await openFromDisk(html);
    bench = JSON.parse((await open.page.textContent('#report-data')) ?? '') as Bench;
  });
  afterAll(() => open.close());

  it('draws every chart and complains about nothing', async () => {
    const drawn = await open.page.evaluate(() =>
      [...document.querySelectorAll<HTMLCanvasElement>('.panel canvas')].map((canvas) => {
        const pixels = canvas.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
        const seen = new Set<number>();
        for (let i = 0; i + 2 < pixels.length; i += 4) {
          seen.add(((pixels[i] ?? 0) << 16) | ((pixels[i + 1] ?? 0) << 8) | (pixels[i + 2] ?? 0));
        }
        return seen.size;
      }),
    );
    expect(drawn.length).toBe(14);
    drawn.forEach((colours, i) => expect(colours, `chart ${i}`).toBeGreaterThan(20));
    expect(open.complaints).toEqual([]);
  });

  it('shows a row for each of the JSON, with its RMS', async () => {
    for (const quantity of ['velocity', 'acceleration'] as const) {
      await open.page.click(`#results-of button[data-value="${quantity}"]`);
      const shown = await open.page.locator('#results tbody tr td:nth-of-type(1)').allTextContents();
      expect(shown).toEqual(bench.rows.map((r) => digits(r[quantity].rms)));
    }
  });

  it('switches the scene of the lag', async () => {
    for (const scene of scenes(bench)) {
      await open.page.click(`#scene button[data-value="${scene}"]`);
      expect(await open.page.textContent('#key-lag')).toContain('kalman + limits');
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

  it('fits a narrow window', async () => {
    await open.page.setViewportSize({ width: 400, height: 800 });
    const overflow = await open.page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    expect(overflow).toBeLessThanOrEqual(0);
  });
});
