// SPDX-License-Identifier: Apache-2.0
// The page of `motion bench`: what each estimator is worth, and whether the requirement can be met.
import { element, onChoice, put } from '../frame/dom';
import { buttons, escapeHtml, section } from '../frame/html';
import { digits, percent, short } from '../frame/numbers';
import { type Cell, type Column, table } from '../frame/table';
import type { Term, View } from '../frame/view';
import { host, plot } from '../plot/plot';
import { type Bench, type Figures, type Requirement, type Row, label, scenes } from './data';
import { figurePlots, lagPlots, tracePlots } from './plots';

type Judge = 'guaranteed' | 'typical';
type Quantity = 'velocity' | 'acceleration';
interface Choice {
  acceleration: boolean;
  fine: boolean;
  judge: Judge;
  jerk_mm_s3: number;
  cycle_hz: number;
}

function target(figures: Figures): Cell {
  if (figures.target === null || figures.rms === null) {
    return '';
  }
  const met = figures.rms <= figures.target;
  return { html: `${met ? '✓' : '✗'} ${digits(figures.target, 2)}`, look: met ? 'met' : 'missed', sort: figures.target };
}

const number = (value: number | null, count = 3): Cell => ({ html: digits(value, count), sort: value });

function resultsTable(bench: Bench, quantity: Quantity): string {
  const unit = quantity === 'velocity' ? 'mm/s' : 'mm/s²';
  const heads = [`RMS, ${unit}`, 'target', `max, ${unit}`, 'gain', 'own lag, ms', 'RMS there', 'in bound', 'bound ÷ RMS', 'efficiency', 'contradictions', 'ns/tick', 'ns/edge'];
  const rows = bench.rows.map((row): Cell[] => {
    const f = row[quantity];
    return [
      row.scene, label(row), number(f.rms), target(f), number(f.max), number(f.gain), number(f.own_lag_s === null ? null : f.own_lag_s * 1000),
      number(f.rms_at_own_lag), { html: percent(f.coverage), sort: f.coverage }, number(f.bound_ratio, 2), number(f.efficiency, 2),
      String(row.contradictions), number(row.ns_per_tick, 2), number(row.ns_per_edge, 2),
    ];
  });
  return table({
    id: 'results',
    sortable: true,
    columns: [{ head: 'Scene' }, { head: 'Estimator' }, ...heads.map((head) => ({ head, number: true }))],
    rows,
    rowLook: (i) => (bench.rows[i]?.estimator === 'kalman' ? 'ours' : ''),
  });
}

const same = (a: number, b: number) => Math.abs(a - b) <= 1e-9 * Math.abs(b);
const different = (values: number[]) => [...new Set(values)].sort((a, b) => a - b);

function cell(row: Requirement | undefined, judge: Judge): Cell {
  if (!row) {
    return '';
  }
  const [value, least] = judge === 'guaranteed' ? [row.bound, row.guaranteed_floor] : [row.rms, row.optimum];
  const verdict = row[judge];
  const title = `${verdict}: ${digits(value)}, required ${digits(row.required)}, least possible ${digits(least)}`;
  return { html: `<b title="${title}">${digits(value, 2)}</b><small>${digits(least, 2)}</small>`, look: `verdict ${verdict}` };
}

function requirementTable(bench: Bench, choice: Choice): string {
  const rows = bench.requirement.filter(
    (r) => r.acceleration === choice.acceleration && r.fine === choice.fine && same(r.jerk_mm_s3, choice.jerk_mm_s3) && same(r.cycle_hz, choice.cycle_hz),
  );
  const lines = different(rows.map((r) => r.line_error_counts));
  const clocks = different(rows.map((r) => r.clock_s));
  const unit = choice.acceleration ? 'mm/s²' : 'mm/s';
  const columns = lines.flatMap((l) =>
    clocks.map((c): Column => ({ head: `${(c * 1e9).toFixed(0)} ns`, number: true, group: l === 0 ? 'ideal lines' : `line error ${short(100 * l)} % of a count (RMS)` })),
  );
  return table({
    id: 'requirement-table',
    caption: `Required: <b>${digits(rows[0]?.required)} ${unit}</b>. Large: ${choice.judge === 'guaranteed' ? 'bound that was proved' : 'RMS error'}; small: the least that physics permits, ${unit}.`,
    columns: [{ head: 'Speed', number: true }, ...columns],
    rows: different(rows.map((r) => r.speed_mm_s)).map((v) => [
      `${digits(v)} mm/s`,
      ...lines.flatMap((l) => clocks.map((c) => cell(rows.find((r) => r.speed_mm_s === v && r.line_error_counts === l && r.clock_s === c), choice.judge))),
    ]),
  });
}

