// SPDX-License-Identifier: Apache-2.0
// The pages: forecast, plan (the paper's figures 4 and 5), and a batch of parts.
import type { Maybe } from '../chatter/data';
import { type View, figures, host, keyLine, plain, plot, section } from '../chatter/frame';
import { type Layer, type Plot, roomy } from '../chatter/plot';
import { fixed } from '../format';
import { escapeHtml } from '../page';
import type { Theme } from '../theme';
import { table } from './course';
import { type BatchPage, type Course, type ForecastPage, type PlanPage, type PlannedCourse, type Transition, residual } from './data';

/** 95 % of what is measured lies within that many standard deviations. */
const BAND = 1.96;

const rule = (at: readonly number[], axis: 'x' | 'y', colour: string, dashed = false): Layer => ({ kind: 'rules', at, axis, colour, dashed });
const um = (value: Maybe | undefined) => `${fixed(value ?? 0, 1)} µm`;

function put(id: string, html: string): void {
  const where = document.getElementById(id);
  if (where) {
    where.innerHTML = html;
  }
}

const borders = (transitions: readonly Transition[]) => transitions.slice(1).map((t) => t.start_min);
const end = (transitions: readonly Transition[]) => Math.max(...transitions.map((t) => t.start_min + t.minutes));

function band(course: Course, colour: string): Layer {
  const at = (sign: number) => course.displacement_um.map((v, i) => (v === null ? null : v + sign * BAND * (course.sd_um[i] ?? 0)));
  return { kind: 'band', x: course.t_min, low: at(-1), high: at(1), colour, opacity: 0.18 };
}

/** A passport without covariance states no uncertainty. */
const unsure = (course: Course) => course.sd_um.some((v) => (v ?? 0) > 0);

function withBand(course: Course): Maybe[] {
  return course.displacement_um.flatMap((v, i) => [(v ?? 0) - BAND * (course.sd_um[i] ?? 0), (v ?? 0) + BAND * (course.sd_um[i] ?? 0)]);
}

function nearest(times: readonly number[], t: number): number {
  const i = times.findIndex((v) => v >= t);
  return i < 0 ? times.length - 1 : i;
}

function speedPlot(transitions: readonly Transition[], theme: Theme): Plot {
  const x = transitions.flatMap((t) => [t.start_min, t.start_min + t.minutes]);
  const y = transitions.flatMap((t) => [Math.abs(t.speed_rpm), Math.abs(t.speed_rpm)]);
  const [min, max] = roomy(y, true);
  return {
    title: 'Cyclogram: spindle speed',
    x: { name: 'time in min', min: 0, max: end(transitions) },
    y: { name: 'spindle speed in rev/min', min, max },
    layers: [rule(borders(transitions), 'x', theme.rapid, true), { kind: 'line', x, y, colour: theme.faint, width: 2 }],
  };
}

function forecastPlot(page: ForecastPage, course: Course, theme: Theme): Plot {
  const [min, max] = roomy(withBand(course), true);
  return {
    title: `Displacement of ${course.axis}`,
    x: { name: 'time in min', min: 0, max: end(page.transitions) },
    y: { name: `displacement of ${course.axis} in µm`, min, max },
    layers: [
      rule(borders(page.transitions), 'x', theme.rapid, true),
      rule([0], 'y', theme.faint),
      band(course, theme.run.without),
      { kind: 'line', x: course.t_min, y: course.displacement_um, colour: theme.run.without, width: 2.2 },
    ],
    readout: (t) => {
      const i = nearest(course.t_min, t);
      return `<b>${plain(t)} min</b><br>${um(course.displacement_um[i])} ± ${um(BAND * (course.sd_um[i] ?? 0))}`;
    },
  };
}

/** Where it is largest. */
function largest(values: readonly Maybe[]): number {
  return values.reduce<number>((most, v, i) => (Math.abs(v ?? 0) > Math.abs(values[most] ?? 0) ? i : most), 0);
}

const UNSTATED = ' The passport states no uncertainty.';

