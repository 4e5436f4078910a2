// SPDX-License-Identifier: Apache-2.0
// A tap test: the measured responses, and that of the fitted modes.
import type { Maybe } from '../frame/data';
import { escapeHtml, section } from '../frame/html';
import { counted, fixed, hertz, plain } from '../frame/numbers';
import { numeric, table } from '../frame/table';
import { type Theme, curveColour } from '../frame/theme';
import type { View } from '../frame/view';
import { axisFor, span } from '../plot/axes';
import { type Layer, rules } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import type { FitPage, Response } from './data';

const FITTED = 'fitted';

type Part = (r: Response) => Maybe[];
const each = (r: Response, of: (real: number, imag: number) => number): Maybe[] =>
  r.real_um_N.map((real, i) => {
    const imag = r.imag_um_N[i];
    return real === null || imag === null || imag === undefined ? null : of(real, imag);
  });
export const magnitude: Part = (r) => each(r, Math.hypot);
const LEAST_PHASE = -270;
/** Degrees from −270 to 90: a tool's phase falls from 0 to −180, and noise there must not make it jump a full turn. */
export const phase: Part = (r) =>
  each(r, (real, imag) => {
    const degrees = (Math.atan2(imag, real) * 180) / Math.PI;
    return degrees > LEAST_PHASE + 360 ? degrees - 360 : degrees;
  });

/** Of a measured response: any colour but the blue of the fitted one. */
const colourOf = (i: number, theme: Theme) => curveColour(theme, 2 + (i % 4));

/** All measured responses and the fitted one over frequency; an upright line for each mode. */
function responsePlot(page: FitPage, title: string, unit: string, part: Part, theme: Theme, log = false): Plot {
  const [from, to] = span([...page.measured.flatMap((m) => m.frequency_hz), ...page.fitted.frequency_hz]);
  const y = (r: Response) => (log ? part(r).map((v) => (v !== null && v > 0 ? v : null)) : part(r));
  const curve = (r: Response, name: string, colour: string, width: number): Layer => ({ kind: 'line', name, x: r.frequency_hz, y: y(r), colour, width });
  return {
    title: `${title} of the frequency response`,
    x: { name: 'frequency in Hz', min: from, max: to },
    y: { ...axisFor(`${title.toLowerCase()} in ${unit}`, [...page.measured, page.fitted].flatMap(y), true), log },
    group: 'frequency',
    layers: [
      { ...rules('x', page.answer.modes.map((m) => m.frequency_hz), theme.rapid, true), name: 'natural frequency of a mode' },
      ...page.measured.map((m, i) => curve(m, m.name, colourOf(i, theme), 2.6)),
      curve(page.fitted, FITTED, theme.run.with, 1.6),
    ],
  };
}

/** Imaginary over real part: each mode draws a circle. */
function circlePlot(page: FitPage, theme: Theme): Plot {
  const all = [...page.measured, page.fitted];
  return {
    title: 'Real and imaginary part',
    x: axisFor('real part in µm/N', all.flatMap((r) => r.real_um_N), true),
    y: axisFor('imaginary part in µm/N', all.flatMap((r) => r.imag_um_N), true),
    equal: true,
    plane: true,
    layers: [
      ...page.measured.map((m, i): Layer => ({ kind: 'dots', name: m.name, colour: colourOf(i, theme), size: 4, dots: m.real_um_N.flatMap((x, k) => (x === null || m.imag_um_N[k] == null ? [] : [{ x, y: m.imag_um_N[k] as number }])) })),
      { kind: 'line', name: FITTED, x: page.fitted.real_um_N, y: page.fitted.imag_um_N, colour: theme.run.with, width: 1.6 },
    ],
  };
}

function coherencePlot(page: FitPage, theme: Theme): Plot {
  const [from, to] = span(page.measured.flatMap((m) => m.frequency_hz));
  return {
    title: 'Coherence',
    x: { name: 'frequency in Hz', min: from, max: to },
    y: { name: 'coherence', min: 0, max: 1 },
    group: 'frequency',
    layers: page.measured.flatMap((m, i): Layer[] => (m.coherence ? [{ kind: 'line', name: m.name, x: m.frequency_hz, y: m.coherence, colour: colourOf(i, theme), width: 1.4 }] : [])),
  };
}

function modesTable(page: FitPage): string {
  return table({
    id: 'modes',
    sortable: true,
    columns: [{ head: 'Axis' }, numeric('Frequency, Hz'), numeric('Damping, %'), numeric('Mass, kg'), numeric('Stiffness, N/µm')],
    rows: page.answer.modes.map((m) => [m.axis, fixed(m.frequency_hz, 2), fixed(100 * m.damping_ratio, 3), plain(m.mass_kg), plain(m.stiffness_N_um)]),
  });
}

export function fitView(page: FitPage): View {
  const a = page.answer;
  const coherence = page.measured.some((m) => m.coherence !== undefined);
  const modes = a.modes.map((m) => hertz(m.frequency_hz)).join(', ');
  return {
    product: 'Steadyrest chatter fit',
    title: page.process,
    facts: `direction <b>${escapeHtml(page.axis)}</b> · <b>${counted(page.measured.length, 'response', 'responses')}</b> · <b>${a.points}</b> points from ${fixed(page.band_hz[0], 0)} to ${fixed(page.band_hz[1], 0)} Hz`,
    verdict: `${counted(a.modes.length, 'mode explains', 'modes explain')} all but ${plain(100 * a.residual, 3)}\u00a0% of the response (RMS): ${modes}.`,
    body:
      section('Magnitude and phase', host('magnitude', 'high') + host('phase', 'low') + (coherence ? host('coherence', 'low') : '')) +
      section('Real and imaginary part', `${host('real')}${host('imaginary')}${host('circle', 'square')}`) +
      section('Modes', modesTable(page)),
    explanation: [
      ['Response', 'Tool-tip displacement over hammer force at each frequency. Magnitude: how far 1 N moves the tip. Phase: 0° well below a mode, −90° at the mode, −180° well above.'],
      ['Real and imaginary part', 'The most negative real part sets the deepest cut that is stable at any speed. Each mode draws a circle; a dented or open circle has too few points or another mode close by.'],
      ['Fitted', 'The sum of the modes and of the remainders below and above the band. Where it departs from the measurement, the measurement has noise or a mode that was not asked for.'],
      ['Not explained', 'RMS of measured minus fitted, over the RMS of the response. A few per cent is a good tap test.'],
      ...(coherence ? ([['Coherence', 'How well the response follows the force and repeats from hit to hit: 1 everywhere but in the deepest valleys. If it is below 0.9 near a mode, tap again.']] as const) : []),
    ],
    draw: (theme) => {
      plot('magnitude', responsePlot(page, 'Magnitude', 'µm/N', magnitude, theme, true), theme);
      plot('phase', { ...responsePlot(page, 'Phase', 'degrees', phase, theme), y: { name: 'phase in degrees', min: LEAST_PHASE, max: LEAST_PHASE + 360, step: 90 } }, theme);
      plot('real', responsePlot(page, 'Real part', 'µm/N', (r) => r.real_um_N, theme), theme);
      plot('imaginary', responsePlot(page, 'Imaginary part', 'µm/N', (r) => r.imag_um_N, theme), theme);
      plot('circle', circlePlot(page, theme), theme);
      if (coherence) {
        plot('coherence', coherencePlot(page, theme), theme);
      }
    },
  };
}