function requirement(bench: Bench, choice: Choice): string {
  const numbers = (values: number[], unit: string): [string, string][] => different(values).map((v) => [String(v), `${v} ${unit}`]);
  return `<section id="requirement-section"><h2>The requirement: met, forbidden, missed</h2>
    <p class="hint">1·10⁻⁵ … 3·10⁻⁶ mm/tick and 1·10⁻⁵ … 1·10⁻⁶ mm/tick², count 0.001 mm, constant speed, limits known.
      <span class="sample met">met</span> <span class="sample forbidden">forbidden by physics</span> <span class="sample missed">missed</span></p>
    <div class="controls">
    ${buttons('quantity', 'Quantity', [['v', 'Velocity'], ['a', 'Acceleration']], choice.acceleration ? 'a' : 'v')}
    ${buttons('end', 'End of the requirement', [['coarse', 'coarser end'], ['fine', 'finer end']], choice.fine ? 'fine' : 'coarse')}
    ${buttons('judge', 'Judged by', [['typical', 'RMS error'], ['guaranteed', 'guaranteed bound']], choice.judge)}
    ${buttons('jerk', 'Largest jerk', numbers(bench.requirement.map((r) => r.jerk_mm_s3), 'mm/s³'), String(choice.jerk_mm_s3))}
    ${buttons('cycle', 'Control cycle', numbers(bench.requirement.map((r) => r.cycle_hz), 'Hz'), String(choice.cycle_hz))}
    </div><div id="requirement"></div></section>`;
}

const EXPLANATION: readonly Term[] = [
  ['RMS, max', 'Error against the exact motion at the same instant (zero lag), stops and reversals included.'],
  ['Gain', 'RMS of the backward difference of counts ÷ RMS of this estimator.'],
  ['Own lag', 'The shift of the truth, 0 … 20 ms, at which the estimate fits it best, and the RMS there.'],
  ['In bound', 'Share of the ticks at which the error is within the bound that the estimator gave; bound ÷ RMS and efficiency are taken at over 1 mm/s. Efficiency is the smallest bound that anyone can prove (Landau–Kolmogorov) ÷ the bound given.'],
  ['Limits', '“+ limits”: the estimator knew the largest speed, acceleration, jerk and line error of the axis; without them it knows the count and the clock only.'],
  ['Forbidden', 'Guaranteed bound: two motions within the limits give the same edges and differ by more. RMS error: more than the requirement even for the best parabola when the jerk is at its limit all the time; calmer motion may be known better and is then “met”. Both floors are those of the worst case.'],
  ['ns/tick, ns/edge', 'Time of computing for each cycle and each edge, on the computer that wrote this page.'],
  ['Flywheel', 'Its braking begins with a step of the acceleration, which the limit of the jerk does not permit: bounds may fail for the first ticks after it.'],
  ['Recorded', 'A servo axis; its counts are the truth (cubic of least squares over ± 4 samples), ÷ 64 the coarse encoder. Not scored: 15 samples on both sides of more than 500 mm/s² (errors of the counter) and of gaps over 50 ms.'],
];

const TRACES: Record<string, [string, string]> = {
  flywheel: ['Before and after: flywheel, −0.006 counts/tick² from 6 counts/tick', "Above: as figures 1 and 2 of Kombarov’s paper have it, and what the same edges give with their times. Below: enlarged."],
  's-curve': ['Before and after: rest, 20 mm/s, stop, back at 2 mm/s', ''],
};

