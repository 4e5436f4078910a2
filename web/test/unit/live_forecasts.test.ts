// SPDX-License-Identifier: Apache-2.0
import { expect, it } from 'vitest';
import type { Theme } from '../../src/frame/theme';
import type { Thermal } from '../../src/live/api/types';
import { cyclogramPlot, historyPlot } from '../../src/live/views/heat/plots';
import { shownSteps, stepInForce } from '../../src/live/views/steps';

const steps = (count: number) => Array.from({ length: count }, (_, i) => ({ percent: i, error_um: 0.1 * i, change_um: null }));

it('shows every step of a short table, and of a long one few with both the last and the one in force', () => {
  expect(shownSteps(steps(23), 7).map((s) => s.percent)).toEqual(Array.from({ length: 23 }, (_, i) => 22 - i));
  const long = shownSteps(steps(201), 37).map((s) => s.percent);
  expect(long.length).toBeLessThan(26);
  expect(long[0]).toBe(200);
  expect(long).toContain(37);
  expect([...long].sort((a, b) => b - a)).toEqual(long);
});

it('takes the step nearest to what is in force', () => {
  expect(stepInForce(steps(23), 7.4)).toBe(7);
  expect(stepInForce([], 7)).toBeUndefined();
});

const PAINT: Theme = { scheme: 'light', printing: false, text: '#000', faint: '#555', rule: '#ddd', paper: '#fff', rapid: '#ccc', limit: '#000', run: { without: '#a40', with: '#06c' }, other: ['#000'] };

const thermal: Thermal = {
  share_k: 1,
  passports: [],
  history: { t_s: [0, 1800, 3600], axes: [{ name: 'Z', displacement_um: [0, 2, 4], sd_um: [0, 0.5, 1], offset_um: [0, -2, -4] }] },
  cyclogram: { t_s: [1800, 3600], speed_rpm: [3000, 0], feed_mm_min: [1000, 0], cutting_percent: [90, 0], coolant_percent: [0, 0] },
  outlook: { of_last_s: 600, in_s: [0, 3600], axes: [{ name: 'Z', displacement_um: [4, 1], sd_um: [1, 2], offset_um: [-4, -1] }] },
  next: null,
};

it('draws heat from the past into the next hour on one axis of time', () => {
  const [axis] = thermal.history.axes;
  const plot = historyPlot(axis!, thermal, PAINT);
  expect([plot.x.min, plot.x.max]).toEqual([-1, 1]);
  const band = plot.layers.find((l) => l.kind === 'band');
  expect(band).toMatchObject({ x: [-1, -0.5, 0, 0, 1], low: [0, 1, 2, 2, -3], high: [0, 3, 6, 6, 5] });
  expect(historyPlot(axis!, { ...thermal, outlook: null }, PAINT).x.max).toBe(0);
});

it('draws a mean of the cyclogram over the time that it is the mean of', () => {
  const [cut, speed] = cyclogramPlot(thermal, PAINT).layers;
  expect(cut).toMatchObject({ kind: 'spans', spans: [[-1, -0.5]] });
  expect(speed).toMatchObject({ kind: 'line', step: true, x: [-1, -0.5, 0], y: [3000, 0, 0] });
});
