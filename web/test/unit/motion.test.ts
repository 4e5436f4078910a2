// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { theme } from '../../src/frame/theme';
import { benchView } from '../../src/motion/bench';
import { figurePlots, lagPlots, tracePlots } from '../../src/motion/bench_plots';
import type { Bench, Course, EstimatePage, Figures, Requirement, Row, Trace } from '../../src/motion/data';
import { estimateView } from '../../src/motion/estimate';
import { requirement } from '../../src/motion/requirement';
import type { LayerOf } from '../../src/plot/layers';

const LIGHT = theme(true);
const figures = (rms: number | null, more: Partial<Figures> = {}): Figures => ({
  rms, max: rms, own_lag_s: 0.002, rms_at_own_lag: 0.5, gain: 3, coverage: 1, bound_ratio: 2, efficiency: 0.5, target: null, rms_at_lag: [rms, 0], ...more,
});
const row = (scene: string, estimator: string, limits: boolean, velocity = figures(1)): Row => ({
  scene, estimator, limits, ticks: 100, velocity, acceleration: figures(2), contradictions: 0, ns_per_tick: 10, ns_per_edge: null,
});
const bench = (more: Partial<Bench>): Bench =>
  ({ lags_s: [0, 0.002], scenes: [], rows: [], notes: [], requirement: [], traces: [], figure_3a: [], figure_3b: [], figure_5: [], ...more }) as Bench;

describe('the bench', () => {
  const rows = [row('rest', 'kalman', true), row('curve', 'difference', false, figures(4)), row('curve', 'kalman', false, figures(3)), row('curve', 'kalman', true, figures(0.02))];
  it('compares ours with the difference of counts in the first scene that has both', () => {
    expect(benchView(bench({ rows })).verdict).toBe('In scene curve, without lag, kalman + limits has an RMS error of 0.0200 mm/s and 2.00 mm/s²; the difference of counts has 4.00 mm/s and 2.00 mm/s².');
    expect(benchView(bench({ rows: rows.slice(0, 3) })).verdict).toContain('kalman has an RMS error of 3.00');
    expect(benchView(bench({ rows: rows.slice(0, 1) })).verdict).toBe('1 result: every estimator in every scene.');
  });
  it('draws an error over the lag with a dot at the best lag, in ms', () => {
    const [velocity] = lagPlots(bench({ rows }), 'curve', LIGHT);
    expect(velocity?.layers.filter((l) => l.kind === 'line').map((l) => l.name)).toEqual(['difference', 'kalman', 'kalman + limits']);
    // A rms of nought has no logarithm.
    expect(velocity?.layers[0]).toMatchObject({ x: [0, 2], y: [4, null] });
    expect(velocity?.layers.at(-1)).toMatchObject({ kind: 'dots', quiet: true, dots: [{ x: 2, y: 0.5 }] });
  });
  it('gives an estimator one colour in all scenes', () => {
    const colour = (scene: string) => lagPlots(bench({ rows }), scene, LIGHT)[0]?.layers.find((l) => l.name === 'kalman + limits');
    expect((colour('rest') as LayerOf<'line'>).colour).toBe((colour('curve') as LayerOf<'line'>).colour);
  });
  it('names each curve of figure 5 in its own plot, in another colour', () => {
    const plots = figurePlots(bench({ figure_5: [{ name: 'lines', x: [1], y: [2] }, { name: 'count', x: [1], y: [2] }] }), LIGHT);
    expect(plots.slice(2).map((p) => p.title)).toEqual(['Fig. 5: lines', 'Fig. 5: count']);
    const [a, b] = plots.slice(2).map((p) => (p.layers[0] as LayerOf<'line'>).colour);
    expect(a).not.toBe(b);
  });
});