export function forecastView(page: ForecastPage): View {
  const rows = page.courses.map((c) => {
    const i = largest(c.displacement_um);
    return [c.axis, um(c.displacement_um[i]), `${plain(c.t_min[i])} min`, um(c.displacement_um.at(-1)), unsure(c) ? `±${um(BAND * (c.sd_um.at(-1) ?? 0))}` : 'not stated'];
  });
  const known = page.courses.some(unsure);
  return {
    product: 'Steadyrest thermal forecast',
    title: page.title,
    facts: `<b>${page.transitions.length}</b> transitions · <b>${plain(end(page.transitions))} min</b>`,
    verdict: rows.map((r) => `Heat displaces ${escapeHtml(r[0] ?? '')} by ${r[1]} at most, after ${r[2]}${r[3] === r[1] ? '' : `; at the end by ${r[3]}`}${r[4]?.startsWith('±') ? `; 95 % of the errors at the end are within ${r[4]}` : ''}.`).join('<br>') + (known ? '' : UNSTATED),
    body:
      section('Displacement by heat', `<div class="key-line" id="key-forecast"></div>${page.courses.map((_, i) => host(`course-${i}`, 'high')).join('')}${host('speed')}`) +
      section('Figures', table('figures', ['axis', 'largest displacement', 'after', 'at the end', '95 % of its error within'], rows), 'Displacements count from the start of the work.'),
    draw: (theme) => {
      page.courses.forEach((c, i) => plot(`course-${i}`, forecastPlot(page, c, theme), theme));
      plot('speed', speedPlot(page.transitions, theme), theme);
      put(
        'key-forecast',
        keyLine([
          { name: 'forecast', colour: theme.run.without },
          ...(known ? [{ name: '95 % of what is measured lies here', colour: theme.run.without, kind: 'area' as const }] : []),
        ]),
      );
    },
  };
}

/** The paper's figure 4: curve 1 without, curve 2 with corrections, ±Δ_k. */
function planPlot(page: PlanPage, course: PlannedCourse, theme: Theme): Plot {
  const left = residual(course);
  const [min, max] = roomy([...withBand(course), ...left.um, ...course.bands.flatMap((b) => [-b.band_um, b.band_um])], true);
  const edge = (sign: number): Layer => ({
    kind: 'line',
    x: course.bands.flatMap((b) => [b.from_min, b.to_min]),
    y: course.bands.flatMap((b) => [sign * b.band_um, sign * b.band_um]),
    colour: theme.limit,
    width: 1,
    dashed: true,
  });
  return {
    title: `Displacement of ${course.axis} without and with correction`,
    x: { name: 'time in min', min: 0, max: end(page.transitions) },
    y: { name: `displacement of ${course.axis} in µm`, min, max },
    layers: [
      rule(borders(page.transitions), 'x', theme.rapid, true),
      band(course, theme.run.without),
      rule([course.displacement_um[largest(course.displacement_um)] ?? 0], 'y', theme.run.without, true),
      edge(1),
      edge(-1),
      { kind: 'line', x: course.t_min, y: course.displacement_um, colour: theme.run.without, width: 2 },
      { kind: 'line', x: left.t_min, y: left.um, colour: theme.run.with, width: 2.2 },
    ],
    readout: (t) => {
      const i = nearest(left.t_min, t);
      const j = nearest(course.t_min, t);
      return `<b>${plain(t)} min</b><br>without ${um(course.displacement_um[j])}<br>with ${um(left.um[i])}`;
    },
  };
}

