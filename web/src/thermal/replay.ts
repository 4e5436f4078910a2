// SPDX-License-Identifier: Apache-2.0
// A passport tried on a log: measured against forecast.
import { escapeHtml, section } from '../frame/html';
import { counted, fixed, percent, plain, um } from '../frame/numbers';
import { numbers } from '../frame/table';
import type { View } from '../frame/view';
import { host, plot } from '../plot/plot';
import { BAND } from './band';
import { coursePlot, goesOn, residualPlot, speedPlot } from './course';
import type { MeasuredCourse, ReplayPage } from './data';

const measured = (axis: MeasuredCourse) => axis.measured_um.some((v) => v !== null);

function verdict(page: ReplayPage): string {
  return page.answer.axes
    .map((a) => {
      const end = `at the end ${fixed(a.end_um, 1)}\u00a0± ${um(BAND * a.end_sd_um)}`;
      const worth = a.rms_um === null ? 'not measured' : `RMS error ${um(a.rms_um, 2)} against the readings, of which the 95 % band holds ${percent(a.coverage ?? 0)}`;
      return `<b>${escapeHtml(a.axis)}</b>: ${end}; ${worth}.`;
    })
    .join('<br>');
}

export function replayView(page: ReplayPage): View {
  const rows = page.answer.axes.map((a) => [a.axis, um(a.end_um, 2), `±${um(BAND * a.end_sd_um, 2)}`, um(a.rms_um, 2), percent(a.coverage)]);
  const shaded = page.axes.some(goesOn) ? ' Shaded: readings set the state; after that it is a forecast.' : '';
  return {
    product: 'Steadyrest thermal forecast',
    title: page.title,
    facts: `<b>${counted(page.axes.length, 'axis', 'axes')}</b> · <b>${plain(page.answer.minutes / 60, 3)} h</b> of recorded inputs`,
    verdict: verdict(page),
    body:
      section(
        'Measured and forecast',
        `${page.axes.map((a, i) => host(`course-${i}`, 'high') + (measured(a) ? host(`residual-${i}`) : '')).join('')}${host('speed', 'low')}`,
        `The forecast runs on the recorded speed and temperatures.${shaded}`,
      ) + section('Figures', numbers('figures', ['Axis', 'At the end', '95 % band at the end', 'RMS error', '95 % band holds'], rows)),
    explanation: [
      ['Forecast', 'What the passport makes of the recorded speed and temperatures. If readings set the state first, that time is shaded; after it, the gauge counts only where it re-zeroes the forecast.'],
      ['95 % band', 'The band about the forecast that should hold 95 % of the readings. How much it holds, and the RMS error, count from the end of the shaded time.'],
      ['Residual', 'Measured minus forecast: the error that the forecast would have left in the part, with the band about zero.'],
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
