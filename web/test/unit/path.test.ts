// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { NOT_CUTTING, NearestSample, boundingBox, polylinesByClass } from '../../src/cut/path';
import { classOf, errorClasses } from '../../src/cut/scale';
import { niceAbove } from '../../src/plot/axes';
import { withEqualAspect } from '../../src/plot/equal_aspect';
import { emptyReport, makeReport } from '../fixture';

describe('the colour scale', () => {
  it('has the limit as a border', () => {
    const classes = errorClasses(10, 90, 'light');
    expect(classes.filter((c) => !c.over).at(-1)?.to_um).toBe(10);
    expect(classes.find((c) => c.over)?.from_um).toBe(10);
    expect(classes.at(-1)?.to_um).toBeGreaterThanOrEqual(90);
  });
  it('puts exactly the limit within it and just above it over it', () => {
    const classes = errorClasses(10, 90, 'light');
    expect(classes[classOf(classes, -10)]?.over).toBe(false);
    expect(classes[classOf(classes, 10.001)]?.over).toBe(true);
    expect(classOf(classes, 1e9)).toBe(classes.length - 1);
  });
  it('has no class over the limit when nothing is', () =>
    expect(errorClasses(10, 9, 'dark').every((c) => !c.over)).toBe(true));
  it('rounds up to a number that people read', () => {
    expect(niceAbove(87.7)).toBe(100);
    expect(niceAbove(1.0)).toBe(1);
    expect(niceAbove(0)).toBe(1);
  });
});

describe('polylines by class', () => {
  it('split where the class changes, the worse class owns the stretch between', () => {
    const lines = polylinesByClass([0, 1, 2, 3, 4], [0, 0, 0, 0, 0], [0, 0, 5, 0, 0]);
    expect(lines.get(0)).toEqual({ x: [0, 1, null, 3, 4], y: [0, 0, null, 0, 0] });
    expect(lines.get(5)).toEqual({ x: [1, 2, 3], y: [0, 0, 0] });
  });
  it('break at values that are missing', () =>
    expect(polylinesByClass([0, 1, null, 3, 4], [0, 0, null, 0, 0], [0, 0, 0, 0, 0]).get(0)?.x).toEqual([0, 1, null, 3, 4]));
  it('draw what does not cut apart', () =>
    expect([...polylinesByClass([0, 1, 2], [0, 0, 0], [0, NOT_CUTTING, 0]).keys()]).toEqual([NOT_CUTTING]));
  it('keep a single bad sample among thousands when points are merged', () => {
    const n = 200_000;
    const x = Array.from({ length: n }, (_, i) => i * 1e-4);
    const classes = x.map((_, i) => (i === 123_456 ? 8 : 0));
    const lines = polylinesByClass(x, x, classes, 0.5);
    expect(lines.get(8)).toBeDefined();
    expect(lines.get(0)?.x.length).toBeLessThan(1000);
  });
  it('end where the path ends although the last step is too short to see', () =>
    expect(polylinesByClass([0, 1, 1.01], [0, 0, 0], [0, 0, 0], 0.5).get(0)?.x).toEqual([0, 1.01]));
});

describe('the view', () => {
  it('shows one millimetre as long across as up', () => {
    const view = withEqualAspect({ left: 0, right: 100, bottom: 0, top: 10 }, 500, 400);
    expect((view.right - view.left) / 500).toBeCloseTo((view.top - view.bottom) / 400, 12);
    expect(view.left).toBeLessThan(0);
    expect(view.right).toBeGreaterThan(100);
  });
  it('survives a path without extent and a path without points', () => {
    const view = withEqualAspect({ left: 5, right: 5, bottom: 5, top: 5 }, 500, 400);
    expect(view.right).toBeGreaterThan(view.left);
    expect(boundingBox([emptyReport().with.trace], 'xy')).toBeUndefined();
  });
});

describe('the nearest sample', () => {
  const { trace } = makeReport(4000).without;
  const nearest = new NearestSample(trace, 'xy');
  it('is the one that brute force finds', () => {
    for (const [x, y] of [[17.1, 0.2], [-50, 5], [30, 38.1]] as const) {
      const found = nearest.find(x, y, 1.5);
      const distance = (i: number) => Math.hypot((trace.x_mm[i] ?? 0) - x, (trace.y_mm[i] ?? 0) - y);
      const best = Math.min(...trace.x_mm.map((_, i) => (trace.cutting[i] === 1 ? distance(i) : Infinity)));
      expect(found).toBeDefined();
      expect(distance(found ?? 0)).toBeLessThan(best + 1.5 / 20 + 1e-9);
    }
  });
  it('is none far from the path', () => expect(nearest.find(-20, 5, 1)).toBeUndefined());
});
