// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { bandEdges } from '../../src/thermal/band';
import { type PlanPage, type PlannedCourse, residual } from '../../src/thermal/data';
import { forecastBand, jobTime, starts, statesUncertainty, withBand } from '../../src/thermal/over_time';
import { planView } from '../../src/thermal/plan';
import { theme } from '../../src/frame/theme';

const LIGHT = theme(true);
const course = (more: Partial<PlannedCourse> = {}): PlannedCourse => ({
  axis: 'Z', t_min: [0, 10, 20], displacement_um: [0, 10, 30], sd_um: [null, 1, 2], corrections: [], bands: [], ...more,
});
const axis = (more: object = {}) => ({ axis: 'Z', max_um: 40, residual_um: 10, ratio: 4, corrections: 2, sd_um: 0, transitions: [], ...more });
const transition = (i: number, minutes = 5) => ({ name: '', start_min: 5 * i, minutes, speed_rpm: 3000, cutting: true });
const page = (more: object = {}, axes = [axis()]): PlanPage =>
  ({ title: 'p.mpf', answer: { k: 0.5, level: 1, tolerance_um: 40, axes }, transitions: [transition(0)], courses: [], ...more }) as unknown as PlanPage;

describe('what corrections leave', () => {
  it('is the displacement itself without any', () => expect(residual(course())).toEqual({ t_min: [0, 10, 20], um: [0, 10, 30] }));
  it('steps down where a correction is made, between two points too', () => {
    // At 15 min the straight line is at 20 µm; the correction takes 20 off.
    const left = residual(course({ corrections: [{ t_min: 15, delta_um: 20, total_um: 20 }] }));
    expect(left).toEqual({ t_min: [0, 10, 15, 15, 20], um: [0, 10, 20, 0, 10] });
  });
  it('counts the sum of corrections, and one at a point before that point', () => {
    const left = residual(course({ corrections: [{ t_min: 10, delta_um: 8, total_um: 8 }, { t_min: 20, delta_um: 20, total_um: 28 }] }));
    expect(left.um).toEqual([0, 10, 2, 2, 22, 2, 2]);
  });
  it('begins corrected where the job does', () => {
    expect(residual(course({ corrections: [{ t_min: 0, delta_um: 3, total_um: 3 }] })).um).toEqual([0, -3, -3, 7, 27]);
  });
});

describe('the 95 % band', () => {
  // The normal distribution's 97.5 % quantile is 1.959964.
  it('is 1.96 standard deviations on both sides, none where none is stated', () => {
    const [low, high] = bandEdges([10, 10, null], [1, null, 1]);
    expect(low).toEqual([8.04, 10, null]);
    expect(high).toEqual([11.96, 10, null]);
  });
  it('is drawn only where the passport states an uncertainty', () => {
    const silent = course({ sd_um: [null, 0, 0] });
    expect([statesUncertainty(course()), statesUncertainty(silent)]).toEqual([true, false]);
    expect([forecastBand(course(), 'red').length, forecastBand(silent, 'red').length]).toEqual([1, 0]);
  });
  it('has room on the axis', () => expect(Math.max(...withBand(course()).map((v) => v ?? 0))).toBeCloseTo(33.92, 12));
});

describe('the job', () => {
  it('lasts until its last transition ends', () => expect(jobTime([transition(0, 30), transition(1)]).max).toBe(30));
  it('has an upright line at each start but the first', () => expect(starts([0, 1, 2].map((i) => transition(i)), LIGHT)).toMatchObject({ axis: 'x', at: [5, 10] }));
});

describe('the verdict on a plan', () => {
  it('says how much less is left', () => {
    expect(planView(page()).verdict).toBe('2 corrections keep Z within 10.0\u00a0µm instead of 40.0\u00a0µm: 4.0 times less.');
    expect(planView(page({}, [axis({ corrections: 1 })])).verdict).toContain('1 correction keeps Z');
  });
  it('says so where none is needed', () => {
    expect(planView(page({}, [axis({ corrections: 0, max_um: 3 })])).verdict).toBe('Z needs no correction: it stays within 3.0\u00a0µm.');
  });
  it('adds how uncertain the forecast is, if the passport says', () => {
    expect(planView(page({}, [axis({ sd_um: 1 })])).verdict).toContain('uncertain by ±2.0\u00a0µm');
    expect(planView(page()).verdict).not.toContain('uncertain');
    expect(planView(page()).body).toContain('not stated');
  });
});

describe('the system R', () => {
  const many = (n: number, corrected: (i: number) => boolean) =>
    planView(page({ transitions: Array.from({ length: n }, (_, i) => transition(i)) }, [
      axis({ transitions: Array.from({ length: n }, (_, i) => ({ name: `op${i}`, t_min: [5], delta_um: [corrected(i) ? 7 : 0] })) }),
    ])).body;
  const rows = (html: string) => html.match(/op\d+/g)?.length ?? 0;

  it('shows every transition of a short job', () => {
    const body = many(40, () => false);
    expect(rows(body)).toBe(40);
    expect(body).not.toContain('Shown:');
  });
  it('shows those with corrections of a long job, and says so', () => {
    const body = many(41, (i) => i % 10 === 0);
    expect(rows(body)).toBe(5);
    expect(body).toContain('Shown: 5 transitions with corrections, of 41 in all.');
    expect(many(41, (i) => i === 3)).toContain('Shown: 1 transition with');
  });
  it('never shows more than 200', () => {
    const body = many(500, () => true);
    expect(rows(body)).toBe(200);
    expect(body).toContain('the first 200 transitions with corrections, of 500 in all');
  });
  it('numbers transitions without a name', () => {
    const body = planView(page({}, [axis({ transitions: [{ name: '', t_min: [1, 4], delta_um: [0, 12.5] }] })])).body;
    expect(body).toContain('<span>1</span>');
    expect(body).toContain('0, 12.5');
  });
});
