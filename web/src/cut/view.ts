// SPDX-License-Identifier: Apache-2.0
// The page of `cut`: what the layer was worth, where, and why.
import { onChoice } from '../frame/dom';
import { buttons, escapeHtml, section } from '../frame/html';
import { change, fixed } from '../frame/numbers';
import { type Cell, table } from '../frame/table';
import { type Term, type View, said } from '../frame/view';
import { host, plot } from '../plot/plot';
import { RUNS, type ReasonTime, type Report, type WorstLine } from './data';
import { type FigureRow, figureRows, micrometres, motionRows, seconds, verdict, vibrationRows, vibrationVerdict } from './figures';
import type { Plane } from './path';
import { type Abscissa, COURSES, VIBRATIONS, coursePlot, pathPlot, vibrationPlot } from './plots';
import { errorClasses } from './scale';

function headline(key: string, label: string, before: number, after: number, show: (v: number) => string): string {
  return `<div class="worth" data-key="${key}"><h3>${label}</h3>
    <p><span class="before">${show(before)}</span><span class="arrow" aria-label="becomes">→</span><span class="after">${show(after)}</span></p>
    <p class="change">${change(before, after)}</p></div>`;
}

function comparison(id: string, rows: readonly FigureRow[]): string {
  return table({
    id,
    columns: [{ head: 'Figure' }, { head: 'without', number: true }, { head: 'with', number: true }, { head: 'change', number: true }],
    rows: rows.map((r) => [r.label, r.without, r.with, r.change]),
  });
}

const HELD: Record<WorstLine['held_by'], string> = { 'closed form': 'closed form', record: 'record', driven: 'driven feed' };

export function worstTable(report: Report): string {
  if (report.worst_lines.length === 0) {
    return '<p class="none">No line of the program cuts.</p>';
  }
  const um = (v: number | null): Cell => ({ html: fixed(v, 1), sort: v === null ? null : Math.abs(v), ...(v !== null && Math.abs(v) > report.limit_um ? { look: 'over' } : {}) });
  const number = (v: number | null, decimals: number): Cell => ({ html: fixed(v, decimals), sort: v });
  const byWith = [...report.worst_lines].sort((a, b) => Math.abs(b.with_um ?? -1) - Math.abs(a.with_um ?? -1) || a.line - b.line);
  return table({
    id: 'worst',
    sortable: true,
    sorted: 3,
    columns: [
      { head: 'Line', number: true }, { head: 'Block' }, { head: 'without, µm', number: true }, { head: 'with, µm', number: true },
      { head: 'radius, mm', number: true }, { head: 'driven, mm/min', number: true }, { head: 'would hold, mm/min', number: true }, { head: 'known from' },
    ],
    rows: byWith.map((w) => [
      String(w.line), { html: escapeHtml(w.text), look: 'code' }, um(w.without_um), um(w.with_um),
      number(w.radius_mm, 2), number(w.feed_with_mm_min ?? w.feed_without_mm_min, 0), number(w.hold_feed_mm_min, 0), HELD[w.held_by],
    ]),
  });
}

function reasonsTable(reasons: readonly ReasonTime[]): string {
  const total = reasons.reduce((sum, r) => sum + r.seconds, 0);
  if (total <= 0) {
    return '<p class="none">The layer never acted.</p>';
  }
  const rows = [...reasons]
    .sort((a, b) => b.seconds - a.seconds)
    .map((r): Cell[] => {
      const share = (100 * r.seconds) / total;
      return [
        { html: `${escapeHtml(r.sentence)}<br><code>${escapeHtml(r.reason)}</code>` }, seconds(r.seconds),
        { html: `${fixed(share, 1)} %<span class="share" style="width:${share.toFixed(2)}%"></span>` },
      ];
    });
  return table({ id: 'reasons', columns: [{ head: 'Why the override was there' }, { head: 'time', number: true }, { head: 'share', number: true }], rows });
}

