// SPDX-License-Identifier: Apache-2.0
// The plots of `motion bench`.
import type { Maybe } from '../frame/data';
import { type Theme, curveColour } from '../frame/theme';
import { type Axis, niceStep, span } from '../plot/axes';
import type { Layer, LayerOf } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { minus, plus, quantile, scaled } from '../plot/values';
import { type Bench, type Curve, type Row, type Trace, label } from './data';

type Curves = LayerOf<'line'> & { name: string };

/** Curves over the whole of their x; `above`: dots, `beneath`: bands. */
function curvesPlot(title: string, xName: string, curves: readonly Curves[], more: { y?: Partial<Axis>; group?: string; beneath?: Layer[]; above?: Layer[] } = {}): Plot {
  const [min, max] = span(curves.flatMap((c) => c.x));
  return {
    title,
    x: { name: xName, min, max },
    y: { name: title, ...more.y },
    ...(more.group === undefined ? {} : { group: more.group }),
    layers: [...(more.beneath ?? []), ...curves, ...(more.above ?? [])],
  };
}

/** Of most of the bounds two and a half times: a range that shows them and cuts the few that are very wide. */
function range(bound: readonly Maybe[]): { min: number; max: number } {
  const max = niceStep(2.5 * (quantile(bound, 0.5) ?? 1), 1);
  return { min: -max, max };
}

/** Counts with a resolution of 0.001 mm and ticks of 1 ms: 1 mm/s is 1 count/tick. */
const isInCounts = (trace: Trace) => trace.name === 'flywheel';
const COUNTS_PER_MM_S2 = 1e-3;

/** One quantity of a trace, in its unit. */
interface Quantity {
  name: string;
  unit: string;
  truth: readonly Maybe[];
  difference: readonly Maybe[];
  estimate: readonly Maybe[];
  bound: readonly Maybe[];
}

function quantities(trace: Trace): [Quantity, Quantity] {
  const counts = isInCounts(trace);
  const acceleration = (values: readonly Maybe[]) => scaled(values, counts ? COUNTS_PER_MM_S2 : 1);
  return [
    {
      name: 'velocity',
      unit: counts ? 'counts/tick' : 'mm/s',
      truth: trace.true_velocity_mm_s,
      difference: trace.difference_velocity_mm_s,
      estimate: trace.velocity_mm_s,
      bound: trace.velocity_bound_mm_s,
    },
    {
      name: 'acceleration',
      unit: counts ? 'counts/tick²' : 'mm/s²',
      truth: acceleration(trace.true_acceleration_mm_s2),
      difference: acceleration(trace.difference_acceleration_mm_s2),
      estimate: acceleration(trace.acceleration_mm_s2),
      bound: acceleration(trace.acceleration_bound_mm_s2),
    },
  ];
}

const TIME = 'time in s';
const ESTIMATE = 'event-driven, limits known';

function beforeAndAfter({ name, unit, difference, estimate }: Quantity, trace: Trace, theme: Theme): Plot {
  return curvesPlot(
    `${name} in ${unit}`,
    TIME,
    [
      { kind: 'line', name: 'difference of counts', colour: theme.run.without, x: trace.t_s, y: difference, width: name === 'velocity' ? 0.9 : 0.6 },
      { kind: 'line', name: ESTIMATE, colour: theme.run.with, x: trace.t_s, y: estimate, width: 2 },
    ],
    { group: trace.name },
  );
}

function boundBand(trace: Trace, low: readonly Maybe[], high: readonly Maybe[], theme: Theme): Layer {
  return { kind: 'band', name: 'its guaranteed bound', x: trace.t_s, low, high, colour: theme.run.with, opacity: 0.22 };
}

function errorPlot({ name, unit, truth, estimate, bound }: Quantity, trace: Trace, theme: Theme): Plot {
  const error: Curves = { kind: 'line', name: ESTIMATE, colour: theme.run.with, x: trace.t_s, y: minus(estimate, truth) };
  return curvesPlot(`error of the estimated ${name} in ${unit}`, TIME, [error], { group: trace.name, y: range(bound), beneath: [boundBand(trace, scaled(bound, -1), bound, theme)] });
}

