// SPDX-License-Identifier: Apache-2.0
// The built page in a real browser, opened from disk without server or network.
import { existsSync, readFileSync } from 'node:fs';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import type { Report } from '../../src/data';
import { figureRows, motionRows } from '../../src/format';
import { emptyReport, makeReport } from '../fixture';
import { type OpenPage, fill, openFromDisk, template } from './browser';

/** Count of distinct colours in a chart's canvas, to tell a drawing from an empty area. */
function colours(page: Page, selector: string): Promise<number> {
  return page.evaluate((s) => {
    const canvas = document.querySelector<HTMLCanvasElement>(`${s} canvas`);
    const pixels = canvas?.getContext('2d')?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
    const seen = new Set<number>();
    for (let i = 0; i + 2 < pixels.length; i += 4) {
      seen.add(((pixels[i] ?? 0) << 16) | ((pixels[i + 1] ?? 0) << 8) | (pixels[i + 2] ?? 0));
    }
    return seen.size;
  }, selector);
}

async function text(page: Page, selector: string): Promise<string> {
  return (await page.textContent(selector)) ?? '';
}

async function expectFigures(page: Page, report: Report): Promise<void> {
  for (const row of figureRows(report.without.figures, report.with.figures)) {
    const cells = await page.locator(`#figures tr[data-key="${row.key}"] td`).allTextContents();
    expect(cells.map((c) => c.trim())).toEqual([row.without, row.with, row.change]);
  }
}

async function expectMotion(page: Page, report: Report): Promise<void> {
  const rows = await page.locator('#motion tbody tr').allTextContents();
  expect(rows.map((r) => r.replace(/\s+/g, ' ').trim())).toEqual(
    motionRows(report.motion).map((r) => `${r.axis}, ${r.quantity}${r.difference} ${r.estimate}${r.finer}${r.coverage}`.replace(/\s+/g, ' ')),
  );
}

describe('a report with data', () => {
  const report = makeReport(16_000);
  report.program = '<b>&"pocket"</script>.ngc';
  let open: OpenPage;
  beforeAll(async () => {
    open = await openFromDisk(fill(report));
  });
  afterAll(() => open.close());

  it('draws its charts and complains about nothing', async () => {
    for (const chart of ['#path-without', '#path-with', '#course']) {
      expect(await colours(open.page, chart), chart).toBeGreaterThan(20);
    }
    expect(open.complaints).toEqual([]);
  });

  it('shows the figures of the JSON', () => expectFigures(open.page, report));

  it('shows what became of the readings of the probe', async () => {
    const rows = await open.page.locator('#probes tbody tr').allTextContents();
    expect(rows).toHaveLength(1);
    expect(rows[0]).toContain('2.94');
    expect(rows[0]).toContain('thermal_reading_taken');
  });

  it('shows what the estimates of the motion were worth', async () => {
    await expectMotion(open.page, report);
    expect(await open.page.locator('#motion tbody tr').count()).toBe(4);
  });

  it('shows text from outside as text', async () => {
    expect(await text(open.page, 'h1')).toBe(report.program);
    expect(await open.page.title()).toContain(report.program);
  });

  it('opens with what the layer was worth', async () => {
    const worth = await text(open.page, '.worth[data-key="contour_error_max_mm"]');
    expect(worth).toContain(`${(report.without.figures.contour_error_max_mm * 1000).toFixed(1)} µm`);
    expect(worth).toContain(`${(report.with.figures.contour_error_max_mm * 1000).toFixed(1)} µm`);
  });

  it('lists the worst lines in the order of the JSON', async () => {
    const lines = await open.page.locator('#worst tbody tr td:first-child').allTextContents();
    expect(lines.map(Number)).toEqual(report.worst_lines.map((w) => w.line));
  });

  it('names line and value under the pointer', async () => {
    const at = await open.page.evaluate(() => {
      const [chart] = (window as unknown as { steadyrestCharts: { paths: { convertToPixel(f: object, p: number[]): number[] }[] } })
        .steadyrestCharts.paths;
      return chart?.convertToPixel({ gridIndex: 0 }, [17, 0.5]) ?? [0, 0];
    });
    await open.page.locator('#path-without').hover({ position: { x: at[0] ?? 0, y: at[1] ?? 0 } });
    const tip = open.page.locator('#path-without .tip');
    expect(await tip.isVisible()).toBe(true);
    expect(await tip.textContent()).toMatch(/Line \d+contour error [−\d.]+ µm/);
  });

  it('keeps one millimetre as long across as up in every view', async () => {
    for (const plane of ['xz', 'yz', 'xy']) {
      await open.page.click(`#plane button[data-value="${plane}"]`);
      const [dx, dy] = await open.page.evaluate(() => {
        const [chart] = (window as unknown as { steadyrestCharts: { paths: { convertToPixel(f: object, p: number[]): number[] }[] } })
          .steadyrestCharts.paths;
        const [ax = 0, ay = 0] = chart?.convertToPixel({ gridIndex: 0 }, [0, 0]) ?? [];
        const [bx = 0, by = 0] = chart?.convertToPixel({ gridIndex: 0 }, [10, 10]) ?? [];
        return [bx - ax, ay - by];
      });
      expect(dx).toBeGreaterThan(1);
      expect((dx ?? 0) / (dy ?? 1)).toBeCloseTo(1, 2);
    }
  });

  it('switches the abscissa between time and path length', async () => {
    const name = () =>
      open.page.evaluate(() => {
        const { course } = (window as unknown as { steadyrestCharts: { course: { getOption(): { xAxis: { name: string; max: number }[] } } } })
          .steadyrestCharts;
        return course.getOption().xAxis.at(-1)?.name;
      });
    expect(await name()).toBe('time in s');
    await open.page.click('#abscissa button[data-value="path_mm"]');
    expect(await name()).toBe('path length in mm');
    expect(open.complaints).toEqual([]);
  });

  it('fits a narrow window', async () => {
    await open.page.setViewportSize({ width: 400, height: 800 });
    await open.page.waitForFunction(() => (document.querySelector('#course canvas')?.clientWidth ?? 1e9) <= 400);
    const overflow = await open.page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    expect(overflow).toBeLessThanOrEqual(0);
  });
});

