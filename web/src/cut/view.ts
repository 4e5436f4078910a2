// SPDX-License-Identifier: Apache-2.0
// The page of `cut`: what the layer gained, where, and why.
import { onChoice } from '../frame/dom';
import { buttons, escapeHtml, none, section } from '../frame/html';
import { change, fixed, percent, um } from '../frame/numbers';
import { type Cell, numbers, numeric, table, valued } from '../frame/table';
import { type Term, type View, said } from '../frame/view';
import { host, panels, plot } from '../plot/plot';
import { type Figures, RUNS, type ReasonTime, type Report, type WorstLine } from './data';
import { type FigureRow, figureRows, micrometres, motionRows, seconds, verdict, vibrationRows, vibrationVerdict } from './figures';
import type { Plane } from './path';
import { type Abscissa, COURSES, VIBRATIONS, coursePlot, pathPlot, vibrationPlot } from './plots';
import { errorClasses } from './scale';
import { WAYS } from './way_names';
import { WAYS_TERM, WAY_PLOTS, bestSection, comparesWays, overSection, wayPlot, waysSection } from './ways';

function headline(key: string, label: string, before: number, after: number, show: (v: number) => string): string {
  return `<div class="worth" data-key="${key}"><h3>${label}</h3>
    <p><span class="before">${show(before)}</span><span class="arrow" aria-label="becomes">→</span><span class="after">${show(after)}</span></p>
    <p class="change">${change(before, after)}</p></div>`;
}

function comparison(id: string, rows: readonly FigureRow[]): string {
  return numbers(id, ['Figure', 'Without', 'With', 'Change'], rows.map((r) => [r.label, r.without, r.with, r.change]));
}

const HELD: Record<WorstLine['held_by'], string> = { 'closed form': 'closed form', record: 'recorded error', driven: 'actual feed' };

export function worstTable(report: Report): string {
  if (report.worst_lines.length === 0) {
    return none('No line of the program cuts.');
  }
  const error = (v: number | null): Cell => ({ html: fixed(v, 1), sort: v === null ? null : Math.abs(v), ...(v !== null && Math.abs(v) > report.limit_um ? { look: 'over' } : {}) });
  const number = (v: number | null, decimals: number) => valued(fixed(v, decimals), v);
  const byWith = [...report.worst_lines].sort((a, b) => Math.abs(b.with_um ?? -1) - Math.abs(a.with_um ?? -1) || a.line - b.line);
  return table({
    id: 'worst',
    sortable: true,
    sorted: 3,
    columns: [
      numeric('Line'), { head: 'Block' }, numeric('Without, µm'), numeric('With, µm'),
      numeric('Radius, mm'), numeric('Actual feed, mm/min'), numeric('Holding feed, mm/min'), { head: 'Known from' },
    ],
    rows: byWith.map((w) => [
      String(w.line), { html: escapeHtml(w.text), look: 'code' }, error(w.without_um), error(w.with_um),
      number(w.radius_mm, 2), number(w.feed_with_mm_min ?? w.feed_without_mm_min, 0), number(w.hold_feed_mm_min, 0), HELD[w.held_by],
    ]),
  });
}

function reasonsTable(reasons: readonly ReasonTime[]): string {
  const total = reasons.reduce((sum, r) => sum + r.seconds, 0);
  if (total <= 0) {
    return none('The layer never acted.');
  }
  const rows = [...reasons]
    .sort((a, b) => b.seconds - a.seconds)
    .map((r): Cell[] => {
      const share = r.seconds / total;
      return [
        { html: `${escapeHtml(r.sentence)}<br><code>${escapeHtml(r.reason)}</code>` }, seconds(r.seconds),
        { html: `${percent(share)}<span class="share" style="width:${(100 * share).toFixed(2)}%"></span>` },
      ];
    });
  return table({ id: 'reasons', columns: [{ head: 'Reason' }, numeric('Time'), numeric('Share')], rows });
}

function motionTable(report: Report): string {
  const rows = motionRows(report.motion).map((r) => [`${r.axis}, ${r.quantity}`, r.difference, r.estimate, r.finer, r.coverage]);
  if (rows.length === 0) {
    return none('No axis of this machine has an encoder that counts.');
  }
  return numbers('motion', ['Axis', 'Difference of counts', 'Estimate', 'Better by', 'Bound held'], rows);
}

