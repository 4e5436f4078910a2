// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { parsePage } from '../../src/frame/data';
import { lowerBound, nearestIndex, thin } from '../../src/plot/thin';
import { makeReport } from '../fixture';

describe('thinning', () => {
  const n = 200_000;
  const x = Array.from({ length: n }, (_, i) => i * 1e-3);
  const y: (number | null)[] = x.map((t) => Math.sin(t));
  y[77_777] = 50;
  y[150_001] = -60;

  it('keeps every extreme and bounds the count', () => {
    const points = thin(x, y, 0, 200, 1000);
    expect(points.length).toBeLessThanOrEqual(3002);
    expect(points).toContainEqual([x[77_777], 50]);
    expect(points).toContainEqual([x[150_001], -60]);
  });
  it('keeps the order', () => {
    const points = thin(x, y, 0, 200, 1000);
    expect(points.every((p, i) => i === 0 || p[0] >= (points[i - 1]?.[0] ?? 0))).toBe(true);
  });
  it('shows all samples of a short stretch and one beyond each end', () => {
    const points = thin(x, y, 10, 10.01, 1000);
    expect(points[0]?.[0]).toBeLessThan(10);
    expect(points.at(-1)?.[0]).toBeGreaterThanOrEqual(10.01);
    expect(points.length).toBeLessThanOrEqual(14);
  });
  it('keeps gaps', () => {
    const gaps = y.map((v, i) => (i > 1000 && i < 5000 ? null : v));
    expect(thin(x, gaps, 0, 200, 500).some((p) => p[1] === null)).toBe(true);
  });
  it('of nothing is nothing', () => expect(thin([], [], 0, 1, 100)).toEqual([]));
  it('finds bounds', () => {
    expect(lowerBound([0, 1, 2, 3], 1.5)).toBe(2);
    expect(lowerBound([0, 1], 9)).toBe(2);
  });
});

describe('the data element', () => {
  const parse = (text: string) => parsePage(text, { 'steadyrest-report/1': 'a report', 'steadyrest-chatter/1': { lobes: 'lobes' } });
  it('gives the report', () => expect(parse(JSON.stringify(makeReport(50)))).toMatchObject({ head: { limit_um: 10 }, value: 'a report' }));
  it('is told apart by schema and kind', () => expect(parse('{"schema":"steadyrest-chatter/1","kind":"lobes"}')).toMatchObject({ value: 'lobes' }));
  it('is refused with a sentence when it is empty, broken or of another kind', () => {
    expect(parse('"@MARK@"')).toContain('no data');
    expect(parse('{')).toContain('not valid JSON');
    expect(parse('{"schema":"other/2"}')).toContain('other/2');
    expect(parse('{"schema":"<img src=x>"}')).not.toContain('<');
    for (const kind of ['nothing', 'constructor', 7]) {
      expect(parse(JSON.stringify({ schema: 'steadyrest-chatter/1', kind }))).toContain(`Its data is steadyrest-chatter/1, ${kind}.`);
    }
    expect(parse('{"schema":"constructor"}')).toContain('constructor');
  });
});

describe('the nearest sample of a column', () => {
  it('is one of both neighbours, none beyond the end', () => {
    const x = [0, 1, 3, 7];
    expect([-1, 0.4, 0.6, 2.1, 6.9, 7].map((at) => nearestIndex(x, at))).toEqual([0, 0, 1, 2, 3, 3]);
    expect(nearestIndex(x, 7.1)).toBe(-1);
    expect(nearestIndex([], 0)).toBe(-1);
  });
});