const panels = (id: string, count: number) => `<div class="panels">${Array.from({ length: count }, (_, i) => host(`${id}-${i}`)).join('')}</div>`;

function body(bench: Bench, choice: Choice, scene: string): string {
  const traces = bench.traces.map((t) => section(TRACES[t.name]?.[0] ?? escapeHtml(t.name), panels(t.name, 4), TRACES[t.name]?.[1] ?? '')).reverse();
  return `${traces.join('')}
  ${section('Error against lag', `<p id="what"></p>${panels('lag', 2)}`, 'A dot is at the lag that suits the estimator best; at the left edge the estimate is there at once.', buttons('scene', 'Scene', scenes(bench).map((s) => [s, s] as const), scene))}
  ${bench.requirement.length > 0 ? requirement(bench, choice) : ''}
  ${section('All figures', `<div id="results-host"></div>${bench.notes.map((n) => `<p class="hint">${escapeHtml(n)}</p>`).join('')}`, '', buttons('results-of', 'Quantity', [['velocity', 'Velocity'], ['acceleration', 'Acceleration']], 'velocity'))}
  ${section('Figures 3 and 5 of Kombarov’s paper', panels('figures', 4))}`;
}

/** The first scene that has both: the best of ours beside the difference of counts. */
function verdict(bench: Bench): string {
  for (const scene of scenes(bench)) {
    const of = (name: string) => bench.rows.find((r) => r.scene === scene && label(r) === name);
    const [plain, ours] = [of('difference'), of('kalman + limits') ?? of('kalman')];
    if (plain && ours) {
      const off = (row: Row) => `${digits(row.velocity.rms)} mm/s and ${digits(row.acceleration.rms)} mm/s²`;
      return `Scene ${escapeHtml(scene)}, without lag: ${escapeHtml(label(ours))} is off by ${off(ours)} (RMS), the difference of the counts by ${off(plain)}.`;
    }
  }
  return `${bench.rows.length} rows of scenes and estimators.`;
}

export function benchView(bench: Bench): View {
  const choice: Choice = { acceleration: false, fine: false, judge: 'typical', jerk_mm_s3: 5000, cycle_hz: 1000 };
  let scene = scenes(bench)[0] ?? '';
  let quantity: Quantity = 'velocity';
  const tables = () => {
    put('requirement', bench.requirement.length > 0 ? requirementTable(bench, choice) : '');
    element('results-host').innerHTML = resultsTable(bench, quantity);
    element('what').textContent = bench.scenes.find((s) => s.name === scene)?.what ?? '';
  };
  return {
    product: 'Steadyrest motion bench',
    title: 'Velocity and acceleration from an encoder',
    facts: 'count <b>0.001 mm</b> · cycle <b>1 kHz</b> · stamps <b>100 ns</b>, unless said',
    verdict: verdict(bench),
    body: body(bench, choice, scene),
    explanation: EXPLANATION,
    draw: (theme) => {
      bench.traces.forEach((trace) => tracePlots(trace, theme).forEach((p, i) => plot(`${trace.name}-${i}`, p, theme)));
      lagPlots(bench, scene, theme).forEach((p, i) => plot(`lag-${i}`, p, theme));
      figurePlots(bench, theme).forEach((p, i) => plot(`figures-${i}`, p, theme));
    },
    bind: (redraw) => {
      const on = (id: string, set: (value: string) => void) =>
        onChoice(id, (value) => {
          set(value);
          tables();
        });
      on('quantity', (v) => (choice.acceleration = v === 'a'));
      on('end', (v) => (choice.fine = v === 'fine'));
      on('judge', (v) => (choice.judge = v as Judge));
      on('jerk', (v) => (choice.jerk_mm_s3 = Number(v)));
      on('cycle', (v) => (choice.cycle_hz = Number(v)));
      on('results-of', (v) => (quantity = v as Quantity));
      on('scene', (v) => {
        scene = v;
        redraw();
      });
      tables();
    },
  };
}