/** Empty if the probe read nothing. */
function probeSection(report: Report): string {
  if (report.probes.length === 0) {
    return '';
  }
  const rows = report.probes.map((p): Cell[] => [
    `${p.axis} at ${seconds(p.time_s)}`, String(p.line), fixed(p.displacement_um, 2), fixed(p.innovation_um, 2), fixed(p.band_um, 2),
    { html: `${escapeHtml(p.sentence)}<br><code>${escapeHtml(p.reason)}</code>` },
  ]);
  return section(
    'Probe readings',
    table({ id: 'probes', columns: [{ head: 'Axis' }, numeric('Line'), numeric('Displacement, µm'), numeric('Unforeseen, µm'), numeric('Accepted within, ±µm'), { head: 'Outcome' }], rows }),
  );
}

/** Empty if the machine cut air. */
function vibrationSection({ without, with: layer }: Report): string {
  if (!without.vibration || !layer.vibration) {
    return '';
  }
  return section('Tool vibration', VIBRATIONS.map((v) => host(v.id, 'low')).join('') + comparison('vibration-figures', vibrationRows(without.vibration.figures, layer.vibration.figures)));
}

function steps(report: Report): string {
  const list = report.override_table.map((s) => `<span>${fixed(s.percent, s.percent % 1 === 0 ? 0 : 1)}</span>`).join(' ');
  return list === '' ? '' : `<p class="steps"><b>Feed override steps, %:</b> ${list}</p>`;
}

const EXPLANATION: readonly Term[] = [
  [
    'Contour error',
    'Distance from the actual tool position to the nearest point of the commanded path: the error that ends up in the part. On arcs it is positive towards the centre, on lines to the left of the direction of travel.',
  ],
  ['Tracking error', 'Distance from the actual tool position to the position commanded at the same instant. It can be a hundred times the contour error, and leaves no mark on the part as long as the tool merely lags along the path.'],
  ['Without, with', "The same program on the same simulated machine with the same random seed: first on the operator's override alone, then with the corrective layer, which acts through the overrides and, where the machine file permits it, through offsets of the axes."],
  ['Limit', 'The contour error that the layer must hold, from the machine file. Error figures count cutting moves (G1 to G3) only. Rapids are drawn thin and grey; they leave a gap in the error plot and run off the top of the feed plot.'],
  [
    'Worst lines',
    'The largest error on each line. Actual feed: the path feed at that point, with the layer. Holding feed: the feed at which the line holds the limit. It is known from the “closed form” of the arc radius and the servo (gain, feed-forward, lag), or from the “recorded error”, which grows with the square of the feed on a curve. “Actual feed” means that the line held the limit at the feed it ran, and nothing tells how much more it would take.',
  ],
  [
    'Axis motion',
    "RMS error of velocity and acceleration against the simulated machine's actual motion, over every control cycle of the cut with the layer: from differences of encoder counts, as a control takes them, and as estimated from the encoder edges and their times. Bound held: the share of cycles in which the error stayed within the bound given with the estimate.",
  ],
  ['Thinning', 'The figures use every control cycle. The curves show a thinned trace; each group of samples keeps its largest contour error.'],
];

const VIBRATION: Term = [
  'Tool vibration',
  "Forced vibration repeats from tooth to tooth; chatter does not, so the part that does not repeat has a plot of its own. While the spindle speed is modulated, forced vibration repeats only roughly. The contour error is that of the axes and does not include vibration.",
];

const PROBE: Term = ['Probe readings', 'What each reading found, how much of it the thermal model had not foreseen, and the band within which a reading is accepted. Beyond the band, a chip or a bad touch is more likely than heat.'];

const AGAINST: Term = [
  'Against',
  "The program was changed on purpose, so its own path is not what the part should have. Errors are the tool's distance from the path of the original, as the control plans it, while both programs cut. Where the changed program's marks hold the original, the layer leaves feed and offsets alone. A change without marks it cannot know: where it holds that program's path, it undoes the change.",
];

function explanation(report: Report): readonly Term[] {
  return [...(report.against === undefined ? [] : [AGAINST]), ...EXPLANATION, ...(comparesWays(report) ? [WAYS_TERM] : []), ...(report.with.vibration ? [VIBRATION] : []), ...(report.probes.length > 0 ? [PROBE] : [])];
}

