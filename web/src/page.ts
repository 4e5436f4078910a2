// SPDX-License-Identifier: Apache-2.0
// The page's text and tables; the charts come afterwards into the hosts made here.
import type { ReasonTime, Report } from './data';
import { change, figureRows, fixed, micrometres, motionRows, seconds, verdict, vibrationRows, type FigureRow } from './format';
import type { ErrorClass } from './scale';

export function escapeHtml(text: string): string {
  return text.replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
}

/** A row of buttons of which one is pressed. */
export function buttons(name: string, title: string, options: [string, string][], chosen: string): string {
  const list = options
    .map(([value, text]) => `<button type="button" data-value="${escapeHtml(value)}" aria-pressed="${value === chosen}">${escapeHtml(text)}</button>`)
    .join('');
  return `<div class="choice" role="group" aria-label="${title}" id="${name}">${list}</div>`;
}

function headline(key: string, label: string, before: number, after: number, show: (v: number) => string): string {
  const [a, b] = [show(before), show(after)];
  return `<div class="worth" data-key="${key}"><h3>${label}</h3>
    <p><span class="before">${a}</span><span class="arrow" aria-label="becomes">→</span><span class="after">${b}</span></p>
    <p class="change">${change(before, after)}</p></div>`;
}

function comparisonTable(id: string, compared: readonly FigureRow[]): string {
  const rows = compared
    .map(
      (r) => `<tr data-key="${r.key}"><th scope="row">${r.label}</th><td class="n">${r.without}</td>
      <td class="n">${r.with}</td><td class="n">${r.change}</td></tr>`,
    )
    .join('');
  return `<table id="${id}"><thead><tr><th scope="col">Figure</th><th scope="col" class="n">without</th>
    <th scope="col" class="n">with</th><th scope="col" class="n">change</th></tr></thead><tbody>${rows}</tbody></table>`;
}

/** Empty where the machine cut air. */
function vibrationSection({ without, with: layer }: Report): string {
  if (!without.vibration || !layer.vibration) {
    return '';
  }
  const rows = vibrationRows(without.vibration.figures, layer.vibration.figures);
  return `<section><div class="bar-head"><h2>Vibration of the tool</h2>
    <div class="controls"><span class="key"><i class="without"></i>without</span><span class="key"><i class="with"></i>with the layer</span></div></div>
    <div id="vibration"></div><div class="wide">${comparisonTable('vibration-figures', rows)}</div></section>`;
}

function worstTable(report: Report): string {
  if (report.worst_lines.length === 0) {
    return '<p class="none">No line of the program cuts.</p>';
  }
  const over = (um: number | null) => (um !== null && Math.abs(um) > report.limit_um ? ' over' : '');
  const rows = report.worst_lines
    .map(
      (w) => `<tr><td class="n">${w.line}</td><td class="code">${escapeHtml(w.text)}</td>
      <td class="n${over(w.without_um)}">${fixed(w.without_um, 1)}</td>
      <td class="n${over(w.with_um)}">${fixed(w.with_um, 1)}</td></tr>`,
    )
    .join('');
  return `<table id="worst"><thead><tr><th scope="col" class="n">Line</th><th scope="col">Block</th>
    <th scope="col" class="n">without, µm</th><th scope="col" class="n">with, µm</th></tr></thead><tbody>${rows}</tbody></table>`;
}

function reasonsTable(reasons: readonly ReasonTime[]): string {
  const total = reasons.reduce((sum, r) => sum + r.seconds, 0);
  if (total <= 0) {
    return '<p class="none">The layer never acted.</p>';
  }
  const rows = [...reasons]
    .sort((a, b) => b.seconds - a.seconds)
    .map((r) => {
      const share = (100 * r.seconds) / total;
      return `<tr><th scope="row">${escapeHtml(r.sentence)}<br><code>${escapeHtml(r.reason)}</code></th>
        <td class="n">${seconds(r.seconds)}</td><td class="n">${fixed(share, 1)} %</td>
        <td class="bar"><span style="width:${share.toFixed(2)}%"></span></td></tr>`;
    })
    .join('');
  return `<table id="reasons"><thead><tr><th scope="col">Why the override stood there</th><th scope="col" class="n">time</th>
    <th scope="col" class="n">share</th><th></th></tr></thead><tbody>${rows}</tbody></table>`;
}

