// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { type GrowthPage, lawText } from '../../src/chatter/data';
import { quietLevel } from '../../src/chatter/raster';
import { phase } from '../../src/chatter/fit';
import { plain } from '../../src/frame/numbers';
import { peakOf } from '../../src/chatter/growth';
import { niceStep, roomy } from '../../src/plot/axes';
import { borderAt, radiusLevels, valueAt, valueBeside } from '../../src/chatter/raster';

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
    expect(lawText({ law: 'sine', rva: 0.2, rvf: 0.1, period_s: 0.12 })).toBe('sine ±20\u00a0% every 0.12\u00a0s');
    expect(lawText({ law: 'triangle', rva: 0.125, rvf: 0.1 })).toBe('triangle ±12.5\u00a0%, RVF 0.1');
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

describe('the map beside its border', () => {
  // Two speeds 100 rev/min apart, the true border a cusp between them.
  const grid = { x: [0, 100], y: [0, 1, 2], value: [-1, 1, 3, -1, 1, 3] };
  const border = { x: [0, 49, 50, 51, 100], y: [0.5, 1.2, 1.9, 1.2, 0.5] };
  it('has the colour of stable up to the border, of unstable above it', () => {
    for (let x = 0; x <= 100; x += 1) {
      const limit = borderAt(border, x) as number;
      expect(valueBeside(grid, border, x, limit - 0.01)).toBeLessThan(0);
      expect(valueBeside(grid, border, x, limit + 0.01)).toBeGreaterThan(0);
    }
  });
  it('keeps islands of stability that the grid has found above the border', () => {
    const island = { ...grid, value: [-1, 1, -1, -1, 1, -1] };
    expect(valueBeside(island, border, 0, 1.9)).toBeLessThan(0);
  });
  it('is what the grid says where no border is known', () => {
    const gap = { x: [0, 50, 100], y: [0.5, null, 0.5] };
    expect(borderAt(gap, 20)).toBeUndefined();
    expect(borderAt(gap, 200)).toBeUndefined();
    expect(valueBeside(grid, gap, 20, 1)).toBe(valueAt(grid, 20, 1));
  });
});

describe('the phase of a response', () => {
  it('turns from 0 to −180 degrees and does not jump there', () => {
    const of = (real: number, imag: number) => phase({ frequency_hz: [1], real_um_N: [real], imag_um_N: [imag] })[0];
    expect(of(1, 0)).toBeCloseTo(0);
    expect(of(0, -1)).toBeCloseTo(-90);
    expect(of(-1, -0.01)).toBeCloseTo(-179.43, 1);
    expect(of(-1, 0.01)).toBeCloseTo(-180.57, 1);
    expect(phase({ frequency_hz: [1], real_um_N: [null], imag_um_N: [1] })).toEqual([null]);
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
