// SPDX-License-Identifier: Apache-2.0
// A tap test: the measured responses and the one that the fitted modes give.
import type { Maybe } from '../frame/data';
import { escapeHtml, section } from '../frame/html';
import { fixed, plain } from '../frame/numbers';
import { table } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { roomy, span } from '../plot/axes';
import type { Layer } from '../plot/layers';
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
/** Degrees from −270 to 90: a tool's response turns from 0 to −180, where noise must not throw it from one end to the other. */
export const phase: Part = (r) =>
  each(r, (real, imag) => {
    const degrees = (Math.atan2(imag, real) * 180) / Math.PI;
    return degrees > LEAST_PHASE + 360 ? degrees - 360 : degrees;
  });

const colourOf = (i: number, theme: Theme) => [theme.run.without, theme.other[3], theme.other[4], theme.other[5]][i % 4] ?? theme.text;

/** All measured responses and the fitted one over frequency; modes as upright lines. */
function responsePlot(page: FitPage, title: string, unit: string, part: Part, theme: Theme, log = false): Plot {
  const [from, to] = span([...page.measured.flatMap((m) => m.frequency_hz), ...page.fitted.frequency_hz]);
  const y = (r: Response) => (log ? part(r).map((v) => (v !== null && v > 0 ? v : null)) : part(r));
  const seen = [...page.measured, page.fitted].flatMap(y);
  const [min, max] = roomy(seen, true);
  const curve = (r: Response, name: string, colour: string, width: number): Layer => ({ kind: 'line', name, x: r.frequency_hz, y: y(r), colour, width });
  return {
    title: `${title} of the frequency response`,
    x: { name: 'frequency in Hz', min: from, max: to },
    y: { name: `${title.toLowerCase()} in ${unit}`, min, max, log },
    group: 'frequency',
    layers: [
      { kind: 'rules', name: 'frequency of a mode', at: page.answer.modes.map((m) => m.frequency_hz), axis: 'x', colour: theme.rapid, dashed: true },
      ...page.measured.map((m, i) => curve(m, m.name, colourOf(i, theme), 2.6)),
      curve(page.fitted, FITTED, theme.run.with, 1.6),
    ],
  };
}

/** The circle that each mode draws: imaginary over real part. */
function circlePlot(page: FitPage, theme: Theme): Plot {
  const all = [...page.measured, page.fitted];
  const [left, right] = roomy(all.flatMap((r) => r.real_um_N), true);
  const [min, max] = roomy(all.flatMap((r) => r.imag_um_N), true);
  return {
    title: 'Real and imaginary part',
    x: { name: 'real part in µm/N', min: left, max: right },
    y: { name: 'imaginary part in µm/N', min, max },
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
  const number = (head: string) => ({ head, number: true });
  return table({
    id: 'modes',
    sortable: true,
    columns: [{ head: 'axis' }, number('Hz'), number('damping, %'), number('mass, kg'), number('stiffness, N/µm')],
    rows: page.answer.modes.map((m) => [m.axis, fixed(m.frequency_hz, 2), fixed(100 * m.damping_ratio, 3), plain(m.mass_kg), plain(m.stiffness_N_um)]),
  });
}

export function fitView(page: FitPage): View {
  const a = page.answer;
  const coherence = page.measured.some((m) => m.coherence !== undefined);
  const modes = a.modes.map((m) => `${fixed(m.frequency_hz, 1)} Hz`).join(', ');
  return {
    product: 'Steadyrest chatter fit',
    title: page.process,
    facts: `direction <b>${escapeHtml(page.axis)}</b> · <b>${page.measured.length}</b> ${page.measured.length === 1 ? 'response' : 'responses'} · <b>${a.points}</b> points from ${fixed(page.band_hz[0], 0)} to ${fixed(page.band_hz[1], 0)} Hz`,
    verdict: `${a.modes.length === 1 ? 'One mode' : `${a.modes.length} modes`} (${modes}) ${a.modes.length === 1 ? 'explains' : 'explain'} all but ${plain(100 * a.residual, 3)} % of the response (RMS).`,
    body:
      section('Magnitude and phase', host('magnitude', 'high') + host('phase', 'low') + (coherence ? host('coherence', 'low') : '')) +
      section('Real and imaginary part', `${host('real')}${host('imaginary')}${host('circle', 'square')}`) +
      section('Modes', modesTable(page)),
    explanation: [
      ['Response', "Displacement of the tool's tip over the force of the hammer, at each frequency. Magnitude: how far 1 N moves it. Phase: 0° well under a mode, −90° on it, −180° well above."],
      ['Real and imaginary part', 'The deepest stable cut follows the most negative real part. Each mode draws a circle; one that is dented or open has too few points or another mode beside it.'],
      ['Fitted', 'The sum of the modes and of what lies above and below the band. Where it leaves the measurement, the measurement has noise, or a mode that was not asked for.'],
      ['Not explained', 'RMS of measured less fitted over the RMS of the response. A few per cent is a good tap test.'],
      ...(coherence ? ([['Coherence', 'How far the response repeats from hit to hit and follows the force: 1 everywhere but at the deepest valleys. Below 0.9 beside a mode: tap again.']] as const) : []),
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
