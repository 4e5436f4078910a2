// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import type { Report } from '../../src/cut/data';
import { cutView } from '../../src/cut/view';
import { bestSection, comparesWays, overSection, wayPlot, waysSection } from '../../src/cut/ways';
import { theme } from '../../src/frame/theme';
import { placed } from '../../src/plot/labels';
import type { Dot, LayerOf } from '../../src/plot/layers';
import { emptyReport, makeReport } from '../fixture';

const LIGHT = theme(true);

describe('labels beside dots', () => {
  const x = { min: 0, max: 100 };
  const y = { name: 'error', log: true };
  const place = (dots: Dot[]) => placed(dots, x, y, 0, 3);

  it('stand to the right where there is room, else to the left', () => {
    expect(place([{ x: 50, y: 10, label: 'alone' }])[0]).toMatchObject({ side: 'right', lift: 0 });
    expect(place([{ x: 95, y: 10, label: 'alone' }])[0]).toMatchObject({ side: 'left', lift: 0 });
  });

  it('make way for one another and for other dots', () => {
    const same = place([1, 2, 3, 4].map((i) => ({ x: 50, y: 10, label: `way ${i}` })));
    expect(new Set(same.map((d) => `${d.side} ${d.lift}`)).size).toBe(4);
    const [first] = place([{ x: 50, y: 10, label: 'alone' }, { x: 58, y: 10, label: 'other' }]);
    expect(first).toMatchObject({ side: 'left' });
  });
});

describe('the ways of a report', () => {
  const report = makeReport(200);
  const dots = (of: Report, i: number) => wayPlot(of, i, LIGHT).layers.filter((l): l is LayerOf<'dots'> => l.kind === 'dots');

  it('are points of error over cycle time, one for each', () => {
    const points = dots(report, 0).filter((l) => 'name' in l);
    expect(points.map((l) => (l as { name?: string }).name)).toEqual(['as programmed', 'feed override', 'path offsets']);
    points.forEach((l, i) => expect(l.dots).toMatchObject([{ x: report.ways[i]?.cycle_time_s, y: 1000 * (report.ways[i]?.contour_error_max_mm ?? 0) }]));
    expect(dots(report, 1).at(-1)?.dots[0]?.y).toBeCloseTo(1.2, 12);
  });

  it('have a curve that passes the feed override in order of time', () => {
    const line = wayPlot(report, 0, LIGHT).layers.find((l): l is LayerOf<'line'> => l.kind === 'line');
    expect(line?.x).toEqual([...(line?.x ?? [])].sort((a, b) => (a ?? 0) - (b ?? 0)));
    expect(line?.x).toHaveLength(3);
    expect(line?.x).toContain(report.with.figures.cycle_time_s);
  });

  it('are named by their program where there are two', () => {
    const changed: Report = { ...report, against: 'a.mpf', ways: [...report.ways, { ...report.without.figures, way: 'changed' }] };
    expect(waysSection(changed)).toContain('Original, feed override');
    expect(waysSection(changed)).toContain('Changed program, alone');
  });

  it('are left out where there is nothing to choose, and a way without error has no logarithm', () => {
    expect(comparesWays(emptyReport())).toBe(false);
    expect(waysSection(emptyReport())).toBe('');
    const none: Report = { ...report, ways: report.ways.map((w) => ({ ...w, contour_error_max_mm: 0 })), curve: [] };
    expect(dots(none, 0)).toHaveLength(0);
  });
});

describe('the best way of a report', () => {
  const report = makeReport(200);
  const text = { ...report.without.figures, way: 'text' as const, contour_error_max_mm: 0.004, get: 'steadyrest program correct <a>.mpf' };
  const best: Report = {
    ...report,
    best: { same_time: text, any_time: null, setting: null },
    best_run: { ...report.without, figures: text },
    over_limit: [{ line: 12, error_um: 20.7, reason: 'arc of 2 mm at F2986', cure: '--hold-limit: +0.08 s' }],
  };

  it('leads: verdict and headlines are its own, with the command', () => {
    expect(bestSection(best)).toContain('steadyrest program correct &#60;a&#62;.mpf');
    expect(cutView(best).verdict).toMatch(/^With corrected text, the contour error peaks at 4\.0/);
    expect(cutView(report).verdict).toMatch(/^With the layer/);
  });

  it('shows each line that is left with its reason and the price of its cure', () => {
    expect(overSection(best)).toMatch(/20\.7.*arc of 2 mm at F2986.*--hold-limit: \+0\.08 s/);
  });

  it('is left out of a report that did not ask for it', () => {
    expect(bestSection(report)).toBe('');
    expect(overSection(report)).toBe('');
    expect(bestSection({ ...best, best: { same_time: null, any_time: null, setting: null } })).toBe('');
  });
});
