// SPDX-License-Identifier: Apache-2.0
// The pages that the thermal verbs wrote, in a real browser, opened from disk.
import { afterAll, describe, expect, it } from 'vitest';
import { fixed, um } from '../../src/frame/numbers';
import { broken } from '../../src/thermal/course';
import { type BatchPage, type FitPage, type ForecastPage, type Page, type PlanPage, type ReplayPage, residual } from '../../src/thermal/data';
import { closeBrowser, haveWritten, openFromDisk, share, written } from './browser';
import { openWritten } from './written';

afterAll(closeBrowser);

describe('what corrections leave of a displacement', () => {
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
  it('has a hole wherever the log has one', () => {
    const curve = broken([0, 1, 2, 50, 51], [1, 2, null, 4, 5]);
    expect(curve.t).toEqual([0, 1, 2, 50, 50, 51]);
    expect(curve.v).toEqual([1, 2, null, null, 4, 5]);
  });
});

const WITHOUT = '#b4501e';
const WITH = '#1b6aa5';
const FOLDERS = { forecast: 'forecast', plan: 'thermal-plan', batch: 'batch/batch', fit: 'thermal-fit', replay: 'replay' };

describe.runIf(haveWritten)('the pages of the thermal verbs', () => {
  const at = openWritten<Page>(FOLDERS);

  it('show both curves of the plan, and its figures', async () => {
    const { open, page } = at<PlanPage>('plan');
    const axis = page.answer.axes[0];
    const less = axis === undefined ? undefined : axis.max_um / axis.residual_um;
    expect(await open.page.textContent('#verdict')).toContain(`${fixed(less, 1)} times less`);
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

  it('say of a forecast whether its uncertainty is known', async () => {
    const { open, page } = at<ForecastPage>('forecast');
    // The paper's passport has no covariance.
    expect(await open.page.textContent('#verdict')).toContain('The passport states no uncertainty.');
    expect(await open.page.textContent('#key-course-0')).not.toContain('95 %');
    const known = structuredClone(page);
    known.courses.forEach((c) => (c.sd_um = c.t_min.map((t) => t / 100)));
    const html = written('forecast').html.replace(/(<script id="report-data"[^>]*>)[^<]*/, (_, head: string) => head + JSON.stringify(known));
    const other = await openFromDisk(html);
    expect(await other.page.textContent('#verdict')).toMatch(/95 % of the errors at the end are within ±5.9\sµm/);
    expect(await other.page.textContent('#key-course-0')).toContain('95 %');
    await other.close();
  });

  it('show each displacement over a temperature, and beside what the model makes of it', async () => {
    const { open, page } = at<FitPage>('fit');
    const axis = page.axes[0] as FitPage['axes'][number];
    const over = axis.over[0] as (typeof axis.over)[number];
    expect(await open.page.textContent('#told-0')).toContain(um(over.spread_um));
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
    // On paper it is said over which temperature, and what that tells.
    const event = (type: string) => open.page.evaluate((t) => window.dispatchEvent(new Event(t)), type);
    await event('beforeprint');
    for (const id of ['sensor-0', 'told-0']) expect(await open.page.locator(`#${id}`).isVisible(), id).toBe(true);
    await event('afterprint');
  });

  it('show the displacement over another temperature when it is chosen', async () => {
    const { page } = at<FitPage>('fit');
    const two = structuredClone(page);
    two.sensors.push('bed_c');
    two.regimes.forEach((r) => r.temperature_c.push(r.t_h.map((t) => 30 + t)));
    two.axes[0]?.over.push({ correlation: -0.25, mean_c: 33, mean_um: 10, slope_um_k: -1, residual_rms_um: 4.5, spread_um: 12.5, spread_at_c: 33, spread_from_um: 5 });
    const html = written('thermal-fit').html.replace(/(<script id="report-data"[^>]*>)[^<]*/, (_, head: string) => head + JSON.stringify(two));
    const other = await openFromDisk(html);
    expect(await other.page.textContent('#told-0')).not.toContain(um(12.5));
    const before = await other.page.locator('#over-0 canvas').screenshot();
    await other.page.selectOption('#sensor-0', '1');
    expect(await other.page.textContent('#told-0')).toContain(um(12.5));
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
    expect(verdict).toContain('No part gets worse');
    expect(await share(open, 'day', WITHOUT)).toBeGreaterThan(0.0005);
    expect(await share(open, 'day', WITH)).toBeGreaterThan(0.0005);
  });
});
