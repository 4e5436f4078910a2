// SPDX-License-Identifier: Apache-2.0
// A displacement over the hours of a log: measured, modelled, and what is left.
import type { Maybe } from '../frame/data';
import { fixed, plain } from '../frame/numbers';
import type { Theme } from '../frame/theme';
import { roomy, span } from '../plot/axes';
import type { Layer } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { nearestIndex } from '../plot/thin';
import type { MeasuredCourse, SpeedSteps } from './data';

/** 95 % of what is measured lies within that many standard deviations. */
export const BAND = 1.96;
/** More time than so many usual steps is a gap. */
const GAP_STEPS = 10;

/** A curve over time with a hole where time has passed that is not recorded. */
export function broken(t: readonly number[], values: readonly Maybe[]): { t: number[]; v: Maybe[] } {
  const steps = t.slice(1).map((v, i) => v - (t[i] as number));
  const usual = [...steps].sort((a, b) => a - b)[Math.floor(steps.length / 2)] ?? 0;
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

/** An axis, and the column of the log that it is taken from. */
export const nameOf = (axis: MeasuredCourse) => (axis.channel === axis.axis ? axis.axis : `${axis.axis} (${axis.channel})`);

function left(axis: MeasuredCourse): Maybe[] {
  return axis.measured_um.map((v, i) => {
    const model = axis.modelled_um[i];
    return v === null || model === null || model === undefined ? null : v - model;
  });
}

const wide = (axis: MeasuredCourse) => axis.sd_um.map((sd) => BAND * (sd ?? 0));
const time = (axis: MeasuredCourse) => ({ name: 'time of the log in h', min: axis.t_h[0] ?? 0, max: axis.t_h.at(-1) ?? 1 });

/** Readings were used up to somewhere before the end. */
export function goesOn(axis: MeasuredCourse): boolean {
  return axis.fitted_to_h > axis.fitted_from_h && (axis.t_h.at(-1) ?? 0) > axis.fitted_to_h * (1 + 1e-6);
}

/** Shaded: where readings were used. Nothing where that is all. */
function used(axis: MeasuredCourse, theme: Theme): Layer[] {
  return !goesOn(axis) ? [] : [{ kind: 'spans', name: 'readings were used', spans: [[axis.fitted_from_h, axis.fitted_to_h]], colour: theme.faint, opacity: 0.1 }];
}

/** Is the model fitted to what was measured, or does it forecast it? */
export type Model = 'modelled' | 'forecast';

/** A forecast has its 95 % band about it. */
export function coursePlot(axis: MeasuredCourse, model: Model, theme: Theme): Plot {
  const banded = model === 'forecast';
  const half = wide(axis);
  const edge = (sign: number) => axis.modelled_um.map((v, i) => (v === null ? null : v + sign * (half[i] ?? 0)));
  const [min, max] = roomy([...axis.measured_um, ...axis.modelled_um, ...(banded ? [...edge(-1), ...edge(1)] : [])], true);
  const measured = broken(axis.t_h, axis.measured_um);
  const modelled = broken(axis.t_h, axis.modelled_um);
  const rest = left(axis);
  return {
    title: `${nameOf(axis)}: measured and ${model}`,
    x: time(axis),
    y: { name: `displacement ${nameOf(axis)} in µm`, min, max },
    group: 'time',
    layers: [
      ...used(axis, theme),
      { kind: 'rules', at: [0], axis: 'y', colour: theme.faint },
      ...(banded ? [{ kind: 'band', name: 'the 95 % band of the model', x: axis.t_h, low: edge(-1), high: edge(1), colour: theme.run.with, opacity: 0.18 } as Layer] : []),
      { kind: 'line', name: 'measured', x: measured.t, y: measured.v, colour: theme.run.without, width: 4 },
      { kind: 'line', name: model, x: modelled.t, y: modelled.v, colour: theme.run.with, width: 1.6 },
    ],
    readout: (t) => {
      const i = nearestIndex(axis.t_h, t);
      return `<b>${plain(axis.t_h[i])} h</b><br>measured ${fixed(axis.measured_um[i], 1)} µm<br>${model} ${fixed(axis.modelled_um[i], 1)} µm<br>left ${fixed(rest[i], 1)} µm`;
    },
  };
}

export function residualPlot(axis: MeasuredCourse, model: Model, theme: Theme): Plot {
  const rest = left(axis);
  const half = wide(axis);
  const shown = broken(axis.t_h, rest);
  const [low, high] = span([...rest, ...half, ...half.map((v) => -v)]);
  const [, max] = roomy([0, Math.max(-low, high)], true);
  return {
    title: `${nameOf(axis)}: measured less ${model}`,
    x: time(axis),
    y: { name: `${nameOf(axis)}: measured less ${model} in µm`, min: -max, max },
    group: 'time',
    layers: [
      ...used(axis, theme),
      { kind: 'band', name: 'the 95 % band of the model', x: axis.t_h, low: half.map((v) => -v), high: half, colour: theme.run.with, opacity: 0.18 },
      { kind: 'rules', at: [0], axis: 'y', colour: theme.faint },
      { kind: 'line', name: `measured less ${model}`, x: shown.t, y: shown.v, colour: theme.run.without, width: 1.6 },
    ],
    readout: (t) => {
      const i = nearestIndex(axis.t_h, t);
      return `<b>${plain(axis.t_h[i])} h</b><br>left ${fixed(rest[i], 1)} µm<br>95 % band ±${fixed(half[i], 1)} µm`;
    },
  };
}

export function speedPlot(speed: SpeedSteps, axis: MeasuredCourse, theme: Theme): Plot {
  const end = axis.t_h.at(-1) ?? 0;
  const at = speed.t_h.flatMap((t, i) => [t, speed.t_h[i + 1] ?? Math.max(t, end)]);
  const rpm = speed.speed_rpm.flatMap((v) => [v, v]);
  const [min, max] = roomy(rpm, true);
  return {
    title: 'Spindle speed',
    x: time(axis),
    y: { name: 'spindle speed in rev/min', min, max },
    group: 'time',
    layers: [...used(axis, theme), { kind: 'line', name: 'spindle speed', x: at, y: rpm, colour: theme.faint, width: 2 }],
  };
}

export const um = (v: Maybe | undefined) => (v === null || v === undefined ? '–' : `${fixed(v, 2)}\u00a0µm`);
