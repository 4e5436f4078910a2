// SPDX-License-Identifier: Apache-2.0
// Position, velocity and acceleration from an encoder log, with their guaranteed bounds.
import type { Maybe } from '../frame/data';
import { capital, escapeHtml, section } from '../frame/html';
import { counted, digits, fixed, plain } from '../frame/numbers';
import { type Figure, figures } from '../frame/table';
import type { Theme } from '../frame/theme';
import { type View, said } from '../frame/view';
import { axisFor } from '../plot/axes';
import type { Layer } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { known, largestSize, plus, quantile, scaled } from '../plot/values';
import type { Course, EstimatePage } from './data';

/** The bound that such a share of the ticks keeps. */
const boundOf = (course: Course, share: number) => quantile(course.bound, share) ?? 0;
/** Nearly the widest: a bound may be very wide while an estimator starts up. */
const NEARLY_ALL = 0.99;

/** Bands and lines without holes: a polygon has none. */
function solid(t: readonly number[], low: readonly Maybe[], high: readonly Maybe[]): { x: number[]; low: number[]; high: number[] } {
  const at = t.map((_, i) => i).filter((i) => known(low[i]) && known(high[i]));
  return { x: at.map((i) => t[i] as number), low: at.map((i) => low[i] as number), high: at.map((i) => high[i] as number) };
}

function coursePlot(page: EstimatePage, name: string, unit: string, course: Course, theme: Theme): Plot {
  const wide = boundOf(course, NEARLY_ALL);
  const values = [...course.low, ...course.high].filter(known);
  const middle = scaled(plus(course.low, course.high), 0.5);
  const layers: Layer[] = [];
  const bound = solid(page.t_s, plus(course.low, course.bound, -1), plus(course.high, course.bound));
  if (bound.x.length > 0) {
    layers.push({ kind: 'band', name: 'guaranteed bound', ...bound, colour: theme.run.with, opacity: 0.22 });
  }
  if (page.ticks_each > 1) {
    layers.push({ kind: 'band', name: 'lowest to highest', ...solid(page.t_s, course.low, course.high), colour: theme.run.with, opacity: 0.75 });
  }
  layers.push({ kind: 'line', name: page.ticks_each > 1 ? `middle of ${page.ticks_each} ticks` : 'estimate', x: page.t_s, y: middle, colour: theme.run.with, width: 1.6 });
  return {
    title: capital(name),
    x: { name: 'time in s', min: page.t_s[0] ?? 0, max: page.t_s.at(-1) ?? 1 },
    y: axisFor(`${name} in ${unit}`, [...values, ...values.map((v) => v - wide), ...values.map((v) => v + wide)]),
    group: 'time',
    layers,
  };
}

function largest(course: Course): number {
  return Math.max(largestSize(course.low), largestSize(course.high));
}

function knownTo(course: Course, unit: string): string {
  return course.bound.some(known) ? `±${digits(boundOf(course, 0.5))}, ±${digits(boundOf(course, NEARLY_ALL))} ${unit}` : 'no bound';
}

function findings({ answer }: EstimatePage): string {
  const unsaid = answer.reports - answer.findings.length;
  return said('findings', [
    ...answer.findings.map((f) => `line ${f.line}: ${f.what}; ${f.to_do}`),
    ...(unsaid > 0 ? [`${fixed(unsaid, 0)} more faults of these kinds`] : []),
    ...(answer.complete ? [] : ['the log was not read to the end; the estimates stop there']),
  ]);
}

function rowsOf({ answer: a, ...page }: EstimatePage): Figure[] {
  const cycle = a.cycle
    ? [
        { label: 'Cycle', value: `${plain(a.cycle.mean_s * 1000, 6)} ms` },
        { label: 'Cycle jitter, RMS', value: `${digits(a.cycle.jitter_rms_s * 1e6)} µs` },
        { label: 'Missed cycles', value: fixed(a.cycle.missed_cycles, 0) },
        { label: 'Gaps', value: fixed(a.cycle.gaps, 0) },
      ]
    : [];
  return [
    { label: 'Estimator', value: escapeHtml(a.estimator) },
    { label: 'Ticks', value: fixed(a.ticks, 0) },
    ...(a.edges > 0 ? [{ label: 'Edges', value: fixed(a.edges, 0) }] : []),
    ...cycle,
    { label: 'Time stamp resolution', value: a.clock_s > 0 ? `${plain(a.clock_s * 1e9)} ns` : 'exact' },
    { label: 'Lag', value: `${plain(a.lag_s * 1000)} ms` },
    { label: 'Peak velocity', value: `${digits(largest(page.velocity_mm_s))} mm/s` },
    { label: 'Peak acceleration', value: `${digits(largest(page.acceleration_mm_s2))} mm/s²` },
    { label: 'Velocity bound at 50 %, 99 % of ticks', value: knownTo(page.velocity_mm_s, 'mm/s') },
    { label: 'Acceleration bound at 50 %, 99 % of ticks', value: knownTo(page.acceleration_mm_s2, 'mm/s²') },
    { label: 'Faults found in the log', value: fixed(a.reports, 0) },
  ];
}

export function estimateView(page: EstimatePage): View {
  const a = page.answer;
  const found = findings(page);
  return {
    product: 'Steadyrest motion estimate',
    title: page.log,
    facts: `count <b>${plain(page.count_mm)} mm</b> · <b>${counted(a.ticks, 'tick', 'ticks')}</b> · estimator <b>${escapeHtml(a.estimator)}</b>`,
    verdict: `The axis reaches ${digits(largest(page.velocity_mm_s))} mm/s and ${digits(largest(page.acceleration_mm_s2))} mm/s².`,
    body: (found === '' ? '' : section('Faults in the log', found)) + section('Axis motion', host('position') + host('velocity', 'high') + host('acceleration', 'high')) + section('Figures', figures(rowsOf(page))),
    explanation: [
      ['Estimate', 'The motion at each tick, from the counts and, if the log has them, the times of the edges. With a lag, the value at a tick is that of so long before.'],
      ['Guaranteed bound', 'The true value lies within the shaded band as long as the axis keeps the limits given and the clock keeps its period. Some estimators give no bound. A bound is wide while an estimator starts up and when the axis hardly moves.'],
      ['Stretches', 'A long log is drawn in stretches of many ticks, each from its lowest to its highest value, so no peak is lost. The table that the command writes has every tick.'],
    ],
    draw: (theme) => {
      plot('position', coursePlot(page, 'position', 'mm', page.position_mm, theme), theme);
      plot('velocity', coursePlot(page, 'velocity', 'mm/s', page.velocity_mm_s, theme), theme);
      plot('acceleration', coursePlot(page, 'acceleration', 'mm/s²', page.acceleration_mm_s2, theme), theme);
    },
  };
}