function motionTable(report: Report): string {
  const rows = motionRows(report.motion)
    .map(
      (r) => `<tr><th scope="row">${escapeHtml(r.axis)}, ${r.quantity}</th><td class="n">${r.difference}</td>
      <td class="n">${r.estimate}</td><td class="n">${r.finer}</td><td class="n">${r.coverage}</td></tr>`,
    )
    .join('');
  if (rows === '') {
    return '<p class="none">No axis of this machine has an encoder with counts.</p>';
  }
  return `<div class="wide"><table id="motion"><thead><tr><th scope="col">Axis</th><th scope="col" class="n">difference of counts</th>
    <th scope="col" class="n">estimate</th><th scope="col" class="n">finer</th><th scope="col" class="n">bound held</th></tr></thead>
    <tbody>${rows}</tbody></table></div>`;
}

/** Empty where no probe read. */
function probeSection(report: Report): string {
  if (report.probes.length === 0) {
    return '';
  }
  const rows = report.probes
    .map(
      (p) => `<tr><th scope="row">${escapeHtml(p.axis)} at ${seconds(p.time_s)}</th><td class="n">${p.line}</td>
      <td class="n">${fixed(p.displacement_um, 2)}</td><td class="n">${fixed(p.innovation_um, 2)}</td><td class="n">${fixed(p.band_um, 2)}</td>
      <td>${escapeHtml(p.sentence)}<br><code>${escapeHtml(p.reason)}</code></td></tr>`,
    )
    .join('');
  return `<section><h2>Readings of the probe</h2><div class="wide"><table id="probes"><thead><tr><th scope="col">Axis</th>
    <th scope="col" class="n">line</th><th scope="col" class="n">finds, µm</th><th scope="col" class="n">not foreseen, µm</th>
    <th scope="col" class="n">taken within ±µm</th><th scope="col">what became of it</th></tr></thead><tbody>${rows}</tbody></table></div></section>`;
}

function steps(report: Report): string {
  if (report.override_table.length === 0) {
    return '';
  }
  const list = report.override_table.map((s) => `<span>${fixed(s.percent, s.percent % 1 === 0 ? 0 : 1)}</span>`).join(' ');
  return `<p class="steps"><b>Steps of the feed override, %:</b> ${list}</p>`;
}

export function legend(classes: readonly ErrorClass[]): string {
  const cells = classes
    .map((c) => `<span class="cell${c.over ? ' over' : ''}"><i style="background:${c.colour}"></i>${fixed(c.to_um, c.to_um < 10 && c.to_um % 1 !== 0 ? 1 : 0)}</span>`)
    .join('');
  return `<span class="legend-title">Contour error up to, µm (upright mark: the limit)</span>${cells}<span class="cell rapid"><i></i>not cutting</span>`;
}

function choice(name: string, label: string, options: [string, string][]): string {
  const buttons = options
    .map(([value, text], i) => `<button type="button" data-value="${value}" aria-pressed="${i === 0}">${text}</button>`)
    .join('');
  return `<div class="choice" role="group" aria-label="${label}" id="${name}">${buttons}</div>`;
}

