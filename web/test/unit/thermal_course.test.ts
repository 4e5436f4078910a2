// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { theme } from '../../src/frame/theme';
import type { LayerOf } from '../../src/plot/layers';
import type { Plot } from '../../src/plot/plot';
import { broken, coursePlot, goesOn, nameOf, residualPlot, speedPlot } from '../../src/thermal/course';
import type { FitPage, FittedAxis, MeasuredCourse, Over, ReplayPage } from '../../src/thermal/data';
import { hysteresisPlot, speeds, told } from '../../src/thermal/hysteresis';
import { replayView } from '../../src/thermal/replay';

const LIGHT = theme(true);
const axis = (more: Partial<MeasuredCourse> = {}): MeasuredCourse => ({
  axis: 'Z', channel: 'Z', fitted_from_h: 0, fitted_to_h: 4, t_h: [0, 1, 2, 3, 4], measured_um: [0, 5, 9, 12, 14], modelled_um: [0, 4, 10, 12, 13], sd_um: [1, 1, 1, 1, 1], ...more,
});
const layer = <K extends LayerOf<'line'>['kind'] | 'band' | 'spans' | 'dots' | 'rules'>(plot: Plot, name: string) => plot.layers.find((l) => l.name === name) as LayerOf<K> | undefined;

describe('a curve over a log', () => {
  it('has a hole where the log has one: more than ten usual steps', () => {
    const t = [0, 1, 2, 3, 13, 24.5, 25.5];
    expect(broken(t, t)).toEqual({ t: [0, 1, 2, 3, 13, 24.5, 24.5, 25.5], v: [0, 1, 2, 3, 13, null, 24.5, 25.5] });
  });
  it('keeps missing values as gaps', () => expect(broken([0, 1, 2], [1, null]).v).toEqual([1, null, null]));
  it('is named after the column that it comes from', () => expect([nameOf(axis()), nameOf(axis({ channel: 'probe_3' }))]).toEqual(['Z', 'Z (probe_3)']));
});

describe('the part of a log whose readings were used', () => {
  it('is shaded where the log goes on after it', () => {
    const part = axis({ fitted_to_h: 2 });
    expect([goesOn(part), goesOn(axis()), goesOn(axis({ fitted_from_h: 2, fitted_to_h: 2 }))]).toEqual([true, false, false]);
    expect(layer<'spans'>(coursePlot(part, 'forecast', LIGHT), 'readings used')?.spans).toEqual([[0, 2]]);
    expect(layer(coursePlot(axis(), 'forecast', LIGHT), 'readings used')).toBeUndefined();
  });
});

describe('measured against the model', () => {
  it('has its band about a forecast, but not about a fit', () => {
    expect(layer<'band'>(coursePlot(axis(), 'forecast', LIGHT), '95 % band of the model')?.high[2]).toBeCloseTo(11.96, 12);
    expect(layer(coursePlot(axis(), 'modelled', LIGHT), '95 % band of the model')).toBeUndefined();
  });
  it('leaves measured minus modelled', () => {
    const plot = residualPlot(axis(), 'modelled', LIGHT);
    expect(layer<'line'>(plot, 'residual')?.y).toEqual([0, 1, -1, 0, 1]);
    // About zero, with room for the band of ±1.96.
    expect(plot.y.min).toBe(-(plot.y.max ?? 0));
    expect(plot.y.max).toBeGreaterThan(1.96);
  });
  it('says at the pointer what was measured, modelled and left', () => {
    expect(coursePlot(axis(), 'forecast', LIGHT).readout?.(2.2, 0, 1)).toBe('<b>2 h</b><br>measured 9.0\u00a0µm<br>forecast 10.0\u00a0µm<br>residual −1.0\u00a0µm');
    expect(residualPlot(axis(), 'forecast', LIGHT).readout?.(2.2, 0, 1)).toContain('95 % band ±2.0\u00a0µm');
  });
});

describe('the spindle speed under it', () => {
  it('is held from step to step and to the end of the log', () => {
    const line = speedPlot({ t_h: [0, 1.5], speed_rpm: [3000, 0] }, axis(), LIGHT).layers.find((l) => l.kind === 'line') as LayerOf<'line'>;
    expect([line.x, line.y]).toEqual([[0, 1.5, 1.5, 4], [3000, 3000, 0, 0]]);
  });
});

describe('a passport tried on a log', () => {
  const view = (rms_um: number | null) =>
    replayView({ title: 'l', answer: { minutes: 240, axes: [{ axis: 'Z', end_um: 13, end_sd_um: 2, points: 5, rms_um, coverage: rms_um === null ? null : 0.8 }], notes: [] }, speed: { t_h: [], speed_rpm: [] }, axes: [axis(rms_um === null ? { measured_um: [null] } : { fitted_to_h: 2 })] } as unknown as ReplayPage);
  it('says how well it holds', () => {
    expect(view(1.25).verdict).toBe('<b>Z</b>: at the end 13.0\u00a0± 3.9\u00a0µm; RMS error 1.25\u00a0µm against the readings, of which the 95 % band holds 80.0\u00a0%.');
    expect(view(1.25).body).toContain('Shaded: readings set the state');
  });
  it('says so where nothing was measured, and draws no residual', () => {
    expect(view(null).verdict).toContain('not measured');
    expect([view(null).body.includes('residual-0'), view(1).body.includes('residual-0')]).toEqual([false, true]);
  });
});

describe('displacement over temperature', () => {
  const over: Over = { correlation: 0.876, mean_c: 25, mean_um: 10, slope_um_k: 2, residual_rms_um: 3.25, spread_um: 12, spread_at_c: 26, spread_from_um: 4 };
  const fitted: FittedAxis = { ...axis(), best_sensor: 0, over: [over], displacement_um: [[0, 10], [5, 20], [1]] };
  const regime = (speed_rpm: number, temperature: number[]) => ({ speed_rpm, start_h: 2, hours: 1, t_h: [2, 3], temperature_c: [temperature] });
  const page = { sensors: ['T1'], regimes: [regime(6000, [20, 30]), regime(2000, [22, 28]), regime(0, [20])] } as unknown as FitPage;
  const plot = hysteresisPlot(page, fitted, 0, LIGHT);

  it('names each speed once, from slow to fast', () => {
    expect(speeds([...page.regimes, regime(2000, [])])).toEqual([0, 2000, 6000]);
    expect(plot.layers.filter((l) => l.kind === 'line' && l.name !== undefined).map((l) => l.name)).toEqual(['best straight line', 'stopped', '2000\u00a0rpm', '6000\u00a0rpm']);
  });
  it('has its line through the means, as least squares do', () => {
    const line = layer<'line'>(plot, 'best straight line');
    // Slope 2 through (25, 10), drawn from 20 to 30 °C.
    expect([line?.x, line?.y]).toEqual([[20, 30], [0, 20]]);
  });
  it('has a ring where a turning spindle starts', () => expect(plot.layers.filter((l) => l.name === 'start of a run').length).toBe(2));
  it('reads the nearest sample, and nothing far from all', () => {
    expect(plot.readout?.(29.8, 10, 1)).toBe('<b>6000\u00a0rpm after 1 h</b><br>30.0\u00a0°C, 10.0\u00a0µm');
    expect(plot.readout?.(20.1, 20, 1)).toBeUndefined();
  });
  it('says how little one temperature tells', () => expect(told(over)).toContain('around 26.0\u00a0°C, displacements differ by up to <b>12.0\u00a0µm</b>'));
});
