// SPDX-License-Identifier: Apache-2.0
// The plots of `motion bench`.
import type { Maybe } from '../frame/data';
import type { Theme } from '../frame/theme';
import { span } from '../plot/axes';
import type { Layer } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { type Bench, type Curve, type Row, type Trace, label } from './data';

interface Line {
  name: string;
  colour: string;
  x: readonly Maybe[];
  y: readonly Maybe[];
  width?: number;
  dashed?: boolean;
}
interface Panel {
  title: string;
  x: string;
  lines: Line[];
  dots?: Layer[];
  band?: { x: readonly Maybe[]; low: readonly Maybe[]; high: readonly Maybe[]; colour: string };
  log?: boolean;
  min?: number;
  max?: number;
  group?: string;
}

const BOUND = 'its guaranteed bound';
const BOUND_OPACITY = 0.22;

/** A panel as a plot. */
function plotOf(panel: Panel): Plot {
  const [from, to] = span(panel.lines.flatMap((l) => l.x));
  const y = { name: panel.title, ...(panel.min === undefined ? {} : { min: panel.min }), ...(panel.max === undefined ? {} : { max: panel.max }), log: panel.log ?? false };
  const band: Layer[] = panel.band ? [{ kind: 'band', name: BOUND, ...panel.band, opacity: BOUND_OPACITY }] : [];
  return {
    title: panel.title,
    x: { name: panel.x, min: from, max: to },
    y,
    ...(panel.group === undefined ? {} : { group: panel.group }),
    layers: [...band, ...panel.lines.map((l): Layer => ({ kind: 'line', ...l })), ...(panel.dots ?? [])],
  };
}

const minus = (a: readonly Maybe[], b: readonly Maybe[], scale: number) =>
  a.map((v, i) => (v === null || b[i] == null ? null : (v - (b[i] ?? 0)) * scale));
const times = (a: readonly Maybe[], scale: number) => a.map((v) => (v === null ? null : v * scale));

/** Half of a range that shows nearly all of the values. */
function mostOf(values: readonly Maybe[], share: number): number {
  const sizes = values.filter((v): v is number => v !== null).map(Math.abs).sort((a, b) => a - b);
  return sizes[Math.floor(share * (sizes.length - 1))] ?? 1;
}

function nice(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return ([1, 2, 5, 10].find((m) => m * power >= value) ?? 10) * power;
}

export function tracePlots(trace: Trace, theme: Theme): Plot[] {
  const counts = trace.name === 'flywheel'; // 0.001 mm and 1 ms: 1 mm/s = 1 count/tick
  const units = counts ? ['counts/tick', 'counts/tick²'] : ['mm/s', 'mm/s²'];
  const scale = counts ? 1e-3 : 1;
  const t = trace.t_s;
  const [before, after, truth] = [theme.run.without, theme.run.with, theme.text];
  const band = (bound: readonly Maybe[], by: number) => ({ x: t, low: times(bound, -by), high: times(bound, by), colour: after });
  const error_v = minus(trace.velocity_mm_s, trace.true_velocity_mm_s, 1);
  const error_a = minus(trace.acceleration_mm_s2, trace.true_acceleration_mm_s2, scale);
  const top = (bound: readonly Maybe[], by: number) => nice(2.5 * by * mostOf(bound, 0.5));
  const [tv, ta] = [top(trace.velocity_bound_mm_s, 1), top(trace.acceleration_bound_mm_s2, scale)];
  const x = 'time in s';
  const panels: Panel[] = [
    {
      title: `Velocity, ${units[0]}`,
      x,
      lines: [
        { name: 'difference of counts', colour: before, x: t, y: trace.difference_velocity_mm_s, width: 0.9 },
        { name: 'event-driven, limits known', colour: after, x: t, y: trace.velocity_mm_s, width: 2 },
      ],
    },
    {
      title: `Acceleration, ${units[1]}`,
      x,
      lines: [
        { name: 'difference of counts', colour: before, x: t, y: times(trace.difference_acceleration_mm_s2, scale), width: 0.6 },
        { name: 'event-driven, limits known', colour: after, x: t, y: times(trace.acceleration_mm_s2, scale), width: 2 },
      ],
    },
    {
      title: `Our velocity less the true one, ${units[0]}`,
      x,
      min: -tv,
      max: tv,
      band: band(trace.velocity_bound_mm_s, 1),
      lines: [{ name: 'event-driven, limits known', colour: after, x: t, y: error_v }],
    },
    counts
      ? {
          title: `Acceleration again, enlarged, ${units[1]}`,
          x,
          min: -0.02,
          max: 0.01,
          band: {
            x: t,
            low: minus(times(trace.acceleration_mm_s2, scale), times(trace.acceleration_bound_mm_s2, scale), 1),
            high: minus(times(trace.acceleration_mm_s2, scale), times(trace.acceleration_bound_mm_s2, -scale), 1),
            colour: after,
          },
          lines: [
            { name: 'event-driven, limits known', colour: after, x: t, y: times(trace.acceleration_mm_s2, scale) },
            { name: 'true', colour: truth, x: t, y: times(trace.true_acceleration_mm_s2, scale), dashed: true, width: 1 },
          ],
        }
      : {
          title: `Our acceleration less the true one, ${units[1]}`,
          x,
          min: -ta,
          max: ta,
          band: band(trace.acceleration_bound_mm_s2, scale),
          lines: [{ name: 'event-driven, limits known', colour: after, x: t, y: error_a }],
        },
  ];
  return panels.map((p) => plotOf({ ...p, group: trace.name }));
}

