// SPDX-License-Identifier: Apache-2.0
// When to correct and by how much: the paper's figures 4 and 5, and its system R.
import { escapeHtml, section } from '../frame/html';
import { counted, fixed, plain, rpm, um } from '../frame/numbers';
import { figures, numbers } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { axisFor } from '../plot/axes';
import { type Layer, rules } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { reading } from '../plot/reading';
import { nearestIndex } from '../plot/thin';
import { largestAt } from '../plot/values';
import { BAND } from './band';
import { type PlanPage, type PlannedCourse, residual } from './data';
import { cyclogramPlot, forecastBand, jobTime, starts, withBand } from './over_time';

/** The paper's figure 4: curve 1 without, curve 2 with corrections, ±Δk. */
function planPlot(page: PlanPage, course: PlannedCourse, theme: Theme): Plot {
  const left = residual(course);
  const edge = (sign: number): Layer => ({
    kind: 'line',
    name: sign > 0 ? '±Δk' : '−Δk',
    quiet: sign < 0,
    x: course.bands.flatMap((b) => [b.from_min, b.to_min]),
    y: course.bands.flatMap((b) => [sign * b.band_um, sign * b.band_um]),
    colour: theme.limit,
    width: 1,
    dashed: true,
  });
  return {
    title: `Displacement of ${course.axis} without and with correction`,
    x: jobTime(page.transitions),
    y: axisFor(`displacement of ${course.axis} in µm`, [...withBand(course), ...left.um, ...course.bands.flatMap((b) => [-b.band_um, b.band_um])], true),
    group: 'time',
    layers: [
      starts(page.transitions, theme),
      ...forecastBand(course, theme.run.without),
      { ...rules('y', [course.displacement_um[largestAt(course.displacement_um)] ?? 0], theme.run.without, true), name: 'ΔT, max without correction' },
      edge(1),
      edge(-1),
      { kind: 'line', name: '1 without correction', x: course.t_min, y: course.displacement_um, colour: theme.run.without, width: 2 },
      { kind: 'line', name: '2 with correction', x: left.t_min, y: left.um, colour: theme.run.with, width: 2.2 },
    ],
    readout: (t) => {
      const i = nearestIndex(left.t_min, t);
      const j = nearestIndex(course.t_min, t);
      return reading(`${plain(t)} min`, [`without ${um(course.displacement_um[j])}`, `with ${um(left.um[i])}`]);
    },
  };
}

/** The paper's figure 5: the tolerance band follows the corrections in steps. */
function linePlot(page: PlanPage, course: PlannedCourse, theme: Theme): Plot {
  const x: number[] = [0];
  const y: number[] = [0];
  for (const c of course.corrections) {
    x.push(c.t_min, c.t_min);
    y.push(y.at(-1) as number, c.total_um);
  }
  x.push(jobTime(page.transitions).max);
  y.push(y.at(-1) as number);
  const at = (sign: number, key: 'band_um' | 'tolerance_um') => {
    const total = (t: number) => course.corrections.filter((c) => c.t_min <= t + 1e-9).at(-1)?.total_um ?? 0;
    const half = (t: number) => course.bands.find((b) => t >= b.from_min - 1e-9 && t <= b.to_min + 1e-9)?.[key] ?? 0;
    return x.map((t, i) => (i % 2 === 1 && i < x.length - 1 ? (y[i] ?? 0) : total(t)) + sign * half(t));
  };
  const fields = (['tolerance_um', 'band_um'] as const).map((key): Layer => ({ kind: 'band', name: key === 'tolerance_um' ? 'tolerance' : 'share of it for drift', x, low: at(-1, key), high: at(1, key), colour: theme.run.with, opacity: key === 'tolerance_um' ? 0.13 : 0.26 }));
  return {
    title: `Corrections of ${course.axis} and the tolerance band`,
    x: jobTime(page.transitions),
    y: axisFor(`displacement and sum of corrections of ${course.axis} in µm`, [...at(-1, 'tolerance_um'), ...at(1, 'tolerance_um'), ...course.displacement_um], true),
    group: 'time',
    layers: [
      starts(page.transitions, theme),
      ...fields,
      { kind: 'line', name: 'sum of corrections', x, y, colour: theme.run.with, width: 2.2 },
      { kind: 'line', name: 'displacement', x: course.t_min, y: course.displacement_um, colour: theme.run.without, width: 2 },
      {
        kind: 'dots',
        colour: theme.run.with,
        size: 7,
        dots: course.corrections.length > 24 ? [] : course.corrections.map((c) => ({ x: c.t_min, y: c.total_um, label: duration(c.t_min), side: 'top' as const, lift: 2 })),
      },
    ],
  };
}