describe('a trace', () => {
  const trace = (name: string): Trace => ({
    name, t_s: [0, 1], true_velocity_mm_s: [6, 5], true_acceleration_mm_s2: [-6, -6], difference_velocity_mm_s: [7, 4], difference_acceleration_mm_s2: [1000, -1000],
    velocity_mm_s: [6.5, 5], velocity_bound_mm_s: [1, null], acceleration_mm_s2: [-5, -7], acceleration_bound_mm_s2: [2, 2],
  });
  it('has the estimate’s error within its bound on both sides', () => {
    const error = tracePlots(trace('s-curve'), LIGHT)[2];
    expect(error?.layers.map((l) => l.kind)).toEqual(['band', 'line']);
    expect(error?.layers[0]).toMatchObject({ low: [-1, null], high: [1, null] });
    expect(error?.layers[1]).toMatchObject({ y: [0.5, 0] });
    expect(error?.y.min).toBe(-(error?.y.max ?? 0));
  });
  // One count is 0.001 mm and a tick 1 ms: 1 mm/s is a count/tick, 1 mm/s² a thousandth of a count/tick².
  it('of the flywheel is in counts, as in the paper', () => {
    const plots = tracePlots(trace('flywheel'), LIGHT);
    expect(plots.map((p) => p.title)).toEqual(['velocity in counts/tick', 'acceleration in counts/tick²', 'error of the estimated velocity in counts/tick', 'enlarged acceleration in counts/tick²']);
    expect(plots[1]?.layers[0]).toMatchObject({ y: [1, -1] });
    expect(plots[3]?.layers.at(-1)).toMatchObject({ name: 'true', y: [-0.006, -0.006] });
    expect(plots[3]?.layers[0]).toMatchObject({ low: [-0.007, -0.009].map((v) => expect.closeTo(v, 12)), high: [-0.003, -0.005].map((v) => expect.closeTo(v, 12)) });
  });
});

describe('the requirement', () => {
  const one: Requirement = { speed_mm_s: 1, clock_s: 1e-7, line_error_counts: 0, jerk_mm_s3: 5000, cycle_hz: 1000, acceleration: false, fine: false, required: 0.01, guaranteed_floor: 0.001, bound: 0.005, guaranteed: 'met', optimum: 1e-4, rms: 2e-4, typical: 'met' };
  it('has a section only where the bench ran it', () => expect(requirement(bench({})).html).toBe(''));
  it('has a button for each jerk limit and each cycle that was run', () => {
    const { html } = requirement(bench({ requirement: [one, { ...one, jerk_mm_s3: 50_000 }, { ...one, cycle_hz: 250 }] }));
    for (const text of ['5000 mm/s³', '50000 mm/s³', '250 Hz', '1000 Hz']) {
      expect(html).toContain(`>${text}<`);
    }
    expect(html.match(/aria-pressed="true"/g)?.length).toBe(5);
  });
});

describe('the page of an estimate', () => {
  const course = (low: (number | null)[], high: (number | null)[], bound: (number | null)[]): Course => ({ low, high, bound });
  const page = (answer: object, more: object = {}) =>
    estimateView({
      log: 'x.csv', count_mm: 0.001, ticks_each: 1, t_s: [0, 1], position_mm: course([0, 1], [0, 1], [null, null]), velocity_mm_s: course([-30, 5], [1, 20], [0.1, 0.2]), acceleration_mm_s2: course([0, 0], [0, 400], [null, null]),
      answer: { estimator: 'kalman', ticks: 2, edges: 0, rows: 2, clock_s: 0, lag_s: 0, jumps: 0, reports: 0, findings: [], complete: true, cycle: null, ...answer }, ...more,
    } as unknown as EstimatePage);
  it('names the largest speed whatever its direction', () => expect(page({}).verdict).toBe('The axis reaches 30.0 mm/s and 400 mm/s².'));
  it('says what bound most ticks keep, and where there is none', () => {
    expect(page({}).body).toContain('±0.100, ±0.100 mm/s');
    expect(page({}).body).toContain('no bound');
  });
  it('lists faults of the log, how many it left out, and where reading stopped', () => {
    expect(page({}).body).not.toContain('Faults in the log');
    const { body } = page({ reports: 12, complete: false, findings: [{ line: 7, what: 'time goes back', to_do: 'mend the clock' }] });
    expect(body).toContain('Line 7: time goes back; mend the clock.');
    expect(body).toContain('11 more faults of these kinds');
    expect(body).toContain('The log was not read to the end');
  });
  it('shows cycles and edges only of logs that have them', () => {
    expect(page({}).body).not.toMatch(/Cycle jitter|Edges/);
    const { body } = page({ edges: 1234, cycle: { mean_s: 0.001, jitter_rms_s: 2e-6, missed_cycles: 3, gaps: 0 } });
    expect(body).toContain('2.00 µs');
    expect(body).toContain('1234');
    expect(page({ clock_s: 1e-7 }).body).toContain('100 ns');
    expect(page({}).body).toContain('exact');
  });
});
