// SPDX-License-Identifier: Apache-2.0
// Position, velocity and acceleration out of an encoder's log, with what is guaranteed of them.
import type { Head, Maybe } from '../frame/data';
import { escapeHtml, section } from '../frame/html';
import { digits, fixed, plain } from '../frame/numbers';
import { figures } from '../frame/table';
import type { Theme } from '../frame/theme';
import { type View, said } from '../frame/view';
import { roomy } from '../plot/axes';
import type { Layer } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';

/** Of each stretch of ticks the lowest and the highest value, and the widest bound; null: none. */
interface Course {
  low: Maybe[];
  high: Maybe[];
  bound: Maybe[];
}

export interface EstimatePage extends Head {
  kind: 'estimate';
  log: string;
  count_mm: number;
  answer: {
    estimator: string;
    ticks: number;
    edges: number;
    rows: number;
    clock_s: number;
    lag_s: number;
    jumps: number;
    /** Of the findings, also of those without a text. */
    reports: number;
    findings: { line: number; what: string; to_do: string }[];
    /** Was the log read to its end? */
    complete: boolean;
    /** Of a log of cycles. */
    cycle: { mean_s: number; jitter_rms_s: number; missed_cycles: number; gaps: number } | null;
  };
  /** So many ticks in one stretch. */
  ticks_each: number;
  t_s: number[];
  position_mm: Course;
  velocity_mm_s: Course;
  acceleration_mm_s2: Course;
}

const known = (v: Maybe | undefined): v is number => v !== null && v !== undefined;

/** The bound about the values; nothing where there is none. */
function bounded(course: Course, sign: 1 | -1): Maybe[] {
  const side = sign > 0 ? course.high : course.low;
  return side.map((v, i) => (known(v) && known(course.bound[i]) ? v + sign * (course.bound[i] as number) : null));
}

/** Such a share of the values is within. */
function within(values: readonly Maybe[], share: number): number {
  const sorted = values.filter(known).sort((a, b) => a - b);
  return sorted[Math.floor(share * (sorted.length - 1))] ?? 0;
}

/** A bound may be wide while an estimator begins. */
const most = (values: readonly Maybe[]) => within(values, 0.99);

/** Bands and lines without holes: a polygon has none. */
function solid(t: readonly number[], low: readonly Maybe[], high: readonly Maybe[]): { x: number[]; low: number[]; high: number[] } {
  const at = t.map((_, i) => i).filter((i) => known(low[i]) && known(high[i]));
  return { x: at.map((i) => t[i] as number), low: at.map((i) => low[i] as number), high: at.map((i) => high[i] as number) };
}

function coursePlot(page: EstimatePage, name: string, unit: string, course: Course, theme: Theme): Plot {
  const wide = most(course.bound);
  const values = [...course.low, ...course.high].filter(known);
  const [min, max] = roomy([...values, ...values.map((v) => v - wide), ...values.map((v) => v + wide)]);
  const middle = course.low.map((v, i) => (known(v) && known(course.high[i]) ? 0.5 * (v + (course.high[i] as number)) : null));
  const layers: Layer[] = [];
  const bound = solid(page.t_s, bounded(course, -1), bounded(course, 1));
  if (bound.x.length > 0) {
    layers.push({ kind: 'band', name: 'guaranteed bound', ...bound, colour: theme.run.with, opacity: 0.22 });
  }
  if (page.ticks_each > 1) {
    layers.push({ kind: 'band', name: 'lowest to highest', ...solid(page.t_s, course.low, course.high), colour: theme.run.with, opacity: 0.75 });
  }
  layers.push({ kind: 'line', name: page.ticks_each > 1 ? `middle of ${page.ticks_each} ticks` : 'estimate', x: page.t_s, y: middle, colour: theme.run.with, width: 1.6 });
  return {
    title: `${name[0]?.toUpperCase()}${name.slice(1)}`,
    x: { name: 'time in s', min: page.t_s[0] ?? 0, max: page.t_s.at(-1) ?? 1 },
    y: { name: `${name} in ${unit}`, min, max },
    group: 'time',
    layers,
  };
}

