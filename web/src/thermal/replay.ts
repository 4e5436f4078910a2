// SPDX-License-Identifier: Apache-2.0
// A passport set against a log: measured and forecast.
import { escapeHtml, section } from '../frame/html';
import { fixed, plain } from '../frame/numbers';
import type { View } from '../frame/view';
import { host, plot } from '../plot/plot';
import { BAND, coursePlot, goesOn, residualPlot, speedPlot, um } from './course';
import type { MeasuredCourse, ReplayPage } from './data';
import { named } from './tables';

const measured = (axis: MeasuredCourse) => axis.measured_um.some((v) => v !== null);

function verdict(page: ReplayPage): string {
  return page.answer.axes
    .map((a) => {
      const end = `at the end ${fixed(a.end_um, 1)}\u00a0± ${fixed(BAND * a.end_sd_um, 1)}\u00a0µm`;
      const worth = a.rms_um === null ? 'not measured' : `off by ${um(a.rms_um)} RMS from what was measured; the 95 % band holds ${fixed(100 * (a.coverage ?? 0), 1)} % of it`;
      return `<b>${escapeHtml(a.axis)}</b>: ${end}; ${worth}.`;
    })
    .join('<br>');
}

export function replayView(page: ReplayPage): View {
  const rows = page.answer.axes.map((a) => [a.axis, um(a.end_um), `±${um(BAND * a.end_sd_um)}`, um(a.rms_um), a.coverage === null ? '–' : `${fixed(100 * a.coverage, 1)} %`]);
  return {
    product: 'Steadyrest thermal forecast',
    title: page.title,
    facts: `<b>${page.axes.length}</b> ${page.axes.length === 1 ? 'axis' : 'axes'} · <b>${plain(page.answer.minutes / 60, 3)} h</b> of recorded inputs`,
    verdict: verdict(page),
    body:
      section(
        'Measured and forecast',
        `${page.axes.map((a, i) => host(`course-${i}`, 'high') + (measured(a) ? host(`residual-${i}`) : '')).join('')}${host('speed', 'low')}`,
        `The forecast has the recorded speed and temperatures.${page.axes.some(goesOn) ? ' Shaded: readings set the state; from there on it is a forecast.' : ''}`,
      ) + section('Figures', named('figures', ['axis', 'at the end', '95 %', 'off, RMS', '95 % band holds'], rows)),
    explanation: [
      ['Forecast', 'What the passport makes of the recorded speed and temperatures. Where readings set the state first, that time is shaded; from there on nothing of the gauge is used.'],
      ['95 % band', 'About the forecast: 95 % of the readings should lie within. Off, RMS: of measured less forecast, beyond the shaded time.'],
      ['Measured less forecast', 'What the forecast would have left in the part, with its band about zero.'],
    ],
    draw: (theme) => {
      page.axes.forEach((a, i) => {
        plot(`course-${i}`, coursePlot(a, 'forecast', theme), theme);
        if (measured(a)) {
          plot(`residual-${i}`, residualPlot(a, 'forecast', theme), theme);
        }
      });
      plot('speed', speedPlot(page.speed, page.axes[0] as MeasuredCourse, theme), theme);
    },
  };
}
