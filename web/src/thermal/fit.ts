// SPDX-License-Identifier: Apache-2.0
// A fit: how much temperatures alone tell of each displacement, what the model makes of it, and the residual.
import { element, onChoice } from '../frame/dom';
import { choices, escapeHtml, section } from '../frame/html';
import { counted, fixed, percent, plain, um } from '../frame/numbers';
import { numbers } from '../frame/table';
import { type View, said } from '../frame/view';
import { host, plot } from '../plot/plot';
import { coursePlot, goesOn, nameOf, residualPlot, speedPlot } from './course';
import type { FitPage, FittedAxis } from './data';
import { hysteresisPlot, told } from './hysteresis';

/** Sensors by name, or, if there are many, how many with how many lags. */
function inputs(ambient: readonly { readonly sensor: string; readonly tau_min: number }[]): string {
  const sensors = new Set(ambient.map((i) => i.sensor));
  const lags = new Set(ambient.map((i) => i.tau_min));
  if (ambient.length <= 3) {
    return ambient.map((i) => i.sensor).join(', ') || '–';
  }
  return sensors.size === 1 ? `${[...sensors].join('')}, ${lags.size} lags` : `${sensors.size} sensors, ${lags.size} lags`;
}

function modelTable(page: FitPage): string {
  const rows = page.answer.axes.map((a) => [
    a.axis,
    page.answer.modes
      .filter((m) => m.axis === a.axis)
      .map((m) => (m.rest_tau_min === m.tau_min ? fixed(m.tau_min, 0) : `${fixed(m.tau_min, 0)} (at rest ${fixed(m.rest_tau_min, 0)})`))
      .join(', '),
    inputs(a.ambient),
    um(a.rms_um, 2),
    um(a.left_out_rms_um, 2),
    um(a.left_out_probed_rms_um, 2),
    percent(a.coverage),
  ]);
  return numbers('figures', ['Axis', 'τ, min', 'Inputs', 'Residual, RMS', 'On hours left out', 'Left out, with hourly probe', '95 % band holds'], rows);
}

function overTable(page: FitPage): string {
  const rows = page.axes.flatMap((a) => {
    const best = a.best_sensor === null ? undefined : a.over[a.best_sensor];
    return best === undefined ? [] : [[nameOf(a), page.sensors[a.best_sensor ?? 0] ?? '', fixed(best.correlation, 2), um(best.residual_rms_um, 2), um(best.spread_um, 2)]];
  });
  return numbers('told', ['Displacement', 'Best temperature', 'Correlation', 'Residual of a straight line, RMS', 'Spread at one temperature'], rows);
}

function chooser(page: FitPage, axis: FittedAxis, i: number): string {
  const options = page.sensors.map((name, s) => [String(s), `${name}${s === axis.best_sensor && page.sensors.length > 1 ? ' (best match)' : ''}`] as const);
  return `<h3 class="of">${escapeHtml(nameOf(axis))} over ${choices(`sensor-${i}`, `Temperature for ${nameOf(axis)}`, options, String(axis.best_sensor ?? 0))}</h3><p class="hint" id="told-${i}"></p>`;
}

function verdict(page: FitPage): string {
  return page.axes
    .map((a, i) => {
      const best = a.best_sensor === null ? undefined : a.over[a.best_sensor];
      const fit = page.answer.axes[i];
      const unseen = fit?.left_out_rms_um ?? null;
      const model = `the model leaves ${um(fit?.rms_um, 2)} RMS${unseen === null ? '' : `, and ${um(unseen, 2)} on hours left out of the fit`}`;
      const alone = best === undefined ? '' : `at one temperature the displacement differs by up to ${um(best.spread_um)}; a straight line over ${escapeHtml(page.sensors[a.best_sensor ?? 0] ?? '')} leaves ${um(best.residual_rms_um, 2)} RMS; `;
      return `<b>${escapeHtml(a.axis)}</b>: ${alone}${model}.`;
    })
    .join('<br>');
}

export function fitView(page: FitPage): View {
  const sensor = page.axes.map((a) => a.best_sensor ?? 0);
  const over = page.axes.some((a) => a.over.length > 0);
  const notes = said('notes', page.answer.notes);
  return {
    product: 'Steadyrest thermal fit',
    title: page.title,
    facts: `<b>${counted(page.axes.length, 'displacement', 'displacements')}</b> · <b>${counted(page.sensors.length, 'temperature', 'temperatures')}</b> · <b>${plain(page.answer.hours, 3)} h</b>`,
    verdict: verdict(page),
    body:
      said('warnings', page.answer.warnings ?? []) +
      (over
        ? section(
            'Displacement over temperature',
            `${page.axes.map((a, i) => (a.over.length > 0 ? chooser(page, a, i) + host(`over-${i}`, 'tall') : '')).join('')}${overTable(page)}`,
            'One curve for each run at one spindle speed. If the temperature told the displacement, all curves would lie on one line.',
          )
        : '') +
      section(
        'Measured and modelled',
        `${page.axes.map((_, i) => host(`course-${i}`, 'high') + host(`residual-${i}`)).join('')}${host('speed', 'low')}`,
        `The model runs on the spindle speed and its inputs alone, from the start of the log. The band is what it claims for hours that it has not seen.${page.axes.some(goesOn) ? ' Shaded: the hours fitted; the rest is a forecast.' : ''}`,
      ) +
      section('Figures', modelTable(page)) +
      (notes === '' ? '' : section('Left out of the log', notes)),
    explanation: [
      ['Displacement over temperature', 'One curve for each run at one spindle speed. If the temperature told the displacement, all curves would lie on one line. How far they spread at one temperature is what no correction by that temperature can remove.'],
      ['Modelled', 'What the fitted modes make of the spindle speed and the temperatures alone, from the start of the log, without help from the gauge.'],
      ['Hours left out', 'Hours that the fit had not seen when it forecast them: how good a forecast is. With hourly probe: the same, re-zeroed by a gauge reading every hour.'],
      ['95 % band', 'What the model claims for its own error. It holds if about 95 % of the readings lie within. If far fewer do, the model knows too little of this machine.'],
      ['τ', 'Time constant of a mode: the time it takes to 63 % of its response to a step in speed. At rest: with the spindle stopped.'],
    ],
    draw: (theme) => {
      page.axes.forEach((a, i) => {
        if (a.over.length > 0) {
          plot(`over-${i}`, hysteresisPlot(page, a, sensor[i] as number, theme), theme);
          element(`told-${i}`).innerHTML = told(a.over[sensor[i] as number] as FittedAxis['over'][number]);
        }
        plot(`course-${i}`, coursePlot(a, 'modelled', theme), theme);
        plot(`residual-${i}`, residualPlot(a, 'modelled', theme), theme);
      });
      plot('speed', speedPlot(page.speed, page.axes[0] as FittedAxis, theme), theme);
    },
    bind: (redraw) =>
      page.axes.forEach((_, i) =>
        onChoice(`sensor-${i}`, (value) => {
          sensor[i] = Number(value);
          redraw();
        }),
      ),
  };
}