const positive = (v: Maybe) => (v !== null && v > 0 ? v : null);

/** Each estimator's error over the lag, with a dot at the lag that suits it best. */
function lagPanel(bench: Bench, scene: string, quantity: 'velocity' | 'acceleration', theme: Theme): Panel {
  const names = [...new Set(bench.rows.map(label))];
  const lags = bench.lags_s.map((s) => s * 1000);
  const rows = bench.rows.filter((r: Row) => r.scene === scene && positive(r[quantity].rms) !== null);
  const colourOf = (r: Row) => theme.other[names.indexOf(label(r)) % theme.other.length] ?? theme.text;
  const best = (r: Row) => {
    const { own_lag_s, rms_at_own_lag } = r[quantity];
    return own_lag_s === null || rms_at_own_lag === null ? [] : [{ x: own_lag_s * 1000, y: rms_at_own_lag }];
  };
  return {
    title: quantity === 'velocity' ? 'RMS error of velocity, mm/s' : 'RMS error of acceleration, mm/s²',
    x: 'lag in ms',
    log: true,
    group: 'lag',
    lines: rows.map((r) => ({ name: label(r), colour: colourOf(r), x: lags, y: r[quantity].rms_at_lag.map(positive), width: r.estimator === 'kalman' ? 2.4 : 1.4 })),
    dots: rows.map((r): Layer => ({ kind: 'dots', name: `${label(r)}: best lag`, quiet: true, dots: best(r), colour: colourOf(r), size: 7 })),
  };
}

export function lagPlots(bench: Bench, scene: string, theme: Theme): Plot[] {
  return (['velocity', 'acceleration'] as const).map((quantity) => plotOf(lagPanel(bench, scene, quantity, theme)));
}

export function figurePlots(bench: Bench, theme: Theme): Plot[] {
  const colours = [0, 2, 3].map((i) => theme.other[i] ?? theme.text);
  const lines = (curves: readonly Curve[], palette: readonly string[]) =>
    curves.map((c, i) => ({ name: c.name, colour: palette[i % palette.length] ?? theme.text, x: c.x, y: c.y, width: 1.8 }));
  const [most, count] = bench.figure_5;
  return [
    { title: 'Fig. 3a: counts/tick', x: 'feed in mm/min', lines: lines(bench.figure_3a, colours) },
    { title: 'Fig. 3b: counts/tick²', x: 'overload in g', lines: lines(bench.figure_3b, colours) },
    { title: `Fig. 5: ${most?.name ?? ''}`, x: 'feed in mm/min', log: true, lines: lines(most ? [most] : [], colours) },
    { title: `Fig. 5: ${count?.name ?? ''}`, x: 'feed in mm/min', lines: lines(count ? [count] : [], colours.slice(1)) },
  ].map(plotOf);
}