/** A sentence for each axis: what the corrections leave by the forecast, and how uncertain the forecast is. */
function verdict(page: PlanPage): string {
  return page.answer.axes
    .map((a) => {
      const keep = counted(a.corrections, 'correction keeps', 'corrections keep');
      const less = a.corrections === 0 ? `${escapeHtml(a.axis)} needs no correction: it stays within ${um(a.max_um)}` : `${keep} ${escapeHtml(a.axis)} within ${um(a.residual_um)} instead of ${um(a.max_um)}: ${fixed(a.max_um / a.residual_um, 1)} times less`;
      return `${less}.${a.sd_um > 0 ? ` The forecast itself is uncertain by ±${um(BAND * a.sd_um)}.` : ''}`;
    })
    .join('<br>');
}

/** How long a part of the job takes. */
export function duration(min: number | undefined): string {
  return min !== undefined && min < 1 ? `${plain(60 * min, 2)} s` : `${plain(min, 3)} min`;
}

/** This many transitions are all shown; of more, only those with corrections, */
const SHORT_R = 40;
/** and no more than these. */
const MOST_R = 200;

/** R = {n; {t}; {δ}} for each transition, as in the paper. */
function systemR(page: PlanPage, axis: PlanPage['answer']['axes'][number]): string {
  const all = axis.transitions.map((t, i) => ({ t, i }));
  const chosen = all.length <= SHORT_R ? all : all.filter(({ t }) => t.delta_um.some((d) => d !== 0)).slice(0, MOST_R);
  const rows = chosen.map(({ t, i }) => [
    t.name || `${i + 1}`,
    duration(page.transitions[i]?.minutes),
    rpm(page.transitions[i]?.speed_rpm ?? 0),
    `${t.t_min.length}`,
    t.t_min.map((v) => plain(v, 3)).join(', '),
    t.delta_um.map((v) => plain(v)).join(', '),
  ]);
  const hint = chosen.length < all.length ? `<p class="hint">Shown: ${chosen.length === MOST_R ? `the first ${MOST_R} transitions` : counted(chosen.length, 'transition', 'transitions')} with corrections, of ${all.length} in all.</p>` : '';
  return hint + numbers(`system-${axis.axis}`, [`Transition, ${axis.axis}`, 'Duration', 'Spindle', 'Intervals n', 'Lengths t, min', 'Corrections δ, µm'], rows);
}

export function planView(page: PlanPage): View {
  const rows = page.answer.axes.flatMap((a) => [
    { label: `${a.axis}: max without correction`, value: um(a.max_um) },
    { label: `${a.axis}: max with correction`, value: um(a.residual_um) },
    { label: `${a.axis}: corrections`, value: `${a.corrections}` },
    { label: `${a.axis}: 95 % of the forecast's errors within`, value: a.sd_um > 0 ? `±${um(BAND * a.sd_um)}` : 'not stated' },
  ]);
  return {
    product: 'Steadyrest thermal plan',
    title: page.title,
    facts: `Δ <b>${plain(page.answer.tolerance_um)} µm</b> · level <b>${page.answer.level}</b> · k <b>${plain(page.answer.k)}</b>`,
    verdict: verdict(page),
    body:
      section(
        'Displacement without and with correction',
        `${page.courses.map((_, i) => host(`course-${i}`, 'high')).join('')}`,
        'A correction is made when the remaining displacement reaches its share of the tolerance.',
      ) +
      section('Tolerance band', `${page.courses.map((_, i) => host(`line-${i}`, 'high')).join('')}`) +
      section('Cyclogram', host('speed')) +
      section('The system R', page.answer.axes.map((a) => systemR(page, a)).join(''), 'For each transition: its intervals, and the correction at the start of each.') +
      section('Figures', figures(rows)),
    explanation: [
      ['Δ, k, ±Δk', 'Δ is the part tolerance, k the share of it that drift may use; Δk = k·Δ. A correction is made when the remaining displacement reaches Δk.'],
      ['Curve 1, curve 2', 'The forecast displacement without correction, and what remains of it with the corrections (figure 4 of Marusich’s paper).'],
      ['Tolerance band', 'The corrections move the tolerance band in steps, and the displacement stays inside it (figure 5 of the paper).'],
      ['System R', 'R = {n; {t}; {δ}}: for each transition the number of its intervals, the length of each, and the correction at the start of each.'],
    ],
    draw: (theme) => {
      page.courses.forEach((c, i) => {
        plot(`course-${i}`, planPlot(page, c, theme), theme);
        plot(`line-${i}`, linePlot(page, c, theme), theme);
      });
      plot('speed', cyclogramPlot(page.transitions, theme), theme);
    },
  };
}