/** The flywheel's constant deceleration is so small that only an enlarged plot shows it. */
function enlargedPlot({ name, unit, truth, estimate, bound }: Quantity, trace: Trace, theme: Theme): Plot {
  return curvesPlot(
    `enlarged ${name} in ${unit}`,
    TIME,
    [
      { kind: 'line', name: ESTIMATE, colour: theme.run.with, x: trace.t_s, y: estimate },
      { kind: 'line', name: 'true', colour: theme.text, x: trace.t_s, y: truth, dashed: true, width: 1 },
    ],
    { group: trace.name, y: { min: -0.02, max: 0.01 }, beneath: [boundBand(trace, minus(estimate, bound), plus(estimate, bound), theme)] },
  );
}

export function tracePlots(trace: Trace, theme: Theme): Plot[] {
  const [velocity, acceleration] = quantities(trace);
  const last = isInCounts(trace) ? enlargedPlot : errorPlot;
  return [beforeAndAfter(velocity, trace, theme), beforeAndAfter(acceleration, trace, theme), errorPlot(velocity, trace, theme), last(acceleration, trace, theme)];
}

/** What has no logarithm is a gap. */
const positive = (v: Maybe) => (v !== null && v > 0 ? v : null);

/** Each estimator's error over the lag, with a dot at its best lag. */
function lagPlot(bench: Bench, scene: string, quantity: 'velocity' | 'acceleration', theme: Theme): Plot {
  const names = [...new Set(bench.rows.map(label))];
  const lags_ms = bench.lags_s.map((s) => s * 1000);
  const rows = bench.rows.filter((r) => r.scene === scene && positive(r[quantity].rms) !== null);
  const colourOf = (r: Row) => curveColour(theme, names.indexOf(label(r)));
  const best = (r: Row) => {
    const { own_lag_s, rms_at_own_lag } = r[quantity];
    return own_lag_s === null || rms_at_own_lag === null ? [] : [{ x: own_lag_s * 1000, y: rms_at_own_lag }];
  };
  return curvesPlot(
    `RMS error of ${quantity} in ${quantity === 'velocity' ? 'mm/s' : 'mm/s²'}`,
    'lag in ms',
    rows.map((r) => ({ kind: 'line', name: label(r), colour: colourOf(r), x: lags_ms, y: r[quantity].rms_at_lag.map(positive), width: r.estimator === 'kalman' ? 2.4 : 1.4 })),
    { group: 'lag', y: { log: true }, above: rows.map((r) => ({ kind: 'dots', name: `${label(r)}: best lag`, quiet: true, dots: best(r), colour: colourOf(r), size: 7 })) },
  );
}

export function lagPlots(bench: Bench, scene: string, theme: Theme): Plot[] {
  return (['velocity', 'acceleration'] as const).map((quantity) => lagPlot(bench, scene, quantity, theme));
}

/** Blue, orange, green of the palette: curves beside one another that must not be confused. */
const DISTINCT = [0, 2, 3];

export function figurePlots(bench: Bench, theme: Theme): Plot[] {
  const lines = (curves: readonly (Curve | undefined)[], from = 0): Curves[] =>
    curves.flatMap((c, i) => (c ? [{ kind: 'line', name: c.name, colour: curveColour(theme, DISTINCT[(from + i) % DISTINCT.length] ?? 0), x: c.x, y: c.y, width: 1.8 }] : []));
  const [most, count] = bench.figure_5;
  const feed = 'feed in mm/min';
  return [
    curvesPlot('Fig. 3a: counts/tick', feed, lines(bench.figure_3a)),
    curvesPlot('Fig. 3b: counts/tick²', 'overload in g', lines(bench.figure_3b)),
    curvesPlot(`Fig. 5: ${most?.name ?? ''}`, feed, lines([most]), { y: { log: true } }),
    curvesPlot(`Fig. 5: ${count?.name ?? ''}`, feed, lines([count], 1)),
  ];
}