const EXPLANATION = `
  <dl>
    <dt>Contour error</dt>
    <dd>Distance from the true point of the tool to the nearest point of the commanded path: the error that the part
      gets. On arcs it is positive towards the centre; on lines it is positive to the left of the direction of travel.</dd>
    <dt>Tracking error</dt>
    <dd>Distance from the true point to the point commanded at the same instant. It may be a hundred times larger than
      the contour error and leaves no mark on the part as long as the tool only lags along the path.</dd>
    <dt>Without, with</dt>
    <dd>The same program on the same simulated machine, from the same seed; first with the operator's override alone, then
      with the corrective layer, which may move the feed override only.</dd>
    <dt>Limit</dt>
    <dd>The contour error that the layer has to keep, from the machine file. Figures of error count cutting motion (G1 to G3)
      only; rapids are drawn thin and grey.</dd>
    <dt>Motion of the axes</dt>
    <dd>RMS error of velocity and acceleration against what the simulated machine really did, over every control cycle of the
      cut with the layer: as a control takes them from the differences of the encoder's counts, and as estimated from the edges
      and their times. Bound held: the share of cycles in which the error was within the bound that the estimate gave.</dd>
    <dt>Vibration of the tool</dt>
    <dd>Where the cut of a process was simulated: forced vibration repeats from tooth to tooth, chatter does not; what does not
      repeat is shown by itself. While the spindle's speed is modulated forced vibration repeats only roughly. Vibration is
      not part of the contour error, which is that of the axes.</dd>
    <dt>Thinning</dt>
    <dd>The figures are taken from every control cycle. The curves show a thinned trace in which each thinned group keeps its
      largest contour error.</dd>
  </dl>`;

export function renderPage(host: HTMLElement, report: Report): void {
  const { without, with: layer } = report;
  host.innerHTML = `
  <header>
    <p class="product">Steadyrest report</p>
    <h1>${escapeHtml(report.program)}</h1>
    <p class="facts">Machine <b>${escapeHtml(report.machine)}</b> · strategy <b>${escapeHtml(report.strategy)}</b>
      · contour limit <b>${fixed(report.limit_um, 1)} µm</b></p>
  </header>
  <section aria-label="What the layer was worth">
    <p id="verdict">${verdict(without.figures, layer.figures, report.limit_um)}</p>
    <div class="worths">
      ${headline('contour_error_max_mm', 'Contour error, largest', without.figures.contour_error_max_mm, layer.figures.contour_error_max_mm, micrometres)}
      ${headline('contour_error_rms_mm', 'Contour error, RMS', without.figures.contour_error_rms_mm, layer.figures.contour_error_rms_mm, micrometres)}
      ${headline('cycle_time_s', 'Cycle time', without.figures.cycle_time_s, layer.figures.cycle_time_s, seconds)}
    </div>
  </section>
  <section>
    <div class="bar-head"><h2>Path, coloured by contour error</h2>
      <div class="controls">${choice('plane', 'View', [['xy', 'XY'], ['xz', 'XZ'], ['yz', 'YZ']])}
      <button type="button" id="reset-view">Whole path</button></div></div>
    <div id="legend" class="legend"></div>
    <div class="paths">
      <figure><figcaption><b class="without">Without</b> the layer</figcaption><div class="path" id="path-without"></div></figure>
      <figure><figcaption><b class="with">With</b> the layer</figcaption><div class="path" id="path-with"></div></figure>
    </div>
    <p class="hint">Point at the path for line and value; Ctrl + wheel zooms both views, drag moves them.</p>
  </section>
  <section>
    <div class="bar-head"><h2>Along the program</h2>
      <div class="controls"><span class="key"><i class="without"></i>without</span><span class="key"><i class="with"></i>with the layer</span>
      ${choice('abscissa', 'Horizontal axis', [['time_s', 'Time'], ['path_mm', 'Path length']])}</div></div>
    <div id="course"></div>
    <p class="hint">Ctrl + wheel or the slider zooms. Rapids leave a gap in the error and run off the top of the feed.</p>
  </section>
  <div class="two">
    <section><h2>Figures</h2>${comparisonTable('figures', figureRows(without.figures, layer.figures))}</section>
    <section><h2>Reasons</h2>${reasonsTable(layer.reasons)}${steps(report)}</section>
  </div>
  ${vibrationSection(report)}
  ${probeSection(report)}
  <section><h2>Motion of the axes</h2>${motionTable(report)}</section>
  <section><h2>Worst lines of the program</h2>${worstTable(report)}</section>
  <section class="explanation"><h2>How to read this</h2>${EXPLANATION}</section>
  <footer>Steadyrest ${escapeHtml(report.version)} · the same values stand in <code>report.json</code></footer>`;
}