function motionTable(report: Report): string {
  const rows = motionRows(report.motion).map((r) => [`${r.axis}, ${r.quantity}`, r.difference, r.estimate, r.finer, r.coverage]);
  if (rows.length === 0) {
    return '<p class="none">No axis of this machine has an encoder with counts.</p>';
  }
  const number = (head: string) => ({ head, number: true });
  return table({ id: 'motion', columns: [{ head: 'Axis' }, number('difference of counts'), number('estimate'), number('finer'), number('bound held')], rows });
}

/** Empty where no probe read. */
function probeSection(report: Report): string {
  if (report.probes.length === 0) {
    return '';
  }
  const number = (head: string) => ({ head, number: true });
  const rows = report.probes.map((p): Cell[] => [
    `${p.axis} at ${seconds(p.time_s)}`, String(p.line), fixed(p.displacement_um, 2), fixed(p.innovation_um, 2), fixed(p.band_um, 2),
    { html: `${escapeHtml(p.sentence)}<br><code>${escapeHtml(p.reason)}</code>` },
  ]);
  return section(
    'Readings of the probe',
    table({ id: 'probes', columns: [{ head: 'Axis' }, number('line'), number('finds, µm'), number('not foreseen, µm'), number('taken within ±µm'), { head: 'what became of it' }], rows }),
  );
}

/** Empty where the machine cut air. */
function vibrationSection({ without, with: layer }: Report): string {
  if (!without.vibration || !layer.vibration) {
    return '';
  }
  return section('Vibration of the tool', VIBRATIONS.map((v) => host(v.id, 'low')).join('') + comparison('vibration-figures', vibrationRows(without.vibration.figures, layer.vibration.figures)));
}

function steps(report: Report): string {
  const list = report.override_table.map((s) => `<span>${fixed(s.percent, s.percent % 1 === 0 ? 0 : 1)}</span>`).join(' ');
  return list === '' ? '' : `<p class="steps"><b>Steps of the feed override, %:</b> ${list}</p>`;
}

const EXPLANATION: readonly Term[] = [
  [
    'Contour error',
    'Distance from the true point of the tool to the nearest point of the commanded path: the error that the part gets. On arcs it is positive towards the centre; on lines it is positive to the left of the direction of travel.',
  ],
  ['Tracking error', 'Distance from the true point to the point commanded at the same instant. It may be a hundred times larger than the contour error and leaves no mark on the part as long as the tool only lags along the path.'],
  ['Without, with', "The same program on the same simulated machine, from the same seed; first with the operator's override alone, then with the corrective layer, which may move the overrides only."],
  ['Limit', 'The contour error that the layer has to keep, from the machine file. Figures of error count cutting motion (G1 to G3) only; rapids are drawn thin and grey, leave a gap in the error and run off the top of the feed.'],
  [
    'Worst lines',
    'The largest error on each line. Driven: the path feed where it was largest with the layer. Would hold: the feed at which the line keeps the limit. “closed form” takes it from the radius of the arc there and the servo (gain, feed-forward, lag); “record” from the error that was recorded, which grows with the square of the feed on a curve; “driven feed” means that the line kept the limit at the feed that was driven and nothing says how much more it would bear.',
  ],
  [
    'Motion of the axes',
    "RMS error of velocity and acceleration against what the simulated machine really did, over every control cycle of the cut with the layer: as a control takes them from the differences of the encoder's counts, and as estimated from the edges and their times. Bound held: the share of cycles in which the error was within the bound that the estimate gave.",
  ],
  ['Thinning', 'The figures are taken from every control cycle. The curves show a thinned trace in which each thinned group keeps its largest contour error.'],
];

const VIBRATION: Term = [
  'Vibration of the tool',
  "Forced vibration repeats from tooth to tooth, chatter does not; what does not repeat is shown by itself. While the spindle's speed is modulated forced vibration repeats only roughly. Vibration is not part of the contour error, which is that of the axes.",
];

const PROBE: Term = ['Readings of the probe', 'What each reading found, how much of it the thermal model had not foreseen, and the band within which a reading is taken; beyond it a chip or a wrong touch is more likely than heat.'];

