// SPDX-License-Identifier: Apache-2.0
// The built page in a real browser, opened from disk without server or network.
import { readFile } from 'node:fs/promises';
import { inflateSync } from 'node:zlib';
import type { Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, it } from 'vitest';
import type { Report } from '../../src/cut/data';
import { figureRows, micrometres, motionRows } from '../../src/cut/figures';
import { errorClasses } from '../../src/cut/scale';
import { emptyReport, makeReport } from '../fixture';
import { type OpenPage, closeBrowser, colours, fill, haveWritten, openFromDisk, template, written } from './browser';

afterAll(closeBrowser);

interface Shown {
  convertToPixel(f: object, p: number[]): number[];
  getOption(): { xAxis: { name: string }[]; series: { id: string; type: string; color: string; data: [number, number][] }[] };
}
/** The chart of a plot, inside the page. */
type WithPlots = { steadyrestPlot: (id: string) => { chart: Shown } };

async function text(page: Page, selector: string): Promise<string> {
  return (await page.textContent(selector)) ?? '';
}

async function expectFigures(page: Page, report: Report): Promise<void> {
  for (const row of figureRows(report.without.figures, report.with.figures)) {
    const cells = await page.locator(`#figures tbody tr:has(> th > span:text-is("${row.label}")) td`).allTextContents();
    expect(cells.map((c) => c.trim())).toEqual([row.without, row.with, row.change]);
  }
}

async function expectMotion(page: Page, report: Report): Promise<void> {
  const rows = await page.locator('#motion tbody tr').allTextContents();
  expect(rows.map((r) => r.replace(/\s+/g, ' ').trim())).toEqual(
    motionRows(report.motion).map((r) => `${r.axis}, ${r.quantity}${r.difference}${r.estimate}${r.finer}${r.coverage}`.replace(/\s+/g, ' ')),
  );
}

