// SPDX-License-Identifier: Apache-2.0
// A displacement over the hours of a log: measured, modelled, and the residual.
import type { Maybe } from '../frame/data';
import { plain, um } from '../frame/numbers';
import type { Theme } from '../frame/theme';
import { axisFor } from '../plot/axes';
import { type Layer, rules } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { reading } from '../plot/reading';
import { spindlePlot } from '../plot/speed';
import { nearestIndex } from '../plot/thin';
import { largestSize, minus, quantile } from '../plot/values';
import { BAND, bandEdges, bandLayer } from './band';
import type { MeasuredCourse, SpeedSteps } from './data';

/** More time than this many usual steps is a gap. */
const GAP_STEPS = 10;

/** A curve over time, with a hole wherever the log has one. */
export function broken(t: readonly number[], values: readonly Maybe[]): { t: number[]; v: Maybe[] } {
  const steps = t.slice(1).map((v, i) => v - (t[i] as number));
  const usual = quantile(steps, 0.5) ?? 0;
  const out = { t: [] as number[], v: [] as Maybe[] };
  t.forEach((at, i) => {
    if (i > 0 && at - (t[i - 1] as number) > GAP_STEPS * usual) {
      out.t.push(at);
      out.v.push(null);
    }
    out.t.push(at);
    out.v.push(values[i] ?? null);
  });
  return out;
}

/** An axis, and the column of the log that it comes from. */
export const nameOf = (axis: MeasuredCourse) => (axis.channel === axis.axis ? axis.axis : `${axis.axis} (${axis.channel})`);

const residual = (axis: MeasuredCourse) => minus(axis.measured_um, axis.modelled_um);
const time = (axis: MeasuredCourse) => ({ name: 'log time in h', min: axis.t_h[0] ?? 0, max: axis.t_h.at(-1) ?? 1 });

/** Readings were used for a part of the log only. */
export function goesOn(axis: MeasuredCourse): boolean {
  return axis.fitted_to_h > axis.fitted_from_h && (axis.t_h.at(-1) ?? 0) > axis.fitted_to_h * (1 + 1e-6);
}

/** Shades the part of the log whose readings were used; nothing if they all were. */
function used(axis: MeasuredCourse, theme: Theme): Layer[] {
  return goesOn(axis) ? [{ kind: 'spans', name: 'readings used', spans: [[axis.fitted_from_h, axis.fitted_to_h]], colour: theme.faint, opacity: 0.1 }] : [];
}

/** Is the model fitted to what was measured, or does it forecast it? */
export type Model = 'modelled' | 'forecast';

/** What is under the pointer at a time of the log. */
function readAt(axis: MeasuredCourse, t: number, lines: (i: number) => string[]): string {
  const i = nearestIndex(axis.t_h, t);
  return reading(`${plain(axis.t_h[i])} h`, lines(i));
}

const BAND_NAME = '95 % band of the model';

/** A forecast has its 95 % band about it. */
export function coursePlot(axis: MeasuredCourse, model: Model, theme: Theme): Plot {
  const banded = model === 'forecast';
  const edges = banded ? bandEdges(axis.modelled_um, axis.sd_um).flat() : [];
  const measured = broken(axis.t_h, axis.measured_um);
  const modelled = broken(axis.t_h, axis.modelled_um);
  const rest = residual(axis);
  return {
    title: `${nameOf(axis)}: measured and ${model}`,
    x: time(axis),
    y: axisFor(`displacement ${nameOf(axis)} in µm`, [...axis.measured_um, ...axis.modelled_um, ...edges], true),
    group: 'time',
    layers: [
      ...used(axis, theme),
      rules('y', [0], theme.faint),
      ...(banded ? [bandLayer(BAND_NAME, axis.t_h, axis.modelled_um, axis.sd_um, theme.run.with)] : []),
      { kind: 'line', name: 'measured', x: measured.t, y: measured.v, colour: theme.run.without, width: 4 },
      { kind: 'line', name: model, x: modelled.t, y: modelled.v, colour: theme.run.with, width: 1.6 },
    ],
    readout: (t) => readAt(axis, t, (i) => [`measured ${um(axis.measured_um[i])}`, `${model} ${um(axis.modelled_um[i])}`, `residual ${um(rest[i])}`]),
  };
}

export function residualPlot(axis: MeasuredCourse, model: Model, theme: Theme): Plot {
  const rest = residual(axis);
  const zero = axis.t_h.map(() => 0);
  const shown = broken(axis.t_h, rest);
  const name = `residual of ${nameOf(axis)} (measured − ${model}) in µm`;
  const { max } = axisFor(name, [0, largestSize([...rest, ...bandEdges(zero, axis.sd_um).flat()])], true);
  return {
    title: `${nameOf(axis)}: measured − ${model}`,
    x: time(axis),
    y: { name, min: -max, max },
    group: 'time',
    layers: [
      ...used(axis, theme),
      bandLayer(BAND_NAME, axis.t_h, zero, axis.sd_um, theme.run.with),
      rules('y', [0], theme.faint),
      { kind: 'line', name: 'residual', x: shown.t, y: shown.v, colour: theme.run.without, width: 1.6 },
    ],
    readout: (t) => readAt(axis, t, (i) => [`residual ${um(rest[i])}`, `95 % band ±${um(BAND * (axis.sd_um[i] ?? 0))}`]),
  };
}

export function speedPlot(speed: SpeedSteps, axis: MeasuredCourse, theme: Theme): Plot {
  const end = axis.t_h.at(-1) ?? 0;
  return spindlePlot({
    x: time(axis),
    group: 'time',
    t: speed.t_h.flatMap((t, i) => [t, speed.t_h[i + 1] ?? Math.max(t, end)]),
    rpm: speed.speed_rpm.flatMap((v) => [v, v]),
    colour: theme.faint,
    withZero: true,
    beneath: used(axis, theme),
  });
}
