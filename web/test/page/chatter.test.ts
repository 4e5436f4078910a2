// SPDX-License-Identifier: Apache-2.0
// The pages that the chatter verbs wrote, in a real browser, opened from disk.
import { readFile } from 'node:fs/promises';
import { afterAll, describe, expect, it } from 'vitest';
import type { DetectPage, FitPage, GrowthPage, LobesPage, Page, PlanPage, SimulatePage } from '../../src/chatter/data';
import { choiceText } from '../../src/chatter/plan';
import { fixed, hertz, measure, plain, rpm, um } from '../../src/frame/numbers';
import { closeBrowser, haveWritten, openFromDisk, share, written } from './browser';
import { openWritten } from './written';

afterAll(closeBrowser);

const FOLDERS = { lobes: 'lobes', growth: 'growth', simulate: 'simulate', detect: 'detect', plan: 'chatter-plan', tap: 'tap' };

describe.runIf(haveWritten)('the pages of the chatter verbs', () => {
  const at = openWritten<Page>(FOLDERS);

  it('show lobes: the requested cut with its radius and frequency, a row for each override step', async () => {
    const { open, page } = at<LobesPage>('lobes');
    const verdict = (await open.page.textContent('#verdict')) ?? '';
    expect(verdict).toContain(plain(page.answer.point?.spectral_radius));
    expect(verdict).toContain(hertz(page.answer.point?.frequency_hz));
    const rows = await open.page.locator('#steps tbody tr').allTextContents();
    expect(rows.length).toBe(page.steps.length);
    expect(rows.filter((r) => r.includes('chatters')).length).toBe(page.steps.filter((s) => s.limit_depth_mm !== null && s.limit_depth_mm <= 1).length);
    expect(await open.page.textContent('#key-lobes')).toContain('zero-order sketch');
    // Both sides of the border have their colours.
    expect(await share(open, 'lobes', '#b0d2e7')).toBeGreaterThan(0.003);
    expect(await share(open, 'lobes', '#f5b27c')).toBeGreaterThan(0.01);
  });

  it('say under the pointer how stable a point is', async () => {
    const { open } = at<LobesPage>('lobes');
    const tip = open.page.locator('#lobes .tip');
    await open.page.locator('#lobes').hover({ position: { x: 300, y: 60 } });
    expect(await tip.textContent()).toMatch(/rpm.*ρ [\d.]+: unstable/);
    await open.page.locator('#lobes').hover({ position: { x: 300, y: 455 } });
    expect(await tip.textContent()).toMatch(/ρ 0\.\d+: stable/);
  });

  it('show growth: its peak, in words and figures', async () => {
    const { open, page } = at<GrowthPage>('growth');
    expect(await open.page.textContent('#verdict')).toContain(`${plain(page.answer.peak_growth, 3)}-fold`);
    expect(await open.page.textContent('#figures')).toContain(plain(page.answer.log_radius, 6));
    expect(await share(open, 'growth', '#b4501e')).toBeGreaterThan(0.0005);
  });

  it('show the cut: figures of the answer', async () => {
    const { open, page } = at<SimulatePage>('simulate');
    const figures = (await open.page.textContent('#figures')) ?? '';
    expect(figures).toContain(um(page.answer.peak_um, 2));
    expect(figures).toContain(hertz(page.answer.chatter_frequency_hz));
  });

  it('show the recording: where it chatters, and the chosen orders', async () => {
    const { open, page } = at<DetectPage>('detect');
    const rows = await open.page.locator('#events tbody tr').allTextContents();
    expect(rows.length).toBe(page.answer.events.length);
    expect(rows[0]).toContain(fixed(page.answer.events[0]?.frequency_hz, 1));
    await open.page.click('#orders button[data-value="spindle"]');
    expect(await open.page.textContent('#key-spectrogram')).toContain('spindle frequency');
    await open.page.click('#orders button[data-value="none"]');
    expect(await open.page.textContent('#key-spectrogram')).not.toContain('multiples');
    expect(open.complaints).toEqual([]);
  });

  it('show the plan: a row for each alternative, the chosen one marked', async () => {
    const { open, page } = at<PlanPage>('plan');
    expect(await open.page.locator('#alternatives tbody tr').count()).toBe(page.answer.alternatives.length);
    expect(await open.page.locator('#alternatives tr.chosen th:first-child').allTextContents()).toEqual([choiceText(page.answer)]);
    const verdict = (await open.page.textContent('#verdict')) ?? '';
    expect(verdict).toContain(`110\u00a0% = ${rpm(5500)}`);
    // What the programmed speed would do, and what is gained.
    expect(verdict).toContain(`the cut chatters at ${hertz(page.answer.chatter_frequency_hz)}`);
    expect(verdict).toContain(measure(page.answer.limit_depth_mm, 3, 'mm'));
    expect(await open.page.locator('#notes li').count()).toBe(page.answer.notes.length);
    expect(await open.page.locator('#best-speeds tbody tr').count()).toBe(page.answer.best_speeds.length);
  });

  it('show a border of any number of points, its cusps included', async () => {
    const { page } = at<LobesPage>('lobes');
    const many = structuredClone(page);
    const n = 12_000;
    const [from = 0, to = 1] = [page.map.speed_rpm[0], page.map.speed_rpm.at(-1)];
    many.border.speed_rpm = Array.from({ length: n }, (_, i) => from + ((to - from) * i) / (n - 1));
    many.border.depth_mm = many.border.speed_rpm.map((_, i) => (i === 7001 ? 3.9 : 0.6 + 0.2 * Math.sin(i / 300)));
    const html = written('lobes').html.replace(/(<script id="report-data"[^>]*>)[^<]*/, (_, head: string) => head + JSON.stringify(many));
    const open = await openFromDisk(html);
    const shown = await open.page.evaluate(() => {
      const { chart } = (window as unknown as { steadyrestPlot: (id: string) => { chart: { getOption(): { series: { type: string; data: [number, number][] }[] } } } }).steadyrestPlot('lobes');
      return chart.getOption().series.filter((s) => s.type === 'line').map((s) => s.data.map((p) => p[1]));
    });
    const border = shown.find((values) => values.includes(3.9));
    expect(border).toBeDefined();
    expect(border?.length).toBeLessThanOrEqual(3 * 1500);
    expect(open.complaints).toEqual([]);
    await open.close();
  });

  it('show the tap test: measured and fitted in magnitude, phase, real and imaginary part', async () => {
    const { open, page } = at<FitPage>('tap');
    expect(await open.page.textContent('#verdict')).toContain(fixed(page.answer.modes[0]?.frequency_hz, 1));
    for (const id of ['magnitude', 'phase', 'real', 'imaginary', 'circle']) {
      expect(await open.page.textContent(`#key-${id}`), id).toMatch(/tap-922hz.*fitted|fitted.*tap-922hz/s);
      expect(await share(open, id, '#b4501e'), id).toBeGreaterThan(0.0005);
      expect(await share(open, id, '#1b6aa5'), id).toBeGreaterThan(0.0005);
    }
    expect(await open.page.locator('#modes tbody tr').count()).toBe(page.answer.modes.length);
    // The magnitude is on whole decades; pointer, zoom and CSV keep the true values.
    const { low, high, names } = await open.page.evaluate(() => {
      type Plotted = { steadyrestPlot: (id: string) => { chart: { getModel(): { getComponent(name: string): { axis: { scale: { getExtent(): [number, number] } } } } }; plot: { layers: { name?: string }[] } } };
      const { chart, plot } = (window as unknown as Plotted).steadyrestPlot('magnitude');
      const [from, to] = chart.getModel().getComponent('yAxis').axis.scale.getExtent();
      return { low: from, high: to, names: plot.layers.map((l) => l.name ?? '') };
    });
    const magnitudes = page.measured.flatMap((m) => m.real_um_N.map((v, i) => Math.hypot(v ?? 0, m.imag_um_N[i] ?? 0)));
    expect([low, high]).toEqual([Math.floor(Math.log10(Math.min(...magnitudes))), Math.ceil(Math.log10(Math.max(...magnitudes)))]);
    expect(names).toContain('fitted');
    const box = await open.page.locator('#magnitude').boundingBox();
    await open.page.locator('#magnitude').hover({ position: { x: (box?.width ?? 0) / 2, y: 100 } });
    const tip = (await open.page.locator('#magnitude .tip').innerText()).split('\n');
    const pointed = Number(/[\d.]+$/.exec(tip[0] ?? '')?.[0]);
    const nearest = page.measured[0]?.frequency_hz.reduce((best, f, i, all) => (Math.abs(f - pointed) < Math.abs((all[best] ?? 0) - pointed) ? i : best), 0) ?? 0;
    expect(tip.find((line) => line.startsWith('tap-922hz'))).toContain(plain(magnitudes[nearest]));
    const [download] = await Promise.all([open.page.waitForEvent('download'), open.page.click('#magnitude-frame [data-tool="csv"]')]);
    const csv = (await readFile(await download.path(), 'utf8')).split('\n');
    expect(Number(csv[1]?.split(',')[1])).toBeCloseTo(magnitudes[0] ?? NaN, 9);
    // What is fitted lies on what was measured, within a few per cent of the peak.
    const peak = Math.max(...page.measured.flatMap((m) => m.real_um_N.map((v, i) => Math.hypot(v ?? 0, m.imag_um_N[i] ?? 0))));
    const fitted = Math.max(...page.fitted.real_um_N.map((v, i) => Math.hypot(v ?? 0, page.fitted.imag_um_N[i] ?? 0)));
    expect(fitted / peak).toBeGreaterThan(0.9);
    expect(fitted / peak).toBeLessThan(1.1);
  });
});

describe.runIf(haveWritten)('in the dark', () => {
  it('the lobes are drawn on dark paper', async () => {
    const open = await openFromDisk(written('lobes').html, { colorScheme: 'dark' });
    expect(await share(open, 'lobes', '#7a4626')).toBeGreaterThan(0.01);
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});
