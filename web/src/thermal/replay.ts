// SPDX-License-Identifier: Apache-2.0
// A passport set against a log: measured and forecast.
import { type View, host, keyLine, plain, plot, section } from '../chatter/frame';
import { element } from '../dom';
import { fixed } from '../format';
import { escapeHtml } from '../page';
import { coursePlot, goesOn, residualPlot, speedPlot, table, um } from './course';
import type { MeasuredCourse, ReplayPage } from './data';

const BAND = 1.96;

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
        `<div class="key-line" id="key-course"></div>${page.axes.map((a, i) => host(`course-${i}`, 'high') + (measured(a) ? host(`residual-${i}`) : '')).join('')}${host('speed', 'low')}`,
        `The forecast has the recorded speed and temperatures.${page.axes.some(goesOn) ? ' Shaded: readings set the state; from there on it is a forecast.' : ''}`,
      ) + section('Figures', table('figures', ['axis', 'at the end', '95 %', 'off, RMS', '95 % band holds'], rows)),
    draw: (theme) => {
      page.axes.forEach((a, i) => {
        plot(`course-${i}`, coursePlot(a, theme, true), theme);
        if (measured(a)) {
          plot(`residual-${i}`, residualPlot(a, theme), theme);
        }
      });
      plot('speed', speedPlot(page.speed, page.axes[0] as MeasuredCourse, theme), theme);
      element('key-course').innerHTML = keyLine([
        { name: 'measured', colour: theme.run.without },
        { name: 'forecast', colour: theme.run.with },
        { name: '95 % of what is measured lies here', colour: theme.run.with, kind: 'area' },
      ]);
    },
  };
}