/** Colours that the streams of a PDF draw lines with. */
function strokesOf(pdf: Buffer): number[][] {
  const out: number[][] = [];
  for (let at = pdf.indexOf('stream\n'); at >= 0; at = pdf.indexOf('stream\n', at + 1)) {
    const begin = at + 'stream\n'.length;
    const end = pdf.indexOf('endstream', begin);
    try {
      const drawn = inflateSync(pdf.subarray(begin, end)).toString('latin1');
      out.push(...[...drawn.matchAll(/([\d.]+) ([\d.]+) ([\d.]+) RG/g)].map((m) => [m[1], m[2], m[3]].map(Number)));
    } catch {
      // Not compressed: a font or the end of another stream.
    }
  }
  return out;
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
    const seen = await colours(open);
    for (const plot of ['ways-max', 'ways-rms', 'path-without', 'path-with', 'course-error', 'course-override', 'course-feed']) {
      expect(seen[plot], plot).toBeGreaterThan(20);
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
    expect(worth).toContain(micrometres(report.without.figures.contour_error_max_mm));
    expect(worth).toContain(micrometres(report.with.figures.contour_error_max_mm));
  });

  it('compares the ways as a table, in the order of the report', async () => {
    const rows = await open.page.locator('#ways tbody tr').allTextContents();
    expect(rows).toHaveLength(report.ways.length + report.curve.length);
    for (const [i, name] of ['As programmed', 'Feed override', 'Path offsets', 'Feed override for 5 µm'].entries()) {
      expect(rows[i]?.startsWith(name), rows[i]).toBe(true);
    }
    expect(rows[2]).toContain(micrometres(report.ways[2]?.contour_error_max_mm ?? 0));
  });

  it('lists the worst lines by what the layer left, and by any column that is pressed', async () => {
    const column = async (i: number) => (await open.page.locator(`#worst tbody tr > :nth-child(${i})`).allTextContents()).map((v) => Number(v.replace('−', '-').replace('–', 'NaN').replace('\u202f', '')));
    const falling = (values: number[]) => values.filter((v) => !Number.isNaN(v)).every((v, i, all) => i === 0 || v <= (all[i - 1] ?? Infinity));
    const size = (values: number[]) => values.map(Math.abs);
    expect(falling(size(await column(4)))).toBe(true);
    expect((await column(1)).length).toBe(report.worst_lines.length);
    for (const [name, index] of [['Without, µm', 3], ['Actual feed, mm/min', 6], ['Holding feed, mm/min', 7]] as const) {
      await open.page.click(`#worst th button:text-is("${name}")`);
      expect(falling(size(await column(index))), name).toBe(true);
      await open.page.click(`#worst th button:text-is("${name}")`);
      expect(falling(size(await column(index)).reverse()), `${name}, rising`).toBe(true);
    }
    await open.page.click('#worst th button:text-is("With, µm")');
    const held = await open.page.locator('#worst tbody tr').allTextContents();
    expect(held.some((r) => r.includes('closed form')) && held.some((r) => r.includes('actual feed'))).toBe(true);
  });

  it('says when, by what command and out of what it was made', async () => {
    expect(await text(open.page, '#made-date')).toBe(report.made?.date);
    expect(await text(open.page, '#made-command')).toBe(report.made?.command);
    expect(await text(open.page, '#inputs')).toContain(report.made?.inputs[0]?.sha256);
  });

  it('saves the course with the values of the report, and the path with all of its columns', async () => {
    const saved = async (id: string) => {
      const [download] = await Promise.all([open.page.waitForEvent('download'), open.page.click(`#${id}-frame [data-tool="csv"]`)]);
      return (await readFile(await download.path(), 'utf8')).trimEnd().split('\n').map((l) => l.split(','));
    };
    const [head, ...rows] = await saved('course-feed');
    // Both runs have the same places here: one column of them.
    expect(head).toEqual(['path length in mm', 'path feed in mm/min: without the layer', 'path feed in mm/min: with the layer']);
    expect(rows.map((r) => Number(r[0]))).toEqual(report.without.trace.path_mm);
    expect(rows.map((r) => Number(r[2]))).toEqual(report.with.trace.feed_mm_min);
    const [names, ...samples] = await saved('path-with');
    expect(names).toEqual(Object.keys(report.with.trace));
    expect(samples.map((r) => Number(r[names?.indexOf('contour_error_um') ?? -1]))).toEqual(JSON.parse(JSON.stringify(report.with.trace.contour_error_um)));
  });

  it('prints the paths in the colours of their errors', async () => {
    const pdf = await open.page.pdf({ format: 'A4', preferCSSPageSize: true });
    const strokes = strokesOf(pdf);
    const used = errorClasses(report.limit_um, report.without.figures.contour_error_max_mm * 1000, 'light').filter((c) => c.over);
    for (const { colour } of used.slice(0, 4)) {
      const wanted = [1, 3, 5].map((i) => Number.parseInt(colour.slice(i, i + 2), 16) / 255);
      expect(strokes.some((s) => s.every((v, i) => Math.abs(v - (wanted[i] ?? 0)) < 0.004)), colour).toBe(true);
    }
  });

  it('names line and value under the pointer', async () => {
    const at = await open.page.evaluate(() => {
      const { chart } = (window as unknown as WithPlots).steadyrestPlot('path-without');
      return chart.convertToPixel({ gridIndex: 0 }, [17, 0.5]);
    });
    await open.page.locator('#path-without').hover({ position: { x: at[0] ?? 0, y: at[1] ?? 0 } });
    const tip = open.page.locator('#path-without .tip');
    expect(await tip.isVisible()).toBe(true);
    expect(await tip.textContent()).toMatch(/Line \d+contour error [−\d.]+\sµm/);
  });

  it('keeps one millimetre as long across as up in every view', async () => {
    for (const plane of ['xz', 'yz', 'xy']) {
      await open.page.click(`#plane button[data-value="${plane}"]`);
      const [dx, dy] = await open.page.evaluate(() => {
        const { chart } = (window as unknown as WithPlots).steadyrestPlot('path-without');
        const [ax = 0, ay = 0] = chart.convertToPixel({ gridIndex: 0 }, [0, 0]);
        const [bx = 0, by = 0] = chart.convertToPixel({ gridIndex: 0 }, [10, 10]);
        return [bx - ax, ay - by];
      });
      expect(dx).toBeGreaterThan(1);
      expect((dx ?? 0) / (dy ?? 1)).toBeCloseTo(1, 2);
    }
  });

  it('runs along the path, and along time when that is chosen', async () => {
    const names = () =>
      open.page.evaluate(() => ['course-error', 'course-override', 'course-feed'].map((id) => (window as unknown as WithPlots).steadyrestPlot(id).chart.getOption().xAxis[0]?.name));
    expect(new Set(await names())).toEqual(new Set(['path length in mm']));
    await open.page.click('#abscissa button[data-value="time_s"]');
    expect(new Set(await names())).toEqual(new Set(['time in s']));
    expect(open.complaints).toEqual([]);
  });
});

describe('a report of 200 000 samples', () => {
  it('opens and keeps a lone spike in view', async () => {
    const report = makeReport(200_000);
    const spike = 100_003;
    report.with.trace.cutting[spike] = 1;
    report.with.trace.contour_error_um[spike] = 321.5;
    const open = await openFromDisk(fill(report));
    const shown = await open.page.evaluate(() => {
      const { chart } = (window as unknown as WithPlots).steadyrestPlot('course-error');
      return chart.getOption().series.filter((s) => s.type === 'line').at(-1)?.data.map((p) => p[1]) ?? [];
    });
    expect(shown).toContain(321.5);
    expect(shown.length).toBeLessThan(10_000);
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
    expect((await colours(open))['path-with']).toBeGreaterThan(10);
    await open.close();
  });
});

describe.runIf(haveWritten)('the report that steadyrest wrote', () => {
  it('shows the figures of its report.json', async () => {
    const { html, data: report } = written<Report>('sample');
    const open = await openFromDisk(html);
    await expectFigures(open.page, report);
    await expectMotion(open.page, report);
    expect(await text(open.page, 'h1')).toBe(report.program);
    expect(open.complaints).toEqual([]);
    await open.close();
  });
});