/** What the program asks for and the machine will not do. */
function warnings({ warnings: all = [], warning_count: count = 0 }: Report): string {
  const list = said('warnings', [...all.map((w) => `line ${w.line}: ${w.text}`), ...(count > all.length ? [`${count - all.length} more warnings`] : [])]);
  return list === '' ? '' : section('Program warnings', list);
}

function largestError(report: Report): number {
  const inCut = RUNS.flatMap((run) => report[run].trace.contour_error_um.filter((_, i) => report[run].trace.cutting[i] === 1));
  return inCut.reduce<number>((most, e) => Math.max(most, Math.abs(e ?? 0)), 0);
}

/** What the headlines compare: the original and the changed program, else the cut without and with the layer. */
function compared(report: Report): [Figures, Figures] {
  const original = report.against === undefined ? undefined : report.ways.find((w) => w.way === 'alone');
  return original ? [original, report.without.figures] : [report.without.figures, report.with.figures];
}

/** The report with the best way where the layer is, for pictures and curves. */
function withBest(report: Report): Report {
  return report.best_run === undefined ? report : { ...report, with: report.best_run };
}

/** What the second of two cuts is, at the start of a sentence. */
function how(report: Report): string {
  const best = report.best_run === undefined ? undefined : report.best?.same_time;
  return best ? `With ${WAYS[best.way].name}` : report.against === undefined ? 'With the layer' : 'With the changed program';
}

function body(report: Report): string {
  const { without, with: layer } = report;
  const [a, b] = [without.figures, layer.figures];
  const [before, after] = compared(withBest(report));
  return `<div class="worths">${headline('contour_error_max_mm', 'Contour error, max', before.contour_error_max_mm, after.contour_error_max_mm, micrometres)}
      ${headline('contour_error_rms_mm', 'Contour error, RMS', before.contour_error_rms_mm, after.contour_error_rms_mm, micrometres)}
      ${headline('cycle_time_s', 'Cycle time', before.cycle_time_s, after.cycle_time_s, seconds)}</div>
    ${bestSection(report)}
    ${waysSection(report)}
    ${overSection(report)}
    ${warnings(report)}
    ${section('Path, coloured by contour error', panels(RUNS.map((run) => `path-${run}`), 'square'), '<span class="on-screen">Point at the path to read its line and values.</span>', buttons('plane', 'View', [['xy', 'XY'], ['xz', 'XZ'], ['yz', 'YZ']], 'xy'))}
    ${section('Along the program', `${host('course-error')}${host('course-override', 'low')}${host('course-feed', 'low')}`, '', buttons('abscissa', 'Horizontal axis', [['path_mm', 'Path length'], ['time_s', 'Time']], 'path_mm'))}
    ${section(report.best ? 'Worst lines, without and with the layer' : 'Worst lines', worstTable(report), '<span class="on-screen">Click a column head to sort.</span>')}
    <div class="two">${section(report.best ? 'Figures, without and with the layer' : 'Figures', comparison('figures', figureRows(a, b)))}${section('Override reasons', reasonsTable(layer.reasons) + steps(report))}</div>
    ${vibrationSection(report)}${probeSection(report)}${section('Axis motion', motionTable(report))}`;
}

export function cutView(report: Report): View {
  const shown = withBest(report);
  const largest_um = largestError(shown);
  const state = { plane: 'xy' as Plane, abscissa: 'path_mm' as Abscissa };
  return {
    product: 'Steadyrest cut',
    title: report.program,
    facts: `Machine <b>${escapeHtml(report.machine)}</b> · strategy <b>${escapeHtml(report.strategy)}</b> · contour limit <b>${um(report.limit_um)}</b>${report.against === undefined ? '' : ` · against <b>${escapeHtml(report.against)}</b>`}`,
    verdict: [verdict(...compared(shown), report.limit_um, how(report)), vibrationVerdict(report.without.vibration?.figures, report.with.vibration?.figures)].filter(Boolean).join(' '),
    body: body(report),
    explanation: explanation(report),
    draw: (theme) => {
      const classes = errorClasses(report.limit_um, largest_um, theme.scheme);
      RUNS.forEach((run) => plot(`path-${run}`, pathPlot(shown, run, state.plane, classes, theme), theme));
      COURSES.forEach((course) => plot(course.id, coursePlot(shown, course, state.abscissa, theme), theme));
      if (comparesWays(report)) {
        WAY_PLOTS.forEach((id, i) => plot(id, wayPlot(report, i, theme), theme));
      }
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
