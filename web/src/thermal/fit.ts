// SPDX-License-Identifier: Apache-2.0
// A fit: what temperatures alone tell of each displacement, what the model makes of it, and what is left.
import type { Maybe } from '../chatter/data';
import { type View, host, keyLine, plain, plot, section } from '../chatter/frame';
import { type Layer, type Plot, roomy, span } from '../chatter/plot';
import { element } from '../dom';
import { fixed } from '../format';
import { escapeHtml } from '../page';
import type { Theme } from '../theme';
import type { FitPage, FittedAxis } from './data';
import { hysteresisPlot, speedKeys, told } from './hysteresis';

/** 95 % of what is measured lies within that many standard deviations. */
const BAND = 1.96;
/** More time than so many usual steps is a gap. */
const GAP_STEPS = 10;

/** A curve over time with a hole where time has passed that is not recorded. */
export function broken(t: readonly number[], values: readonly Maybe[]): { t: number[]; v: Maybe[] } {
  const steps = t.slice(1).map((v, i) => v - (t[i] as number));
  const usual = [...steps].sort((a, b) => a - b)[Math.floor(steps.length / 2)] ?? 0;
  const out = { t: [] as number[], v: [] as Maybe[] };
  t.forEach((at, i) => {
    if (i > 0 && at - (t[i - 1] as number) > GAP_STEPS * usual) {
      out.t.push(at);
      out.v.push(null);
    }
    out.t.push(at);
    out.v.push(values[i] ?? null);
  });
  return out;
}

function left(axis: FittedAxis): Maybe[] {
  return axis.measured_um.map((v, i) => {
    const model = axis.modelled_um[i];
    return v === null || model === null || model === undefined ? null : v - model;
  });
}

const wide = (axis: FittedAxis) => axis.sd_um.map((sd) => BAND * (sd ?? 0));
const time = (axis: FittedAxis) => ({ name: 'time of the log in h', min: axis.t_h[0] ?? 0, max: axis.t_h.at(-1) ?? 1 });

/** Shaded: what was fitted. Nothing where that is all. */
function window(axis: FittedAxis, theme: Theme): Layer[] {
  const all = (axis.t_h.at(-1) ?? 0) <= axis.fitted_to_h * (1 + 1e-6);
  return all ? [] : [{ kind: 'spans', spans: [[axis.fitted_from_h, axis.fitted_to_h]], colour: theme.faint, opacity: 0.1 }];
}

function nearest(times: readonly number[], t: number): number {
  const i = times.findIndex((v) => v >= t);
  return i < 0 ? times.length - 1 : i;
}

function coursePlot(axis: FittedAxis, theme: Theme): Plot {
  const [min, max] = roomy([...axis.measured_um, ...axis.modelled_um], true);
  const measured = broken(axis.t_h, axis.measured_um);
  const modelled = broken(axis.t_h, axis.modelled_um);
  const rest = left(axis);
  return {
    title: `${axis.channel}: measured and modelled`,
    x: time(axis),
    y: { name: `displacement ${axis.channel} in µm`, min, max },
    layers: [
      ...window(axis, theme),
      { kind: 'rules', at: [0], axis: 'y', colour: theme.faint },
      { kind: 'line', x: measured.t, y: measured.v, colour: theme.run.without, width: 4 },
      { kind: 'line', x: modelled.t, y: modelled.v, colour: theme.run.with, width: 1.6 },
    ],
    readout: (t) => {
      const i = nearest(axis.t_h, t);
      return `<b>${plain(axis.t_h[i])} h</b><br>measured ${fixed(axis.measured_um[i], 1)} µm<br>modelled ${fixed(axis.modelled_um[i], 1)} µm<br>left ${fixed(rest[i], 1)} µm`;
    },
  };
}

