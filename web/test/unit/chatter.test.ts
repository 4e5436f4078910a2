// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { type GrowthPage, lawText, parsePage } from '../../src/chatter/data';
import { quietLevel } from '../../src/chatter/detect';
import { plain } from '../../src/chatter/frame';
import { peakOf } from '../../src/chatter/growth';
import { niceStep, roomy } from '../../src/chatter/plot';
import { radiusLevels, valueAt } from '../../src/chatter/raster';

describe('axes', () => {
  it('have steps of 1, 2 and 5', () => {
    expect([1, 7, 23, 50, 0.09].map((range) => niceStep(range, 5))).toEqual([0.2, 2, 5, 10, 0.02]);
  });
  it('leave room around the curve and keep nought', () => {
    const [low, high] = roomy([-10, 10]);
    expect(low).toBeLessThan(-10);
    expect(high).toBeGreaterThan(10);
    expect(roomy([3, 5], true)[0]).toBe(0);
  });
  it('have a range even where nothing changes', () => {
    for (const value of [0, 5000]) {
      const [low, high] = roomy([value, value]);
      expect(low).toBeLessThan(value);
      expect(high).toBeGreaterThan(value);
    }
  });
});

describe('numbers', () => {
  it('show the digits that count', () => {
    expect([1.40647353, 0.0032551, 5000, 100, 0, null, -2.5].map((v) => plain(v))).toEqual(['1.406', '0.003255', '5000', '100', '0', '–', '−2.5']);
    expect(plain(3.1e-14)).toBe('3.1·10⁻¹⁴');
    expect(plain(12345678, 3)).toBe('1.23·10⁷');
  });
  it('say the law in the words of the shop floor', () => {
    expect(lawText({ law: 'constant' })).toBe('constant speed');
    expect(lawText({ law: 'sine', rva: 0.2, rvf: 0.1, period_s: 0.12 })).toBe('sine ±20 % every 0.12 s');
    expect(lawText({ law: 'triangle', rva: 0.125, rvf: 0.1 })).toBe('triangle ±12.5 %, RVF 0.1');
  });
});

describe('the map', () => {
  const grid = { x: [0, 1, 3], y: [0, 10], value: [0, 1, 2, 3, 4, 5] };
  it('goes straight between its points and stops at its edges', () => {
    expect(valueAt(grid, 0, 0)).toBe(0);
    expect(valueAt(grid, 0.5, 5)).toBeCloseTo(1.5);
    expect(valueAt(grid, 2, 0)).toBeCloseTo(3);
    expect(valueAt(grid, 9, 99)).toBe(5);
  });
  it('changes its colour at ρ = 1', () => {
    for (const perPass of [true, false]) {
      const levels = radiusLevels([-3, 2], perPass, 'light');
      const of = (log: number) => levels.findIndex((l) => log <= l.to);
      expect(of(-1e-9)).toBeLessThan(of(1e-9));
      expect(levels.map((l) => l.to)).toEqual([...levels.map((l) => l.to)].sort((a, b) => a - b));
      expect(levels.slice(1).every((l, i) => l.from === levels[i]?.to)).toBe(true);
      expect(levels.some((l) => l.to === 0)).toBe(true);
    }
  });
});

describe('the growth', () => {
  it('has its peak in the worst course', () => {
    const courses = [
      { start_pass: 0, time_s: [0, 1], log_growth: [0, 0.5] },
      { start_pass: 1, time_s: [1, 2, 3], log_growth: [0, 2.5, null] },
    ];
    expect(peakOf({ courses, worst: 1 } as unknown as GrowthPage)).toEqual({ start_s: 1, time_s: 2, log_growth: 2.5 });
  });
});

describe('the spectrogram', () => {
  it('shows what is quiet as paper, and at least 30 dB', () => {
    expect(quietLevel([0, -10, -10, -10])).toBe(-30);
    expect(quietLevel([0, -90, -80, -70])).toBe(-80);
  });
});

describe('the data element', () => {
  it('is refused with a sentence when it is empty, broken or of another kind', () => {
    expect(parsePage('"@MARK@"')).toContain('no data');
    expect(parsePage('{')).toContain('not valid JSON');
    expect(parsePage('{"schema":"other/2"}')).toContain('other/2');
  });
});
