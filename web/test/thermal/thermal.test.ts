// SPDX-License-Identifier: Apache-2.0
// The pages that the thermal verbs wrote, in a real browser, opened from disk.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import { fixed } from '../../src/format';
import { type BatchPage, type FitPage, type Page, type PlanPage, type ReplayPage, residual } from '../../src/thermal/data';
import { broken } from '../../src/thermal/course';
import { type OpenPage, openFromDisk } from '../page/browser';

const template = process.env['STEADYREST_THERMAL_TEMPLATE'];
const written = process.env['STEADYREST_THERMAL'];

describe('what is left of a displacement', () => {
  it('jumps where a correction is made, and has both values there', () => {
    const left = residual({
      axis: 'Z',
      t_min: [0, 10, 20],
      displacement_um: [0, 10, 20],
      sd_um: [0, 0, 0],
      corrections: [{ t_min: 5, delta_um: 4, total_um: 4 }],
      bands: [],
    });
    expect(left.t_min).toEqual([0, 5, 5, 10, 20]);
    expect(left.um).toEqual([0, 5, 1, 6, 16]);
  });
});

describe('a curve over time', () => {
  it('has a hole where time has passed that is not recorded', () => {
    const curve = broken([0, 1, 2, 50, 51], [1, 2, null, 4, 5]);
    expect(curve.t).toEqual([0, 1, 2, 50, 50, 51]);
    expect(curve.v).toEqual([1, 2, null, null, 4, 5]);
  });
});

