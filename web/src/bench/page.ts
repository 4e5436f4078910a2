// SPDX-License-Identifier: Apache-2.0
// Text and tables of the page of `motion bench`; the charts come afterwards into the hosts made here.
import { buttons, escapeHtml } from '../page';
import { type Bench, type Figures, type Requirement, type Row, label, scenes } from './data';
import { digits, percent, short } from './format';

export type Judge = 'guaranteed' | 'typical';
export type Quantity = 'velocity' | 'acceleration';
export interface Choice {
  acceleration: boolean;
  fine: boolean;
  judge: Judge;
  jerk_mm_s3: number;
  cycle_hz: number;
}

function target(figures: Figures): string {
  if (figures.target === null || figures.rms === null) {
    return '<td></td>';
  }
  const met = figures.rms <= figures.target;
  return `<td class="n ${met ? 'met' : 'missed'}">${met ? '✓' : '✗'} ${digits(figures.target, 2)}</td>`;
}

function half(figures: Figures): string {
  return `<td class="n first">${digits(figures.rms)}</td>${target(figures)}<td class="n">${digits(figures.max)}</td>
    <td class="n">${digits(figures.gain)}</td>
    <td class="n">${figures.own_lag_s === null ? '–' : digits(figures.own_lag_s * 1000)}</td><td class="n">${digits(figures.rms_at_own_lag)}</td>
    <td class="n">${percent(figures.coverage)}</td><td class="n">${digits(figures.bound_ratio, 2)}</td><td class="n">${digits(figures.efficiency, 2)}</td>`;
}

function tableRow(row: Row, span: number, quantity: Quantity): string {
  const scene = span > 0 ? `<th scope="rowgroup" class="scene" rowspan="${span}">${escapeHtml(row.scene)}</th>` : '';
  const ours = row.estimator === 'kalman' ? ' class="ours"' : '';
  return `<tr${ours}>${scene}<th scope="row">${escapeHtml(label(row))}</th>${half(row[quantity])}
    <td class="n first">${row.contradictions}</td><td class="n first">${digits(row.ns_per_tick, 2)}</td><td class="n">${digits(row.ns_per_edge, 2)}</td></tr>`;
}

export function resultsTable(bench: Bench, quantity: Quantity): string {
  const body = scenes(bench)
    .map((scene) => {
      const rows = bench.rows.filter((r) => r.scene === scene);
      return `<tbody>${rows.map((r, i) => tableRow(r, i === 0 ? rows.length : 0, quantity)).join('')}</tbody>`;
    })
    .join('');
  const unit = quantity === 'velocity' ? 'mm/s' : 'mm/s²';
  return `<table id="results"><thead>
    <tr><th>Scene</th><th>Estimator</th><th class="n first">RMS, ${unit}</th><th class="n">target</th><th class="n">max, ${unit}</th><th class="n">gain</th>
    <th class="n">own lag, ms</th><th class="n">RMS there</th><th class="n">in bound</th><th class="n">bound ÷ RMS</th><th class="n">efficiency</th>
    <th class="n first">contradictions</th><th class="n first">ns/tick</th><th class="n">ns/edge</th></tr></thead>${body}</table>`;
}

const same = (a: number, b: number) => Math.abs(a - b) <= 1e-9 * Math.abs(b);
const different = (values: number[]) => [...new Set(values)].sort((a, b) => a - b);

function cell(row: Requirement, judge: Judge): string {
  const [value, least] = judge === 'guaranteed' ? [row.bound, row.guaranteed_floor] : [row.rms, row.optimum];
  const verdict = row[judge];
  const title = `${verdict}: ${digits(value)}, required ${digits(row.required)}, least possible ${digits(least)}`;
  return `<td class="n verdict ${verdict}" title="${title}"><b>${digits(value, 2)}</b><small>${digits(least, 2)}</small></td>`;
}

export function requirementTable(bench: Bench, choice: Choice): string {
  const rows = bench.requirement.filter(
    (r) =>
      r.acceleration === choice.acceleration &&
      r.fine === choice.fine &&
      same(r.jerk_mm_s3, choice.jerk_mm_s3) &&
      same(r.cycle_hz, choice.cycle_hz),
  );
  const lines = different(rows.map((r) => r.line_error_counts));
  const clocks = different(rows.map((r) => r.clock_s));
  const unit = choice.acceleration ? 'mm/s²' : 'mm/s';
  const head = lines.map((l) => `<th colspan="${clocks.length}" class="first">${l === 0 ? 'ideal lines' : `line error ${short(100 * l)} % of a count (RMS)`}</th>`).join('');
  const subhead = lines.map(() => clocks.map((c, i) => `<th class="n${i === 0 ? ' first' : ''}">${(c * 1e9).toFixed(0)} ns</th>`).join('')).join('');
  const body = different(rows.map((r) => r.speed_mm_s))
    .map((v) => {
      const cells = lines
        .flatMap((l) => clocks.map((c) => rows.find((r) => r.speed_mm_s === v && r.line_error_counts === l && r.clock_s === c)))
        .map((r) => (r ? cell(r, choice.judge) : '<td></td>'));
      return `<tr><th scope="row" class="n">${digits(v)} mm/s</th>${cells.join('')}</tr>`;
    })
    .join('');
  return `<table id="requirement-table"><caption>Required: <b>${digits(rows[0]?.required)} ${unit}</b>. Large: ${choice.judge === 'guaranteed' ? 'bound that was proved' : 'RMS error'}; small: the least that physics permits, ${unit}.</caption>
    <thead><tr><th rowspan="2" class="n">Speed</th>${head}</tr><tr>${subhead}</tr></thead><tbody>${body}</tbody></table>`;
}