describe('a report of 200 000 samples', () => {
  it('opens within seconds and keeps a lone spike in view', async () => {
    const report = makeReport(200_000);
    const spike = 100_003;
    report.with.trace.cutting[spike] = 1;
    report.with.trace.contour_error_um[spike] = 321.5;
    const start = Date.now();
    const open = await openFromDisk(fill(report));
    const shown = await open.page.evaluate(() => {
      const { course } = (window as unknown as { steadyrestCharts: { course: { getOption(): { series: { id: string; data: [number, number][] }[] } } } })
        .steadyrestCharts;
      return course.getOption().series.find((s) => s.id === 'with-0')?.data.map((p) => p[1]) ?? [];
    });
    expect(shown).toContain(321.5);
    expect(shown.length).toBeLessThan(10_000);
    expect(Date.now() - start).toBeLessThan(30_000);
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});

describe('a report without a cut, and no report', () => {
  it('says that there is nothing to compare', async () => {
    const open = await openFromDisk(fill(emptyReport()));
    expect(await text(open.page, '#verdict')).toContain('does not cut');
    expect(open.complaints).toEqual([]);
    await open.close();
  });
  it('says how to fill it', async () => {
    const open = await openFromDisk(template());
    expect(await text(open.page, '#no-data')).toContain('no data');
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});

describe('the dark scheme', () => {
  it('draws on dark paper', async () => {
    const open = await openFromDisk(fill(makeReport(2000)), { colorScheme: 'dark' });
    expect(await open.page.evaluate(() => getComputedStyle(document.body).backgroundColor)).toBe('rgb(20, 24, 29)');
    expect(await colours(open.page, '#path-with')).toBeGreaterThan(10);
    await open.close();
  });
});

/** A report that the C++ side wrote, when the caller names one. */
const written = process.env['STEADYREST_REPORT'];
describe.runIf(written !== undefined && existsSync(written))('the report that steadyrest wrote', () => {
  it('shows the figures of its report.json', async () => {
    const path = written as string;
    const report = JSON.parse(readFileSync(path.replace(/html$/, 'json'), 'utf8')) as Report;
    const open = await openFromDisk(readFileSync(path, 'utf8'));
    await expectFigures(open.page, report);
    await expectMotion(open.page, report);
    expect(await text(open.page, 'h1')).toBe(report.program);
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});
