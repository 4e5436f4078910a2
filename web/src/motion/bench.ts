// SPDX-License-Identifier: Apache-2.0
// The page of `motion bench`: how good each estimator is, and whether the requirement can be met.
import { element, onChoice, put } from '../frame/dom';
import { buttons, escapeHtml, section } from '../frame/html';
import { counted, digits, heldPercent } from '../frame/numbers';
import { type Cell, numeric, table, valued } from '../frame/table';
import type { Term, View } from '../frame/view';
import { panels, plot } from '../plot/plot';
import { figurePlots, lagPlots, tracePlots } from './bench_plots';
import { type Bench, type Figures, type Row, label, scenes } from './data';
import { requirement } from './requirement';

type Quantity = 'velocity' | 'acceleration';

function target(figures: Figures): Cell {
  if (figures.target === null || figures.rms === null) {
    return '';
  }
  const met = figures.rms <= figures.target;
  return { html: `${met ? '✓' : '✗'} ${digits(figures.target, 2)}`, look: met ? 'met' : 'missed', sort: figures.target };
}

const number = (value: number | null, count = 3) => valued(digits(value, count), value);

function resultsTable(bench: Bench, quantity: Quantity): string {
  const unit = quantity === 'velocity' ? 'mm/s' : 'mm/s²';
  const heads = [`RMS, ${unit}`, 'Target', `Max, ${unit}`, 'Gain', 'Best lag, ms', 'RMS there', 'In bound', 'Bound ÷ RMS', 'Efficiency', 'Contradicted', 'ns/tick', 'ns/edge'];
  const rows = bench.rows.map((row): Cell[] => {
    const f = row[quantity];
    return [
      row.scene, label(row), number(f.rms), target(f), number(f.max), number(f.gain), number(f.own_lag_s === null ? null : f.own_lag_s * 1000),
      number(f.rms_at_own_lag), valued(heldPercent(f.coverage), f.coverage), number(f.bound_ratio, 2), number(f.efficiency, 2),
      String(row.contradictions), number(row.ns_per_tick, 2), number(row.ns_per_edge, 2),
    ];
  });
  return table({
    id: 'results',
    sortable: true,
    columns: [{ head: 'Scene' }, { head: 'Estimator' }, ...heads.map((head) => numeric(head))],
    rows,
    rowLook: (i) => (bench.rows[i]?.estimator === 'kalman' ? 'ours' : ''),
  });
}

const EXPLANATION: readonly Term[] = [
  ['RMS, max', 'Error against the exact motion at the same instant (zero lag), stops and reversals included.'],
  ['Gain', 'RMS of the backward difference of counts ÷ RMS of this estimator.'],
  ['Best lag', 'The lag of the truth, 0 … 20 ms, that the estimate fits best, and the RMS at that lag.'],
  ['In bound', 'Share of ticks with the error inside the bound that the estimator gave. Bound ÷ RMS and efficiency are taken above 1 mm/s. Efficiency is the smallest bound that anyone can prove (Landau–Kolmogorov) ÷ the bound given.'],
  ['Limits', '“+ limits”: the estimator knew the axis’s top speed, acceleration, jerk and line error. Without them it knows only the count and the clock.'],
  ['Forbidden', 'Guaranteed bound: two motions within the limits give the same edges and differ by more than the requirement. RMS error: even the best parabola misses the requirement when jerk is always at its limit; calmer motion may be known better, and is then “met”. Both floors are for the worst case.'],
  ['ns/tick, ns/edge', 'Computing time per cycle and per edge on the computer that wrote this page.'],
  ['Contradicted', 'Ticks at which the stated limits cannot explain what the encoder showed.'],
  ['Flywheel', 'Its braking starts with a step of acceleration, which the jerk limit rules out: bounds may fail for the first ticks after it.'],
  ['Recorded', 'A servo axis. Its own counts are the truth (least-squares cubic over ± 4 samples); the coarse encoder is the counts ÷ 64. Not scored: 15 samples either side of anything above 500 mm/s² (counter errors) and of gaps over 50 ms.'],
];

const TRACES: Record<string, [string, string]> = {
  flywheel: ['Before and after: flywheel, −0.006 counts/tick² from 6 counts/tick', 'Above: as in figures 1 and 2 of Kombarov’s paper, and what the same edges give with their times. Below: enlarged.'],
  's-curve': ['Before and after: rest, 20 mm/s, stop, back at 2 mm/s', ''],
};

const ids = (of: string, count: number) => Array.from({ length: count }, (_, i) => `${of}-${i}`);

function body(bench: Bench, scene: string, requirementHtml: string): string {
  const traces = bench.traces.map((t) => section(TRACES[t.name]?.[0] ?? escapeHtml(t.name), panels(ids(t.name, 4)), TRACES[t.name]?.[1] ?? '')).reverse();
  const notes = bench.notes.map((n) => `<p class="hint">${escapeHtml(n)}</p>`).join('');
  return [
    ...traces,
    section('Error against lag', `<p id="what"></p>${panels(ids('lag', 2))}`, 'A dot marks each estimator’s best lag. At the left edge the estimate has no lag.', buttons('scene', 'Scene', scenes(bench).map((s) => [s, s] as const), scene)),
    requirementHtml,
    section('All figures', `<div id="results-host"></div>${notes}`, '', buttons('results-of', 'Quantity', [['velocity', 'Velocity'], ['acceleration', 'Acceleration']], 'velocity')),
    section('Figures 3 and 5 of Kombarov’s paper', panels(ids('figures', 4))),
  ].join('');
}

/** The first scene that has both: the best of ours against the difference of counts. */
function verdict(bench: Bench): string {
  for (const scene of scenes(bench)) {
    const of = (name: string) => bench.rows.find((r) => r.scene === scene && label(r) === name);
    const [plain, ours] = [of('difference'), of('kalman + limits') ?? of('kalman')];
    if (plain && ours) {
      const error = (row: Row) => `${digits(row.velocity.rms)} mm/s and ${digits(row.acceleration.rms)} mm/s²`;
      return `In scene ${escapeHtml(scene)}, without lag, ${escapeHtml(label(ours))} has an RMS error of ${error(ours)}; the difference of counts has ${error(plain)}.`;
    }
  }
  return `${counted(bench.rows.length, 'result', 'results')}: every estimator in every scene.`;
}

export function benchView(bench: Bench): View {
  let scene = scenes(bench)[0] ?? '';
  const required = requirement(bench);
  const showResults = (quantity: Quantity) => put('results-host', resultsTable(bench, quantity));
  const showScene = () => (element('what').textContent = bench.scenes.find((s) => s.name === scene)?.what ?? '');
  return {
    product: 'Steadyrest motion bench',
    title: 'Velocity and acceleration from an encoder',
    facts: 'count <b>0.001 mm</b> · cycle <b>1 kHz</b> · time stamps <b>100 ns</b> unless stated',
    verdict: verdict(bench),
    body: body(bench, scene, required.html),
    explanation: EXPLANATION,
    draw: (theme) => {
      bench.traces.forEach((trace) => tracePlots(trace, theme).forEach((p, i) => plot(`${trace.name}-${i}`, p, theme)));
      lagPlots(bench, scene, theme).forEach((p, i) => plot(`lag-${i}`, p, theme));
      figurePlots(bench, theme).forEach((p, i) => plot(`figures-${i}`, p, theme));
    },
    bind: (redraw) => {
      required.bind();
      onChoice('results-of', (v) => showResults(v as Quantity));
      onChoice('scene', (v) => {
        scene = v;
        showScene();
        redraw();
      });
      showResults('velocity');
      showScene();
    },
  };
}