function largest(course: Course): number {
  return Math.max(0, ...[course.low, course.high].map((c) => c.reduce<number>((m, v) => Math.max(m, Math.abs(v ?? 0)), 0)));
}

function knownTo(course: Course, unit: string): string {
  return course.bound.some(known) ? `±${digits(within(course.bound, 0.5))}, ±${digits(most(course.bound))} ${unit}` : 'no bound';
}

function findings({ answer }: EstimatePage): string {
  const unsaid = answer.reports - answer.findings.length;
  return said('findings', [
    ...answer.findings.map((f) => `line ${f.line}: ${f.what}; ${f.to_do}`),
    ...(unsaid > 0 ? [`${fixed(unsaid, 0)} more of these`] : []),
    ...(answer.complete ? [] : ['the log was not read to its end: the estimates end there']),
  ]);
}

export function estimateView(page: EstimatePage): View {
  const a = page.answer;
  const found = findings(page);
  const edges = a.edges > 0 ? [{ label: 'edges', value: fixed(a.edges, 0) }] : [];
  const cycle = a.cycle
    ? [
        { label: 'cycle', value: `${plain(a.cycle.mean_s * 1000, 6)} ms` },
        { label: 'its jitter, RMS', value: `${digits(a.cycle.jitter_rms_s * 1e6)} µs` },
        { label: 'missed cycles', value: fixed(a.cycle.missed_cycles, 0) },
        { label: 'gaps', value: fixed(a.cycle.gaps, 0) },
      ]
    : [];
  const rows = [
    { label: 'estimator', value: escapeHtml(a.estimator) },
    { label: 'ticks', value: fixed(a.ticks, 0) },
    ...edges,
    ...cycle,
    { label: 'clock of the time stamps', value: a.clock_s > 0 ? `${plain(a.clock_s * 1e9)} ns` : 'exact' },
    { label: 'lag', value: `${plain(a.lag_s * 1000)} ms` },
    { label: 'largest velocity', value: `${digits(largest(page.velocity_mm_s))} mm/s` },
    { label: 'largest acceleration', value: `${digits(largest(page.acceleration_mm_s2))} mm/s²` },
    { label: 'velocity known to, in 50 and in 99 of 100 ticks', value: knownTo(page.velocity_mm_s, 'mm/s') },
    { label: 'acceleration known to, in 50 and in 99 of 100 ticks', value: knownTo(page.acceleration_mm_s2, 'mm/s²') },
    { label: 'faults found in the log', value: fixed(a.reports, 0) },
  ];
  return {
    product: 'Steadyrest motion estimate',
    title: page.log,
    facts: `count <b>${plain(page.count_mm)} mm</b> · <b>${fixed(a.ticks, 0)}</b> ticks · <b>${escapeHtml(a.estimator)}</b>`,
    verdict: `The axis moves at up to ${digits(largest(page.velocity_mm_s))} mm/s and is accelerated by up to ${digits(largest(page.acceleration_mm_s2))} mm/s².`,
    body: (found === '' ? '' : section('Faults in the log', found)) + section('Motion of the axis', host('position') + host('velocity', 'high') + host('acceleration', 'high')) + section('Figures', figures(rows)),
    explanation: [
      ['Estimate', 'What the motion was at each tick, from the counts and, where the log has them, from the times of the edges. With a lag the value of a tick is that of so long before.'],
      ['Guaranteed bound', 'The true value is within the shaded band as long as the axis keeps the limits that were given and the clock keeps its period. There is none where the estimator gives none; it is wide while an estimator begins and when the axis hardly moves.'],
      ['Stretches', 'A long log is drawn in stretches of many ticks, each from its lowest to its highest value: no peak is lost. The table that the verb writes has every tick.'],
    ],
    draw: (theme) => {
      plot('position', coursePlot(page, 'position', 'mm', page.position_mm, theme), theme);
      plot('velocity', coursePlot(page, 'velocity', 'mm/s', page.velocity_mm_s, theme), theme);
      plot('acceleration', coursePlot(page, 'acceleration', 'mm/s²', page.acceleration_mm_s2, theme), theme);
    },
  };
}