function residualPlot(axis: FittedAxis, theme: Theme): Plot {
  const rest = left(axis);
  const half = wide(axis);
  const shown = broken(axis.t_h, rest);
  const [low, high] = span([...rest, ...half, ...half.map((v) => -v)]);
  const [, max] = roomy([0, Math.max(-low, high)], true);
  return {
    title: `${axis.channel}: what the model leaves`,
    x: time(axis),
    y: { name: `${axis.channel}: measured less modelled in µm`, min: -max, max },
    layers: [
      ...window(axis, theme),
      { kind: 'band', x: axis.t_h, low: half.map((v) => -v), high: half, colour: theme.run.with, opacity: 0.18 },
      { kind: 'rules', at: [0], axis: 'y', colour: theme.faint },
      { kind: 'line', x: shown.t, y: shown.v, colour: theme.run.without, width: 1.6 },
    ],
    readout: (t) => {
      const i = nearest(axis.t_h, t);
      return `<b>${plain(axis.t_h[i])} h</b><br>left ${fixed(rest[i], 1)} µm<br>95 % band ±${fixed(half[i], 1)} µm`;
    },
  };
}

function speedPlot(page: FitPage, axis: FittedAxis, theme: Theme): Plot {
  const end = axis.t_h.at(-1) ?? 0;
  const at = page.speed.t_h.flatMap((t, i) => [t, page.speed.t_h[i + 1] ?? Math.max(t, end)]);
  const rpm = page.speed.speed_rpm.flatMap((v) => [v, v]);
  const [min, max] = roomy(rpm, true);
  return {
    title: 'Spindle speed',
    x: time(axis),
    y: { name: 'spindle speed in rev/min', min, max },
    layers: [...window(axis, theme), { kind: 'line', x: at, y: rpm, colour: theme.faint, width: 2 }],
  };
}

function table(id: string, head: readonly string[], rows: readonly (readonly string[])[]): string {
  const cell = (text: string, i: number) => (i === 0 ? `<th scope="row">${escapeHtml(text)}</th>` : `<td class="n">${escapeHtml(text)}</td>`);
  return `<div class="wide"><table id="${id}"><thead><tr>${head.map((h, i) => `<th${i === 0 ? '' : ' class="n"'}>${escapeHtml(h)}</th>`).join('')}</tr></thead>
    <tbody>${rows.map((r) => `<tr>${r.map(cell).join('')}</tr>`).join('')}</tbody></table></div>`;
}

const um = (v: Maybe | undefined) => (v === null || v === undefined ? '–' : `${fixed(v, 2)}\u00a0µm`);

function modelTable(page: FitPage): string {
  const rows = page.answer.axes.map((a) => [
    a.axis,
    page.answer.modes
      .filter((m) => m.axis === a.axis)
      .map((m) => (m.rest_tau_min === m.tau_min ? fixed(m.tau_min, 0) : `${fixed(m.tau_min, 0)} (at rest ${fixed(m.rest_tau_min, 0)})`))
      .join(', '),
    a.ambient.map((i) => i.sensor).join(', ') || '–',
    um(a.rms_um),
    um(a.left_out_rms_um),
    um(a.left_out_probed_rms_um),
    a.coverage === null ? '–' : `${fixed(100 * a.coverage, 1)} %`,
  ]);
  return table('figures', ['axis', 'τ in min', 'inputs', 'left of the fitted, RMS', 'of left-out hours', 'with an hourly probe', '95 % band holds'], rows);
}

function overTable(page: FitPage): string {
  const rows = page.axes.flatMap((a) => {
    const best = a.best_sensor === null ? undefined : a.over[a.best_sensor];
    return best === undefined ? [] : [[a.channel, page.sensors[a.best_sensor ?? 0] ?? '', fixed(best.correlation, 2), um(best.residual_rms_um), um(best.spread_um)]];
  });
  return table('told', ['displacement', 'best temperature', 'correlation', 'a straight line leaves, RMS', 'apart at one temperature'], rows);
}

function chooser(page: FitPage, axis: FittedAxis, i: number): string {
  const options = page.sensors.map((name, s) => `<option value="${s}"${s === axis.best_sensor ? ' selected' : ''}>${escapeHtml(name)}${s === axis.best_sensor && page.sensors.length > 1 ? ', which it follows best' : ''}</option>`);
  return `<h3 class="of">${escapeHtml(axis.channel)} over <select id="sensor-${i}" aria-label="temperature for ${escapeHtml(axis.channel)}">${options.join('')}</select></h3><p class="hint" id="told-${i}"></p>`;
}