describe.runIf(template !== undefined && existsSync(template))('the template', () => {
  it('says how to fill it', async () => {
    const open = await openFromDisk(readFileSync(template as string, 'utf8'));
    expect(await open.page.textContent('#no-data')).toContain('thermal');
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});

/** Share of a plot's pixels that are near to this colour. */
function share(open: OpenPage, id: string, colour: string): Promise<number> {
  return open.page.evaluate(
    ([where, wanted]) => {
      const canvas = document.querySelector<HTMLCanvasElement>(`#${where} canvas`);
      const pixels = canvas?.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
      const rgb = [1, 3, 5].map((i) => Number.parseInt((wanted as string).slice(i, i + 2), 16));
      let found = 0;
      for (let i = 0; i + 2 < pixels.length; i += 4) {
        found += rgb.every((c, k) => Math.abs(c - (pixels[i + k] ?? 0)) < 6) ? 1 : 0;
      }
      return (4 * found) / Math.max(pixels.length, 1);
    },
    [id, colour],
  );
}

const WITHOUT = '#b4501e';
const WITH = '#1b6aa5';
const FOLDERS: Record<string, string> = { forecast: 'forecast', plan: 'plan', batch: 'cut/batch', fit: 'fit', replay: 'replay' };
const PLOTS: Record<string, number> = { forecast: 2, plan: 3, batch: 4, fit: 4, replay: 3 };

describe.runIf(written !== undefined && existsSync(written))('the pages of the thermal verbs', () => {
  const opened = new Map<string, { open: OpenPage; page: Page }>();
  const at = <T extends Page>(name: string): { open: OpenPage; page: T } => opened.get(name) as { open: OpenPage; page: T };

  beforeAll(async () => {
    for (const [name, folder] of Object.entries(FOLDERS)) {
      const where = join(written as string, folder);
      const open = await openFromDisk(readFileSync(join(where, 'report.html'), 'utf8'));
      opened.set(name, { open, page: JSON.parse(readFileSync(join(where, 'report.json'), 'utf8')) as Page });
    }
  });
  afterAll(async () => {
    for (const { open } of opened.values()) {
      await open.close();
    }
  });

  it('draw every plot, complain about nothing and hold what report.json says', async () => {
    for (const [name, plots] of Object.entries(PLOTS)) {
      const { open, page } = at(name);
      expect(await open.page.locator('.plot canvas').count(), name).toBe(plots);
      expect(open.complaints, name).toEqual([]);
      expect(JSON.parse((await open.page.textContent('#report-data')) ?? ''), name).toEqual(page);
    }
  });

  it('fit a window of 390 pixels and one of 1280, and go back', async () => {
    for (const name of Object.keys(PLOTS)) {
      const { open } = at(name);
      for (const width of [390, 1280]) {
        await open.page.setViewportSize({ width, height: 900 });
        await open.page.waitForFunction((w) => (document.querySelector('.plot canvas')?.clientWidth ?? 1e9) <= w, width);
        const overflow = await open.page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
        expect(overflow, `${name} ${width}`).toBeLessThanOrEqual(0);
      }
    }
  });

  it('show both curves of the plan, and its figures', async () => {
    const { open, page } = at<PlanPage>('plan');
    expect(await open.page.textContent('#verdict')).toContain(`${fixed(page.answer.axes[0]?.ratio, 1)} times less`);
    for (const colour of [WITHOUT, WITH]) {
      expect(await share(open, 'course-0', colour)).toBeGreaterThan(0.0005);
      expect(await share(open, 'line-0', colour)).toBeGreaterThan(0.0005);
    }
    // The paper's corrections: 18, 45, 75 and 115 min.
    expect(page.courses[0]?.corrections.map((c) => c.t_min)).toEqual([18, 45, 75, 115]);
    const left = residual(page.courses[0] as PlanPage['courses'][number]);
    expect(Math.max(...left.um)).toBeLessThan(10.2);
    const rows = await open.page.locator('#system-Z tbody tr').allTextContents();
    expect(rows).toHaveLength(5);
    expect(rows[0]).toContain('18, 27, 15');
    expect(rows[0]).toContain('0, 10, 10');
    // The paper's passport has no covariance.
    expect(await open.page.textContent('#figures')).toContain('not stated');
  });

  it('show each displacement over a temperature, and beside what the model makes of it', async () => {
    const { open, page } = at<FitPage>('fit');
    const axis = page.axes[0] as FitPage['axes'][number];
    const over = axis.over[0] as (typeof axis.over)[number];
    expect(await open.page.textContent('#told-0')).toContain(`${fixed(over.spread_um, 1)} µm`);
    expect(await open.page.textContent('#verdict')).toContain(fixed(page.answer.axes[0]?.rms_um, 2));
    expect(await open.page.locator('#figures tbody tr').count()).toBe(1);
    expect(axis.t_h.length).toBe(axis.modelled_um.length);
    for (const colour of [WITHOUT, WITH]) {
      expect(await share(open, 'course-0', colour)).toBeGreaterThan(0.0005);
    }
    expect(await share(open, 'residual-0', WITHOUT)).toBeGreaterThan(0.0005);
    // The fastest regime's and the slowest's.
    for (const colour of ['#3b6fb5', '#9c2c6d']) {
      expect(await share(open, 'over-0', colour)).toBeGreaterThan(0.0005);
    }
  });

  it('show the displacement over another temperature when it is chosen', async () => {
    const { page } = at<FitPage>('fit');
    const two = structuredClone(page);
    two.sensors.push('bed_c');
    two.regimes.forEach((r) => r.temperature_c.push(r.t_h.map((t) => 30 + t)));
    two.axes[0]?.over.push({ correlation: -0.25, mean_c: 33, mean_um: 10, slope_um_k: -1, residual_rms_um: 4.5, spread_um: 12.5, spread_at_c: 33, spread_from_um: 5 });
    const html = readFileSync(join(written as string, 'fit', 'report.html'), 'utf8').replace(/(<script id="report-data"[^>]*>)[^<]*/, (_, head: string) => head + JSON.stringify(two));
    const other = await openFromDisk(html);
    expect(await other.page.textContent('#told-0')).not.toContain('12.5 µm');
    const before = await other.page.locator('#over-0 canvas').screenshot();
    await other.page.selectOption('#sensor-0', '1');
    expect(await other.page.textContent('#told-0')).toContain('12.5 µm');
    expect((await other.page.locator('#over-0 canvas').screenshot()).equals(before)).toBe(false);
    expect(other.complaints).toEqual([]);
    await other.close();
  });

  it('show a recorded log beside what the passport forecasts', async () => {
    const { open, page } = at<ReplayPage>('replay');
    expect(await open.page.textContent('#verdict')).toContain(`${fixed(page.answer.axes[0]?.rms_um, 2)}`);
    const axis = page.axes[0] as ReplayPage['axes'][number];
    expect(axis.fitted_to_h).toBeCloseTo(250 / 60, 2);
    for (const colour of [WITHOUT, WITH]) {
      expect(await share(open, 'course-0', colour)).toBeGreaterThan(0.0005);
    }
  });

  it('show the batch: how many times smaller, and no part worse', async () => {
    const { open, page } = at<BatchPage>('batch');
    const verdict = (await open.page.textContent('#verdict')) ?? '';
    expect(verdict).toContain(`${fixed(page.answer.online.improvement, 1)} times`);
    expect(verdict).toContain('no part is worse');
    expect(await share(open, 'day', WITHOUT)).toBeGreaterThan(0.0005);
    expect(await share(open, 'day', WITH)).toBeGreaterThan(0.0005);
  });
});