function explanation(report: Report): readonly Term[] {
  return [...EXPLANATION, ...(report.with.vibration ? [VIBRATION] : []), ...(report.probes.length > 0 ? [PROBE] : [])];
}

/** What the program asks for and the machine will not do. */
function warnings({ warnings: all = [], warning_count: count = 0 }: Report): string {
  const list = said('warnings', [...all.map((w) => `line ${w.line}: ${w.text}`), ...(count > all.length ? [`${count - all.length} more warnings`] : [])]);
  return list === '' ? '' : section('Warnings about the program', list);
}

function largestError(report: Report): number {
  const inCut = RUNS.flatMap((run) => report[run].trace.contour_error_um.filter((_, i) => report[run].trace.cutting[i] === 1));
  return inCut.reduce<number>((most, e) => Math.max(most, Math.abs(e ?? 0)), 0);
}

function body(report: Report): string {
  const { without, with: layer } = report;
  const [a, b] = [without.figures, layer.figures];
  return `<div class="worths">${headline('contour_error_max_mm', 'Contour error, largest', a.contour_error_max_mm, b.contour_error_max_mm, micrometres)}
      ${headline('contour_error_rms_mm', 'Contour error, RMS', a.contour_error_rms_mm, b.contour_error_rms_mm, micrometres)}
      ${headline('cycle_time_s', 'Cycle time', a.cycle_time_s, b.cycle_time_s, seconds)}</div>
    ${warnings(report)}
    ${section('Path, coloured by contour error', `<div class="panels">${host('path-without', 'square')}${host('path-with', 'square')}</div>`, '<span class="on-screen">Point at the path for line and value.</span>', buttons('plane', 'View', [['xy', 'XY'], ['xz', 'XZ'], ['yz', 'YZ']], 'xy'))}
    ${section('Along the program', `${host('course-error')}${host('course-override', 'low')}${host('course-feed', 'low')}`, '', buttons('abscissa', 'Horizontal axis', [['path_mm', 'Path length'], ['time_s', 'Time']], 'path_mm'))}
    ${section('Worst lines of the program', worstTable(report), '<span class="on-screen">Press a head to sort.</span>')}
    <div class="two">${section('Figures', comparison('figures', figureRows(a, b)))}${section('Reasons', reasonsTable(layer.reasons) + steps(report))}</div>
    ${vibrationSection(report)}${probeSection(report)}${section('Motion of the axes', motionTable(report))}`;
}

export function cutView(report: Report): View {
  const largest_um = largestError(report);
  const state = { plane: 'xy' as Plane, abscissa: 'path_mm' as Abscissa };
  return {
    product: 'Steadyrest report',
    title: report.program,
    facts: `Machine <b>${escapeHtml(report.machine)}</b> · strategy <b>${escapeHtml(report.strategy)}</b> · contour limit <b>${fixed(report.limit_um, 1)} µm</b>`,
    verdict: [verdict(report.without.figures, report.with.figures, report.limit_um), vibrationVerdict(report.without.vibration?.figures, report.with.vibration?.figures)].filter(Boolean).join(' '),
    body: body(report),
    explanation: explanation(report),
    draw: (theme) => {
      const classes = errorClasses(report.limit_um, largest_um, theme.scheme);
      RUNS.forEach((run) => plot(`path-${run}`, pathPlot(report, run, state.plane, classes, theme), theme));
      COURSES.forEach((course) => plot(course.id, coursePlot(report, course, state.abscissa, theme), theme));
      if (report.without.vibration && report.with.vibration) {
        VIBRATIONS.forEach((v) => plot(v.id, vibrationPlot(report, v, state.abscissa, theme), theme));
      }
    },
    bind: (redraw) => {
      onChoice('plane', (value) => {
        state.plane = value as Plane;
        redraw();
      });
      onChoice('abscissa', (value) => {
        state.abscissa = value as Abscissa;
        redraw();
      });
    },
  };
}