function requirement(bench: Bench, choice: Choice): string {
  const numbers = (values: number[], unit: string): [string, string][] => different(values).map((v) => [String(v), `${v} ${unit}`]);
  return `<section><h2>The requirement: met, forbidden, missed</h2>
    <p class="hint">1·10⁻⁵ … 3·10⁻⁶ mm/tick and 1·10⁻⁵ … 1·10⁻⁶ mm/tick², count 0.001 mm, constant speed, limits known.
      <span class="sample met">met</span> <span class="sample forbidden">forbidden by physics</span> <span class="sample missed">missed</span></p>
    <div class="controls">
    ${buttons('quantity', 'Quantity', [['v', 'Velocity'], ['a', 'Acceleration']], choice.acceleration ? 'a' : 'v')}
    ${buttons('end', 'End of the requirement', [['coarse', 'coarser end'], ['fine', 'finer end']], choice.fine ? 'fine' : 'coarse')}
    ${buttons('judge', 'Judged by', [['typical', 'RMS error'], ['guaranteed', 'guaranteed bound']], choice.judge)}
    ${buttons('jerk', 'Largest jerk', numbers(bench.requirement.map((r) => r.jerk_mm_s3), 'mm/s³'), String(choice.jerk_mm_s3))}
    ${buttons('cycle', 'Control cycle', numbers(bench.requirement.map((r) => r.cycle_hz), 'Hz'), String(choice.cycle_hz))}
    </div><div class="wide" id="requirement"></div></section>`;
}

const EXPLANATION = `<dl>
  <dt>RMS, max</dt><dd>Error against the exact motion at the same instant (zero lag), stops and reversals included.</dd>
  <dt>Gain</dt><dd>RMS of the backward difference of counts ÷ RMS of this estimator.</dd>
  <dt>Own lag</dt><dd>The shift of the truth, 0 … 20 ms, at which the estimate fits it best, and the RMS there.</dd>
  <dt>In bound</dt><dd>Share of the ticks at which the error is within the bound that the estimator gave; bound ÷ RMS and efficiency are taken at over 1 mm/s.
    Efficiency is the smallest bound that anyone can prove (Landau–Kolmogorov) ÷ the bound given.</dd>
  <dt>Limits</dt><dd>“+ limits”: the estimator knew the largest speed, acceleration, jerk and line error of the axis; without them it knows the count and the clock only.</dd>
  <dt>Forbidden</dt><dd>Guaranteed bound: two motions within the limits give the same edges and differ by more. RMS error: more than the requirement
    even for the best parabola when the jerk is at its limit all the time; calmer motion may be known better and is then “met”. Both floors
    are those of the worst case.</dd>
  <dt>Flywheel</dt><dd>Its braking begins with a step of the acceleration, which the limit of the jerk does not permit: bounds may fail for the
    first ticks after it.</dd>
  <dt>Recorded</dt><dd>A servo axis; its counts are the truth (cubic of least squares over ± 4 samples), ÷ 64 the coarse encoder. Not scored: 15 samples
    on both sides of more than 500 mm/s² (errors of the counter) and of gaps over 50 ms.</dd></dl>`;

export function renderPage(host: HTMLElement, bench: Bench, choice: Choice, scene: string): void {
  host.innerHTML = `
  <header><p class="product">Steadyrest motion bench</p><h1>Velocity and acceleration from an encoder</h1>
    <p class="facts">count <b>0.001 mm</b> · cycle <b>1 kHz</b> · stamps <b>100 ns</b>, unless said</p></header>
  <section><h2>Before and after: flywheel, −0.006 counts/tick² from 6 counts/tick</h2><p class="hint">Above: as the source's figures 1 and 2 have it, and what the same edges give with their times. Below: enlarged.</p><div class="key-line" id="key-flywheel"></div>
    <div class="panels" id="flywheel"></div></section>
  <section><h2>Before and after: rest, 20 mm/s, stop, back at 2 mm/s</h2><div class="key-line" id="key-s-curve"></div>
    <div class="panels" id="s-curve"></div></section>
  <section><div class="bar-head"><h2>Error against lag</h2><div class="controls">${buttons('scene', 'Scene', scenes(bench).map((s) => [s, s]), scene)}</div></div>
    <p id="what"></p><div class="key-line" id="key-lag"></div><div class="panels" id="lag"></div>
    <p class="hint">A dot stands at the lag that suits the estimator best; at the left edge the estimate is there at once.</p></section>
  ${bench.requirement.length > 0 ? requirement(bench, choice) : ''}
  <section><div class="bar-head"><h2>All figures</h2><div class="controls">${buttons('results-of', 'Quantity', [['velocity', 'Velocity'], ['acceleration', 'Acceleration']], 'velocity')}</div></div>
    <div class="wide" id="results-host"></div>
    ${bench.notes.map((n) => `<p class="hint">${escapeHtml(n)}</p>`).join('')}</section>
  <section><h2>The source's figures 3 and 5</h2><div class="panels three" id="figures"></div></section>
  <section class="explanation"><h2>How to read this</h2>${EXPLANATION}</section>
  <footer>Steadyrest ${escapeHtml(bench.version)} · times are of the machine that wrote this</footer>`;
}
