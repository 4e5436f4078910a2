// SPDX-License-Identifier: Apache-2.0
// How far heat will move each axis during the job.
import { escapeHtml, section } from '../frame/html';
import { counted, plain, um } from '../frame/numbers';
import { numbers } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { axisFor } from '../plot/axes';
import { rules } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { reading } from '../plot/reading';
import { nearestIndex } from '../plot/thin';
import { largestAt } from '../plot/values';
import { BAND } from './band';
import type { Course, ForecastPage } from './data';
import { cyclogramPlot, forecastBand, jobTime, starts, statesUncertainty, withBand } from './over_time';

function forecastPlot(page: ForecastPage, course: Course, theme: Theme): Plot {
  return {
    title: `Displacement of ${course.axis}`,
    x: jobTime(page.transitions),
    y: axisFor(`displacement of ${course.axis} in µm`, withBand(course), true),
    group: 'time',
    layers: [
      starts(page.transitions, theme),
      rules('y', [0], theme.faint),
      ...forecastBand(course, theme.run.without),
      { kind: 'line', name: 'forecast', x: course.t_min, y: course.displacement_um, colour: theme.run.without, width: 2.2 },
    ],
    readout: (t) => {
      const i = nearestIndex(course.t_min, t);
      const band = statesUncertainty(course) ? ` ± ${um(BAND * (course.sd_um[i] ?? 0))}` : '';
      return reading(`${plain(t)} min`, [`${um(course.displacement_um[i])}${band}`]);
    },
  };
}

/** An axis as the table and the verdict tell it. */
interface Told {
  axis: string;
  largest: string;
  after: string;
  atEnd: string;
  /** Empty if not stated. */
  band: string;
}

function told(course: Course): Told {
  const i = largestAt(course.displacement_um);
  return {
    axis: course.axis,
    largest: um(course.displacement_um[i]),
    after: `${plain(course.t_min[i])} min`,
    atEnd: um(course.displacement_um.at(-1)),
    band: statesUncertainty(course) ? `±${um(BAND * (course.sd_um.at(-1) ?? 0))}` : '',
  };
}

function verdict({ axis, largest, after, atEnd, band }: Told): string {
  const last = atEnd === largest ? '' : ` and by ${atEnd} at the end`;
  return `Heat moves ${escapeHtml(axis)} by up to ${largest} (after ${after})${last}.${band === '' ? '' : ` 95 % of the errors at the end are within ${band}.`}`;
}

export function forecastView(page: ForecastPage): View {
  const axes = page.courses.map(told);
  const unstated = axes.every((a) => a.band === '') ? ' The passport states no uncertainty.' : '';
  const rows = axes.map((a) => [a.axis, a.largest, a.after, a.atEnd, a.band === '' ? 'not stated' : a.band]);
  return {
    product: 'Steadyrest thermal forecast',
    title: page.title,
    facts: `<b>${counted(page.transitions.length, 'transition', 'transitions')}</b> · <b>${plain(jobTime(page.transitions).max)} min</b>`,
    verdict: `${axes.map(verdict).join('<br>')}${unstated}`,
    body:
      section('Thermal displacement', `${page.courses.map((_, i) => host(`course-${i}`, 'high')).join('')}${host('speed')}`) +
      section('Figures', numbers('figures', ['Axis', 'Max displacement', 'After', 'At the end', '95 % of errors at the end within'], rows), 'Displacement counts from the start of the job.'),
    explanation: [
      ['Displacement', 'How far heat moves the tool relative to the work along an axis, from the start of the job: what the part gets if nothing is corrected.'],
      ['95 % band', 'If the passport states its uncertainty: the band that should hold 95 % of the readings.'],
      ['Cyclogram', 'The job as a sequence of transitions, each at one spindle speed; upright lines mark their starts.'],
    ],
    draw: (theme) => {
      page.courses.forEach((c, i) => plot(`course-${i}`, forecastPlot(page, c, theme), theme));
      plot('speed', cyclogramPlot(page.transitions, theme), theme);
    },
  };
}