/** The paper's figure 5: the field of tolerance about the work, and the broken line of corrections. */
function linePlot(page: PlanPage, course: PlannedCourse, theme: Theme): Plot {
  const x: number[] = [0];
  const y: number[] = [0];
  for (const c of course.corrections) {
    x.push(c.t_min, c.t_min);
    y.push(y.at(-1) as number, c.total_um);
  }
  x.push(end(page.transitions));
  y.push(y.at(-1) as number);
  const at = (sign: number, key: 'band_um' | 'tolerance_um') => {
    const total = (t: number) => course.corrections.filter((c) => c.t_min <= t + 1e-9).at(-1)?.total_um ?? 0;
    const half = (t: number) => course.bands.find((b) => t >= b.from_min - 1e-9 && t <= b.to_min + 1e-9)?.[key] ?? 0;
    return x.map((t, i) => (i % 2 === 1 && i < x.length - 1 ? (y[i] ?? 0) : total(t)) + sign * half(t));
  };
  const fields = (['tolerance_um', 'band_um'] as const).map((key): Layer => ({ kind: 'band', x, low: at(-1, key), high: at(1, key), colour: theme.run.with, opacity: 0.13 }));
  const [min, max] = roomy([...at(-1, 'tolerance_um'), ...at(1, 'tolerance_um'), ...course.displacement_um], true);
  return {
    title: `Corrections of ${course.axis} and the field of tolerance`,
    x: { name: 'time in min', min: 0, max: end(page.transitions) },
    y: { name: `${course.axis}: displacement and sum of corrections in µm`, min, max },
    layers: [
      rule(borders(page.transitions), 'x', theme.rapid, true),
      ...fields,
      { kind: 'line', x, y, colour: theme.run.with, width: 2.2 },
      { kind: 'line', x: course.t_min, y: course.displacement_um, colour: theme.run.without, width: 2 },
      {
        kind: 'dots',
        colour: theme.run.with,
        size: 7,
        dots: course.corrections.length > 24 ? [] : course.corrections.map((c) => ({ x: c.t_min, y: c.total_um, label: `${plain(c.t_min)} min`, side: 'top' as const, lift: 2 })),
      },
    ],
  };
}

/** So many transitions are shown whole; of more only those with corrections, and no more than so many. */
const SHORT_R = 40;
const MOST_R = 200;

/** R = {n; {t}; {δ}} of each transition, as in the paper. */
function systemR(page: PlanPage, axis: PlanPage['answer']['axes'][number]): string {
  const all = axis.transitions.map((t, i) => ({ t, i }));
  const chosen = all.length <= SHORT_R ? all : all.filter(({ t }) => t.delta_um.some((d) => d !== 0)).slice(0, MOST_R);
  const rows = chosen.map(({ t, i }) => [
    t.name || `${i + 1}`,
    `${plain(page.transitions[i]?.minutes)} min`,
    `${fixed(page.transitions[i]?.speed_rpm ?? 0, 0)} rev/min`,
    `${t.t_min.length}`,
    t.t_min.map((v) => plain(v)).join(', '),
    t.delta_um.map((v) => plain(v)).join(', '),
  ]);
  const hint = chosen.length < all.length ? `<p class="hint">${chosen.length} of ${all.length} transitions: those with corrections${chosen.length === MOST_R ? ', the first of them' : ''}.</p>` : '';
  return hint + table(`system-${axis.axis}`, [`transition, ${axis.axis}`, 'lasts', 'spindle', 'intervals n', 'their t in min', 'δ at their beginnings in µm'], rows);
}

