// SPDX-License-Identifier: Apache-2.0
// The pages that the chatter verbs wrote, in a real browser, opened from disk.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import type { DetectPage, GrowthPage, LobesPage, Page, PlanPage, SimulatePage } from '../../src/chatter/data';
import { plain } from '../../src/chatter/frame';
import { choiceText } from '../../src/chatter/plan';
import { fixed } from '../../src/format';
import { type OpenPage, openFromDisk } from '../page/browser';

const template = process.env['STEADYREST_CHATTER_TEMPLATE'];
const written = process.env['STEADYREST_CHATTER'];

describe.runIf(template !== undefined && existsSync(template))('the template', () => {
  it('says how to fill it', async () => {
    const open = await openFromDisk(readFileSync(template as string, 'utf8'));
    expect(await open.page.textContent('#no-data')).toContain('chatter');
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});

/** Distinct colours of each plot, to tell a drawing from an empty area. */
function colours(open: OpenPage): Promise<number[]> {
  return open.page.evaluate(() =>
    [...document.querySelectorAll<HTMLCanvasElement>('.plot canvas')].map((canvas) => {
      const pixels = canvas.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
      const seen = new Set<number>();
      for (let i = 0; i + 2 < pixels.length; i += 4) {
        seen.add(((pixels[i] ?? 0) << 16) | ((pixels[i + 1] ?? 0) << 8) | (pixels[i + 2] ?? 0));
      }
      return seen.size;
    }),
  );
}

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

const PLOTS: Record<string, number> = { lobes: 1, modulated: 1, growth: 2, simulate: 6, detect: 3, plan: 1 };

describe.runIf(written !== undefined && existsSync(written))('the pages of the chatter verbs', () => {
  const opened = new Map<string, { open: OpenPage; page: Page }>();
  const at = <T extends Page>(name: string): { open: OpenPage; page: T } => opened.get(name) as { open: OpenPage; page: T };

  beforeAll(async () => {
    for (const name of Object.keys(PLOTS)) {
      const open = await openFromDisk(readFileSync(join(written as string, name, 'report.html'), 'utf8'));
      opened.set(name, { open, page: JSON.parse(readFileSync(join(written as string, name, 'report.json'), 'utf8')) as Page });
    }
  });
  afterAll(async () => {
    for (const { open } of opened.values()) {
      await open.close();
    }
  });

  it('draw every plot and complain about nothing', async () => {
    for (const [name, plots] of Object.entries(PLOTS)) {
      const seen = await colours(at(name).open);
      expect(seen.length, name).toBe(plots);
      seen.forEach((count, i) => expect(count, `${name} ${i}`).toBeGreaterThan(20));
      expect(at(name).open.complaints, name).toEqual([]);
    }
  });

  it('hold what report.json says', async () => {
    for (const name of Object.keys(PLOTS)) {
      const { open, page } = at(name);
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

  it('show lobes: the wanted cut with its radius and frequency, a row for each override step', async () => {
    const { open, page } = at<LobesPage>('lobes');
    const verdict = (await open.page.textContent('#verdict')) ?? '';
    expect(verdict).toContain(plain(page.answer.point?.spectral_radius));
    expect(verdict).toContain(`${fixed(page.answer.point?.frequency_hz, 1)} Hz`);
    const rows = await open.page.locator('#steps tbody tr').allTextContents();
    expect(rows.length).toBe(page.steps.length);
    expect(rows.filter((r) => r.includes('too deep')).length).toBe(page.steps.filter((s) => s.limit_depth_mm !== null && s.limit_depth_mm <= 1).length);
    expect(await open.page.textContent('#key-lobes')).toContain('zero-order sketch');
    // Both sides of the border have their colours.
    expect(await share(open, 'lobes', '#b0d2e7')).toBeGreaterThan(0.003);
    expect(await share(open, 'lobes', '#f5b27c')).toBeGreaterThan(0.01);
  });

  it('say under the pointer how stable a point is', async () => {
    const { open } = at<LobesPage>('lobes');
    const tip = open.page.locator('#lobes .tip');
    await open.page.locator('#lobes').hover({ position: { x: 300, y: 80 } });
    expect(await tip.textContent()).toMatch(/rev\/min.*ρ [\d.]+: unstable/);
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
    expect(figures).toContain(`${fixed(page.answer.peak_um, 2)} µm`);
    expect(figures).toContain(`${fixed(page.answer.chatter_frequency_hz, 1)} Hz`);
  });

  it('show the recording: each stretch of chatter, and the orders that are asked for', async () => {
    const { open, page } = at<DetectPage>('detect');
    const rows = await open.page.locator('#events tbody tr').allTextContents();
    expect(rows.length).toBe(page.answer.events.length);
    expect(rows[0]).toContain(fixed(page.answer.events[0]?.frequency_hz, 1));
    await open.page.click('#orders button[data-value="spindle"]');
    expect(await open.page.textContent('#key-detect')).toContain('spindle frequency');
    await open.page.click('#orders button[data-value="none"]');
    expect(await open.page.textContent('#key-detect')).not.toContain('multiples');
    expect(open.complaints).toEqual([]);
  });

  it('show the plan: a row for each alternative, the chosen one marked', async () => {
    const { open, page } = at<PlanPage>('plan');
    expect(await open.page.locator('#alternatives tbody tr').count()).toBe(page.answer.alternatives.length);
    expect(await open.page.locator('#alternatives tr.chosen td:first-child').allTextContents()).toEqual([choiceText(page.answer)]);
    expect(await open.page.textContent('#verdict')).toContain('110 % = 5500 rev/min');
  });
});

describe.runIf(written !== undefined && existsSync(written))('in the dark', () => {
  it('the lobes are drawn on dark paper', async () => {
    const open = await openFromDisk(readFileSync(join(written as string, 'lobes', 'report.html'), 'utf8'), { colorScheme: 'dark' });
    expect(await share(open, 'lobes', '#7a4626')).toBeGreaterThan(0.01);
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});