function verdict(page: FitPage): string {
  return page.axes
    .map((a, i) => {
      const best = a.best_sensor === null ? undefined : a.over[a.best_sensor];
      const fit = page.answer.axes[i];
      const unseen = fit?.left_out_rms_um ?? null;
      const model = `the model leaves ${um(fit?.rms_um)}${unseen === null ? '' : `, and ${um(unseen)} of hours that it has not seen`}`;
      const alone = best === undefined ? '' : `at one temperature it differs by up to ${fixed(best.spread_um, 1)}\u00a0µm, a straight line over ${escapeHtml(page.sensors[a.best_sensor ?? 0] ?? '')} leaves ${um(best.residual_rms_um)} RMS; `;
      return `<b>${escapeHtml(a.axis)}</b>: ${alone}${model}.`;
    })
    .join('<br>');
}

export function fitView(page: FitPage): View {
  const sensor = page.axes.map((a) => a.best_sensor ?? 0);
  const over = page.axes.some((a) => a.over.length > 0);
  const notes = page.answer.notes.length === 0 ? '' : section('What was left out of the log', `<ul class="notes">${page.answer.notes.map((n) => `<li>${escapeHtml(n)}</li>`).join('')}</ul>`);
  return {
    product: 'Steadyrest thermal fit',
    title: page.title,
    facts: `<b>${page.axes.length}</b> ${page.axes.length === 1 ? 'displacement' : 'displacements'} · <b>${page.sensors.length}</b> ${page.sensors.length === 1 ? 'temperature' : 'temperatures'} · <b>${plain(page.answer.hours, 3)} h</b>`,
    verdict: verdict(page),
    body:
      (over
        ? section(
            'Displacement over temperature',
            `<div class="key-line" id="key-speeds"></div>${page.axes.map((a, i) => (a.over.length > 0 ? chooser(page, a, i) + host(`over-${i}`, 'tall') : '')).join('')}${overTable(page)}`,
            'One curve for each stretch of one spindle speed. Where a temperature told the displacement, all would lie on one line.',
          )
        : '') +
      section(
        'Measured and modelled',
        `<div class="key-line" id="key-course"></div>${page.axes.map((_, i) => host(`course-${i}`, 'high') + host(`residual-${i}`)).join('')}${host('speed', 'low')}`,
        `The model has the spindle's speed and its inputs alone, from the beginning on. The band is what it says of hours that it has not seen.${page.axes.some((a) => window(a, { faint: '' } as Theme).length > 0) ? ' Shaded: what was fitted; the rest is a forecast.' : ''}`,
      ) +
      section('Figures', modelTable(page)) +
      notes,
    draw: (theme) => {
      page.axes.forEach((a, i) => {
        if (a.over.length > 0) {
          plot(`over-${i}`, hysteresisPlot(page, a, sensor[i] as number, theme), theme);
          element(`told-${i}`).innerHTML = told(a.over[sensor[i] as number] as FittedAxis['over'][number]);
        }
        plot(`course-${i}`, coursePlot(a, theme), theme);
        plot(`residual-${i}`, residualPlot(a, theme), theme);
      });
      plot('speed', speedPlot(page, page.axes[0] as FittedAxis, theme), theme);
      if (over) {
        element('key-speeds').innerHTML = keyLine(speedKeys(page.regimes, theme));
      }
      element('key-course').innerHTML = keyLine([
        { name: 'measured', colour: theme.run.without },
        { name: 'modelled', colour: theme.run.with },
        { name: '95 % of what is left lies here', colour: theme.run.with, kind: 'area' },
      ]);
    },
    bind: (redraw) =>
      page.axes.forEach((_, i) =>
        document.getElementById(`sensor-${i}`)?.addEventListener('change', (e) => {
          sensor[i] = Number((e.target as HTMLSelectElement).value);
          redraw();
        }),
      ),
  };
}