export function planView(page: PlanPage): View {
  const rows = page.answer.axes.flatMap((a) => [
    { label: `${a.axis}: largest without correction`, value: um(a.max_um) },
    { label: `${a.axis}: largest with correction`, value: um(a.residual_um) },
    { label: `${a.axis}: corrections`, value: `${a.corrections}` },
    { label: `${a.axis}: 95 % of the forecast's error within`, value: a.sd_um > 0 ? `±${um(BAND * a.sd_um)}` : 'not stated' },
  ]);
  const first = page.answer.axes[0];
  return {
    product: 'Steadyrest thermal plan',
    title: page.title,
    facts: `Δ <b>${plain(page.answer.tolerance_um)} µm</b> · level <b>${page.answer.level}</b> · k <b>${plain(page.answer.k)}</b>`,
    verdict: first ? `${first.corrections} corrections keep ${first.axis} within ${um(first.residual_um)} instead of ${um(first.max_um)}: ${fixed(first.ratio, 1)} times less.` : '',
    body:
      section(
        'Displacement without and with correction',
        `<div class="key-line" id="key-plan"></div>${page.courses.map((_, i) => host(`course-${i}`, 'high')).join('')}`,
        'A correction is made where what is left reaches its share of the tolerance.',
      ) +
      section('Field of tolerance', `<div class="key-line" id="key-line"></div>${page.courses.map((_, i) => host(`line-${i}`, 'high')).join('')}`) +
      section('Cyclogram', host('speed')) +
      section('The system R', page.answer.axes.map((a) => systemR(page, a)).join(''), 'Of each transition: its intervals, and the correction that is made at the beginning of each.') +
      section('Figures', figures(rows)),
    draw: (theme) => {
      page.courses.forEach((c, i) => {
        plot(`course-${i}`, planPlot(page, c, theme), theme);
        plot(`line-${i}`, linePlot(page, c, theme), theme);
      });
      plot('speed', speedPlot(page.transitions, theme), theme);
      put(
        'key-plan',
        keyLine([
          { name: '1 without correction', colour: theme.run.without },
          ...(page.courses.some(unsure) ? [{ name: 'its 95 % band', colour: theme.run.without, kind: 'area' as const }] : []),
          { name: 'ΔT, the largest without correction', colour: theme.run.without, kind: 'dashed' },
          { name: '2 with correction', colour: theme.run.with },
          { name: '±Δk', colour: theme.limit, kind: 'dashed' },
        ]),
      );
      put(
        'key-line',
        keyLine([
          { name: 'sum of corrections', colour: theme.run.with },
          { name: 'tolerance, and the share of it that heat may take', colour: theme.run.with, kind: 'area' },
          { name: 'displacement', colour: theme.run.without },
        ]),
      );
    },
  };
}

/** Minutes from … to of each part. */
function parts(page: BatchPage): [number, number][] {
  return page.answer.parts.map((p) => [p.start_s / 60, (p.start_s + page.answer.program_s) / 60]);
}

function dayPlot(page: BatchPage, theme: Theme): Plot {
  const c = page.course;
  const [min, max] = roomy([...c.without_um, ...c.text_um, ...c.online_um], true);
  return {
    title: `Error of ${page.axis} by heat over the batch`,
    x: { name: 'time in min', min: 0, max: page.answer.total_s / 60 },
    y: { name: `error of ${page.axis} in µm`, min, max },
    layers: [
      { kind: 'spans', spans: parts(page), colour: theme.faint, opacity: 0.08 },
      rule([0], 'y', theme.faint),
      rule([-page.answer.band_um, page.answer.band_um], 'y', theme.limit, true),
      { kind: 'line', x: c.t_min, y: c.without_um, colour: theme.run.without, width: 2 },
      // In a pause no text runs: nothing is corrected then.
      { kind: 'line', x: c.t_min, y: c.text_um.map((v, i) => (c.part[i] ? v : null)), colour: theme.faint, width: 1.6 },
      { kind: 'line', x: c.t_min, y: c.online_um, colour: theme.run.with, width: 2 },
    ],
    readout: (t) => {
      const i = nearest(c.t_min, t);
      return `<b>${plain(t)} min</b>${c.part[i] ? `, part ${c.part[i]}` : ''}<br>without ${um(c.without_um[i])}<br>in the text ${um(c.text_um[i])}<br>on line ${um(c.online_um[i])}<br>room ${fixed(c.room_c[i], 1)} °C`;
    },
  };
}

/** The growth of the machine, and what the layer believed of it. */
function beliefPlot(page: BatchPage, theme: Theme): Plot {
  const c = page.course;
  const edge = (sign: number) => c.model_um.map((v, i) => v + sign * BAND * (c.model_sd_um[i] ?? 0));
  const [min, max] = roomy([...c.without_um, ...edge(-1), ...edge(1)], true);
  return {
    title: `Displacement of ${page.axis} and what the model believed`,
    x: { name: 'time in min', min: 0, max: page.answer.total_s / 60 },
    y: { name: `displacement of ${page.axis} in µm`, min, max },
    layers: [
      { kind: 'spans', spans: parts(page), colour: theme.faint, opacity: 0.08 },
      rule([0], 'y', theme.faint),
      { kind: 'band', x: c.t_min, low: edge(-1), high: edge(1), colour: theme.run.with, opacity: 0.18 },
      { kind: 'line', x: c.t_min, y: c.without_um, colour: theme.run.without, width: 3 },
      { kind: 'line', x: c.t_min, y: c.model_um, colour: theme.run.with, width: 1.6 },
    ],
    readout: (t) => {
      const i = nearest(c.t_min, t);
      return `<b>${plain(t)} min</b><br>it was ${um(c.without_um[i])}<br>believed ${um(c.model_um[i])} ± ${um(BAND * (c.model_sd_um[i] ?? 0))}`;
    },
  };
}

