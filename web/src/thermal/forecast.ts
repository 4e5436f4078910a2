// SPDX-License-Identifier: Apache-2.0
// What heat will displace while the work goes on.
import { escapeHtml, section } from '../frame/html';
import { plain } from '../frame/numbers';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { roomy } from '../plot/axes';
import { type Plot, host, plot } from '../plot/plot';
import { nearestIndex } from '../plot/thin';
import { BAND } from './course';
import type { Course, ForecastPage } from './data';
import { band, borders, cyclogramPlot, end, largest, rule, statesUncertainty, um, withBand } from './over_time';
import { named } from './tables';

function forecastPlot(page: ForecastPage, course: Course, theme: Theme): Plot {
  const [min, max] = roomy(withBand(course), true);
  return {
    title: `Displacement of ${course.axis}`,
    x: { name: 'time in min', min: 0, max: end(page.transitions) },
    y: { name: `displacement of ${course.axis} in µm`, min, max },
    group: 'time',
    layers: [
      rule(borders(page.transitions), 'x', theme.rapid, true),
      rule([0], 'y', theme.faint),
      ...band(course, theme.run.without),
      { kind: 'line', name: 'forecast', x: course.t_min, y: course.displacement_um, colour: theme.run.without, width: 2.2 },
    ],
    readout: (t) => {
      const i = nearestIndex(course.t_min, t);
      return `<b>${plain(t)} min</b><br>${um(course.displacement_um[i])} ± ${um(BAND * (course.sd_um[i] ?? 0))}`;
    },
  };
}

const UNSTATED = ' The passport states no uncertainty.';

export function forecastView(page: ForecastPage): View {
  const rows = page.courses.map((c) => {
    const i = largest(c.displacement_um);
    return [c.axis, um(c.displacement_um[i]), `${plain(c.t_min[i])} min`, um(c.displacement_um.at(-1)), statesUncertainty(c) ? `±${um(BAND * (c.sd_um.at(-1) ?? 0))}` : 'not stated'];
  });
  const known = page.courses.some(statesUncertainty);
  return {
    product: 'Steadyrest thermal forecast',
    title: page.title,
    facts: `<b>${page.transitions.length}</b> transitions · <b>${plain(end(page.transitions))} min</b>`,
    verdict: rows.map((r) => `Heat displaces ${escapeHtml(r[0] ?? '')} by ${r[1]} at most, after ${r[2]}${r[3] === r[1] ? '' : `; at the end by ${r[3]}`}${r[4]?.startsWith('±') ? `; 95 % of the errors at the end are within ${r[4]}` : ''}.`).join('<br>') + (known ? '' : UNSTATED),
    body:
      section('Displacement by heat', `${page.courses.map((_, i) => host(`course-${i}`, 'high')).join('')}${host('speed')}`) +
      section('Figures', named('figures', ['axis', 'largest displacement', 'after', 'at the end', '95 % of its error within'], rows), 'Displacements count from the start of the work.'),
    explanation: [
      ['Displacement', 'How far heat moves the tool against the work along an axis, from the start of the work on: what the part gets when nothing is corrected.'],
      ['95 % band', 'Where the passport states its uncertainty: 95 % of what would be measured lies within.'],
      ['Cyclogram', 'The work as stretches of one spindle speed; upright lines are the borders of its transitions.'],
    ],
    draw: (theme) => {
      page.courses.forEach((c, i) => plot(`course-${i}`, forecastPlot(page, c, theme), theme));
      plot('speed', cyclogramPlot(page.transitions, theme), theme);
    },
  };
}
