// SPDX-License-Identifier: Apache-2.0
// A fit: what temperatures alone tell of each displacement, what the model makes of it, and what is left.
import { element } from '../frame/dom';
import { escapeHtml, section } from '../frame/html';
import { fixed, plain } from '../frame/numbers';
import { type View, said } from '../frame/view';
import { host, plot } from '../plot/plot';
import { coursePlot, goesOn, nameOf, residualPlot, speedPlot, um } from './course';
import type { FitPage, FittedAxis } from './data';
import { hysteresisPlot, told } from './hysteresis';
import { named } from './tables';

/** Sensors by name, or, where there are many, how many with how many lags. */
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
    um(a.rms_um),
    um(a.left_out_rms_um),
    um(a.left_out_probed_rms_um),
    a.coverage === null ? '–' : `${fixed(100 * a.coverage, 1)} %`,
  ]);
  return named('figures', ['axis', 'τ in min', 'inputs', 'left of the hours fitted, RMS', 'of hours left out', 'the same with an hourly probe', '95 % band holds'], rows);
}

function overTable(page: FitPage): string {
  const rows = page.axes.flatMap((a) => {
    const best = a.best_sensor === null ? undefined : a.over[a.best_sensor];
    return best === undefined ? [] : [[nameOf(a), page.sensors[a.best_sensor ?? 0] ?? '', fixed(best.correlation, 2), um(best.residual_rms_um), um(best.spread_um)]];
  });
  return named('told', ['displacement', 'best temperature', 'correlation', 'a straight line leaves, RMS', 'apart at one temperature'], rows);
}

function chooser(page: FitPage, axis: FittedAxis, i: number): string {
  const options = page.sensors.map((name, s) => `<option value="${s}"${s === axis.best_sensor ? ' selected' : ''}>${escapeHtml(name)}${s === axis.best_sensor && page.sensors.length > 1 ? ', which it follows best' : ''}</option>`);
  return `<h3 class="of">${escapeHtml(nameOf(axis))} over <select id="sensor-${i}" aria-label="temperature for ${escapeHtml(nameOf(axis))}">${options.join('')}</select></h3><p class="hint" id="told-${i}"></p>`;
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
  const notes = said('notes', page.answer.notes);
  return {
    product: 'Steadyrest thermal fit',
    title: page.title,
    facts: `<b>${page.axes.length}</b> ${page.axes.length === 1 ? 'displacement' : 'displacements'} · <b>${page.sensors.length}</b> ${page.sensors.length === 1 ? 'temperature' : 'temperatures'} · <b>${plain(page.answer.hours, 3)} h</b>`,
    verdict: verdict(page),
    body:
      said('warnings', page.answer.warnings ?? []) +
      (over
        ? section(
            'Displacement over temperature',
            `${page.axes.map((a, i) => (a.over.length > 0 ? chooser(page, a, i) + host(`over-${i}`, 'tall') : '')).join('')}${overTable(page)}`,
            'One curve for each stretch of one spindle speed. Where a temperature told the displacement, all would lie on one line.',
          )
        : '') +
      section(
        'Measured and modelled',
        `${page.axes.map((_, i) => host(`course-${i}`, 'high') + host(`residual-${i}`)).join('')}${host('speed', 'low')}`,
        `The model has the spindle's speed and its inputs alone, from the beginning on. The band is what it says of hours that it has not seen.${page.axes.some(goesOn) ? ' Shaded: what was fitted; the rest is a forecast.' : ''}`,
      ) +
      section('Figures', modelTable(page)) +
      (notes === '' ? '' : section('What was left out of the log', notes)),
    explanation: [
      ['Displacement over temperature', 'One curve for each stretch of one spindle speed. Where a temperature told the displacement, all would lie on one line; how far they lie apart at one temperature is what no correction by that temperature can take away.'],
      ['Modelled', "What the fitted modes make of the spindle's speed and the temperatures alone, from the beginning of the log on; no reading of the gauge helps."],
      ['Left out', 'Hours that the fit had not seen when it forecast them: what a forecast is worth. With an hourly probe: the same, but a reading of the gauge every hour corrects the state.'],
      ['95 % band', 'What the model says of its own error. It holds when about 95 % of the readings lie within; far fewer: the model knows too little of this machine.'],
      ['τ', 'Time constant of a mode: the time after which 63 % of a step of the speed has come.'],
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
        document.getElementById(`sensor-${i}`)?.addEventListener('change', (e) => {
          sensor[i] = Number((e.target as HTMLSelectElement).value);
          redraw();
        }),
      ),
  };
}