function roomPlot(page: BatchPage, theme: Theme): Plot {
  const [min, max] = roomy(page.course.room_c);
  return {
    title: 'Temperature of the room',
    x: { name: 'time in min', min: 0, max: page.answer.total_s / 60 },
    y: { name: 'room in °C', min, max },
    layers: [{ kind: 'spans', spans: parts(page), colour: theme.faint, opacity: 0.08 }, { kind: 'line', x: page.course.t_min, y: page.course.room_c, colour: theme.faint, width: 1.6 }],
  };
}

function partPlot(page: BatchPage, theme: Theme): Plot {
  const all = page.answer.parts;
  const dots = (of: 'without' | 'text' | 'online') => all.map((p, i) => ({ x: i + 1, y: p[of].largest_um }));
  const [, max] = roomy([0, ...all.map((p) => p.without.largest_um)], true);
  const line = (of: 'without' | 'text' | 'online', colour: string): Layer[] => [
    { kind: 'line', x: all.map((_, i) => i + 1), y: all.map((p) => p[of].largest_um), colour, width: 1.2 },
    { kind: 'dots', dots: dots(of), colour, size: 8 },
  ];
  return {
    title: 'Largest error of each part',
    x: { name: 'part', min: 0, max: all.length + 1 },
    y: { name: 'largest error in µm', min: 0, max },
    layers: [...line('without', theme.run.without), ...line('text', theme.faint), ...line('online', theme.run.with)],
  };
}

export function batchView(page: BatchPage): View {
  const a = page.answer;
  const row = (name: string, e: { largest_um: number; rms_um: number }) => [
    { label: `${name}: largest error`, value: um(e.largest_um) },
    { label: `${name}: RMS`, value: um(e.rms_um) },
  ];
  const worse = a.text.worse_parts + a.online.worse_parts;
  return {
    product: 'Steadyrest cut, a batch',
    title: page.title,
    facts: `<b>${a.parts.length}</b> parts · <b>${plain(a.total_s / 3600, 3)} h</b> from cold · axis <b>${page.axis}</b>`,
    verdict: `Corrected in the program's text the largest error is ${fixed(a.text.improvement, 1)} times smaller, on line ${fixed(a.online.improvement, 1)} times; ${worse === 0 ? 'no part is worse for it' : `${worse} parts are worse for it`}.`,
    body:
      section('The day', `<div class="key-line" id="key-day"></div>${host('day', 'high')}`, 'Shaded: a part is being cut. The model is wrong as the machine file says; the probe reads before each part.') +
      section('The parts', host('parts')) +
      section('What the model believed', `<div class="key-line" id="key-belief"></div>${host('belief')}${host('room', 'low')}`, 'Steps: a reading of the probe.') +
      section('Figures', figures([...row('without correction', a.without), ...row('in the text', a.text), ...row('on line', a.online)])),
    draw: (theme) => {
      plot('day', dayPlot(page, theme), theme);
      plot('parts', partPlot(page, theme), theme);
      plot('belief', beliefPlot(page, theme), theme);
      plot('room', roomPlot(page, theme), theme);
      put(
        'key-belief',
        keyLine([
          { name: 'the machine', colour: theme.run.without },
          { name: 'the model', colour: theme.run.with },
          { name: 'its 95 % band', colour: theme.run.with, kind: 'area' },
        ]),
      );
      put(
        'key-day',
        keyLine([
          { name: 'without correction', colour: theme.run.without },
          { name: "in the program's text", colour: theme.faint },
          { name: 'on line', colour: theme.run.with },
          { name: '±Δk', colour: theme.limit, kind: 'dashed' },
        ]),
      );
    },
  };
}
