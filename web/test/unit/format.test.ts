// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import type { Figures } from '../../src/cut/data';
import { figureRows, motionRows, verdict } from '../../src/cut/figures';
import { change, fixed, twoDigits } from '../../src/frame/numbers';

const figures = (max_mm: number, cycle_s: number): Figures => ({
  cycle_time_s: cycle_s,
  cutting_time_s: cycle_s / 2,
  contour_error_max_mm: max_mm,
  contour_error_rms_mm: max_mm / 3,
  tracking_error_max_mm: 1.3216,
  over_limit_s: max_mm > 0.01 ? 3.25 : 0,
  samples: 2000,
  samples_over_limit: max_mm > 0.01 ? 250 : 0,
  override_changes: 4,
});

describe('numbers', () => {
  it('keep their decimals, group thousands and carry a true minus', () => {
    expect(fixed(12345.678, 1)).toBe('12\u202f345.7');
    expect(fixed(-0.25, 2)).toBe('−0.25');
    expect(fixed(4000, 0)).toBe('4000');
  });
  it('never show a negative zero', () => expect(fixed(-0.0001, 2)).toBe('0.00'));
  it('are a dash when not finite', () => {
    for (const value of [null, undefined, NaN, Infinity]) {
      expect(fixed(value, 2)).toBe('–');
    }
  });
  it('give changes their sign', () => {
    expect(change(100, 110)).toBe('+10.0\u00a0%');
    expect(change(0.0877, 0.0098)).toBe('−88.8\u00a0%');
    expect(change(100, 100.001)).toBe('0.0\u00a0%');
    expect(change(0, 1)).toBe('–');
  });
});

describe('figures', () => {
  it('name both runs and the change', () => {
    const rows = figureRows(figures(0.0877, 60), figures(0.0098, 66));
    const byKey = new Map(rows.map((r) => [r.key, r]));
    expect(byKey.get('contour_error_max_mm')).toMatchObject({ without: '87.7\u00a0µm', with: '9.8\u00a0µm', change: '−88.8\u00a0%' });
    expect(byKey.get('over_limit_ratio')).toMatchObject({ without: '12.50\u00a0%', with: '0.00\u00a0%' });
    expect(byKey.get('cycle_time_s')).toMatchObject({ without: '60.00\u00a0s', with: '66.00\u00a0s', change: '+10.0\u00a0%' });
  });
});

describe('verdict', () => {
  it('says that the limit is kept', () =>
    expect(verdict(figures(0.0877, 60), figures(0.0098, 66), 10)).toContain('stays within the 10.0\u00a0µm limit'));
  it('says for how long it is not kept', () =>
    expect(verdict(figures(0.0877, 60), figures(0.02, 66), 10)).toContain('exceeds the 10.0\u00a0µm limit for 3.25\u00a0s'));
  it('does not praise a program that never cuts', () => {
    const nothing = { ...figures(0, 0), samples: 0 };
    expect(verdict(nothing, nothing, 10)).toContain('does not cut');
  });
});

describe('the motion of the axes', () => {
  const figures = {
    axis: 'X',
    velocity_rms_mm_s: 0.00312,
    acceleration_rms_mm_s2: 4.26,
    difference_velocity_rms_mm_s: 0.428,
    difference_acceleration_rms_mm_s2: 707.4,
    velocity_coverage_ratio: 0.99996,
    acceleration_coverage_ratio: null,
  };
  it('is shown with two digits that count and the ratio of both errors', () => {
    const [velocity, acceleration] = motionRows([figures]);
    expect(velocity).toEqual({
      axis: 'X', quantity: 'velocity', difference: '0.43 mm/s', estimate: '0.0031 mm/s', finer: '137 ×', coverage: '99.99\u00a0%',
    });
    expect(acceleration).toMatchObject({ difference: '707 mm/s²', estimate: '4.3 mm/s²', finer: '166 ×', coverage: 'no bound' });
  });
  it('never rounds a bound that failed to one that held', () => {
    expect(motionRows([{ ...figures, velocity_coverage_ratio: 1 - 1e-9 }])[0]?.coverage).toBe('99.99\u00a0%');
    expect(motionRows([{ ...figures, velocity_coverage_ratio: 1 }])[0]?.coverage).toBe('100\u00a0%');
  });
  it('is in radians on rotary axes', () => expect(motionRows([{ ...figures, axis: 'B' }])[0]?.estimate).toBe('0.0031 rad/s'));
  it('divides by nothing', () => {
    expect(motionRows([{ ...figures, velocity_rms_mm_s: 0 }])[0]).toMatchObject({ estimate: '0 mm/s', finer: '–' });
    expect(twoDigits(1e-9)).toBe('0.000000');
  });
});
