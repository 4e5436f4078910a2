// SPDX-License-Identifier: Apache-2.0
// A cut in time: displacement, force, and what the tool does once a revolution.
import { section } from '../frame/html';
import { fixed, plain } from '../frame/numbers';
import { figures } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { roomy } from '../plot/axes';
import type { Layer } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { type SimulatePage, lawText } from './data';

/** What x and y are. */
const AXES = {
  milling: { x: 'x, along the feed', y: 'y, across it' },
  turning: { x: 'x, into the work', y: 'y, along the cutting speed' },
};
const BAND = 0.55;

function axisColours(theme: Theme): { x: string; y: string; force: string } {
  return { x: theme.run.with, y: theme.run.without, force: theme.scheme === 'light' ? '#4f5b66' : '#a9b4be' };
}

/** Does the tool move along y at all? */
function movesInY(page: SimulatePage): boolean {
  return [...page.envelope.y_low_um, ...page.envelope.y_high_um].some((v) => v !== 0);
}

function motionPlot(page: SimulatePage, theme: Theme): Plot {
  const { t_s, x_low_um, x_high_um, y_low_um, y_high_um } = page.envelope;
  const colours = axisColours(theme);
  const both = movesInY(page);
  const [min, max] = roomy([...x_low_um, ...x_high_um, ...(both ? [...y_low_um, ...y_high_um] : [])], true);
  const layers: Layer[] = [{ kind: 'band', name: AXES[page.operation].x, x: t_s, low: x_low_um, high: x_high_um, colour: colours.x, opacity: both ? BAND : 0.85, outlined: true }];
  if (both) {
    layers.push({ kind: 'band', name: AXES[page.operation].y, x: t_s, low: y_low_um, high: y_high_um, colour: colours.y, opacity: BAND, outlined: true });
  }
  return { title: 'Displacement', x: { name: 'time in s', min: 0, max: t_s.at(-1) ?? 1 }, y: { name: 'displacement in µm', min, max }, group: 'time', layers };
}

function forcePlot(page: SimulatePage, theme: Theme): Plot {
  const { t_s, force_low_N, force_high_N } = page.envelope;
  const [min, max] = roomy(force_high_N, true);
  return {
    title: 'Force',
    x: { name: 'time in s', min: 0, max: t_s.at(-1) ?? 1 },
    y: { name: 'force on the tool in N', min, max },
    group: 'time',
    layers: [{ kind: 'band', name: 'force, all directions', x: t_s, low: force_low_N, high: force_high_N, colour: axisColours(theme).force, opacity: 0.8, outlined: true }],
  };
}

/** Revolutions of the last stretch, from its end. */
function lastTurns(page: SimulatePage): { turn: number[]; min: number; max: number } {
  const end = page.last.turn.at(-1) ?? 0;
  const first = Math.floor(page.last.turn[0] ?? 0);
  return { turn: page.last.turn.map((v) => v - first), min: (page.last.turn[0] ?? 0) - first, max: end - first };
}

function lastPlots(page: SimulatePage, theme: Theme): [Plot, Plot] {
  const { turn, min, max } = lastTurns(page);
  const colours = axisColours(theme);
  const { x_um, y_um, fx_N, fy_N } = page.last;
  const both = movesInY(page);
  const x = { name: 'revolutions of the spindle', min, max };
  const [m0, m1] = roomy([...x_um, ...(both ? y_um : [])], true);
  const [f0, f1] = roomy([...fx_N, ...fy_N], true);
  const motion: Layer[] = [{ kind: 'line', name: AXES[page.operation].x, x: turn, y: x_um, colour: colours.x, width: 1.6 }];
  if (both) {
    motion.push({ kind: 'line', name: AXES[page.operation].y, x: turn, y: y_um, colour: colours.y, width: 1.6 });
  }
  return [
    { title: 'Displacement, the last revolutions', group: 'last', x, y: { name: 'displacement in µm', min: m0, max: m1 }, layers: motion },
    {
      title: 'Force, the last revolutions',
      group: 'last',
      x,
      y: { name: 'force on the tool in N', min: f0, max: f1 },
      layers: [
        { kind: 'line', name: AXES[page.operation].x, x: turn, y: fx_N, colour: colours.x, width: 1.4 },
        { kind: 'line', name: AXES[page.operation].y, x: turn, y: fy_N, colour: colours.y, width: 1.4 },
      ],
    },
  ];
}

function turnsPlot(page: SimulatePage, theme: Theme): Plot {
  const { t_s, x_um, y_um } = page.turns;
  const colours = axisColours(theme);
  const both = movesInY(page);
  const [min, max] = roomy([...x_um, ...(both ? y_um : [])]);
  const dots = (values: readonly number[]) => t_s.map((t, i) => ({ x: t, y: values[i] ?? 0 }));
  const layers: Layer[] = [{ kind: 'dots', name: AXES[page.operation].x, dots: dots(x_um), colour: colours.x, size: 4, opacity: 0.8 }];
  if (both) {
    layers.push({ kind: 'dots', name: AXES[page.operation].y, dots: dots(y_um), colour: colours.y, size: 4, opacity: 0.8 });
  }
  return { title: 'Once a revolution', x: { name: 'time in s', min: 0, max: page.envelope.t_s.at(-1) ?? 1 }, y: { name: 'displacement in µm', min, max }, layers };
}

/** Each sample over the one before; the axis that moves more. */
function returnPlot(page: SimulatePage, theme: Theme): Plot {
  const swing = (values: readonly number[]) => Math.max(...values, -Infinity) - Math.min(...values, Infinity);
  const name = swing(page.turns.y_um) > swing(page.turns.x_um) ? 'y' : 'x';
  const values = name === 'y' ? page.turns.y_um : page.turns.x_um;
  const colour = axisColours(theme)[name];
  const [min, max] = roomy(values);
  const pairs = values.slice(1).map((v, i) => ({ x: values[i] ?? 0, y: v }));
  const half = Math.floor(pairs.length / 2);
  const later = page.turns.between === 1 ? 'one revolution later' : `${page.turns.between} revolutions later`;
  return {
    title: 'Return map',
    x: { name: `${name} in µm, once a revolution`, min, max, ticks: 5 },
    y: { name: `${name} in µm, ${later}`, min, max, ticks: 6 },
    plane: true,
    layers: [
      { kind: 'line', x: [min, max], y: [min, max], colour: theme.rule, width: 1 },
      { kind: 'dots', name: 'first half of the time', dots: pairs.slice(0, half), colour: theme.rapid, size: 4 },
      { kind: 'dots', name: 'second half', dots: pairs.slice(half), colour, size: 5 },
    ],
  };
}

function rowsOf(page: SimulatePage): { label: string; value: string }[] {
  const a = page.answer;
  const um = (v: number | null) => (v === null ? [] : [`${fixed(v, 2)} µm`]);
  const optional = (label: string, value: number | null) => um(value).map((text) => ({ label, value: text }));
  return [
    { label: `growth of a small vibration per ${page.operation === 'turning' ? 'revolution' : 'tooth'}`, value: plain(a.growth_per_tooth, 5) },
    { label: 'largest displacement', value: `${fixed(a.peak_um, 2)} µm` },
    ...optional('forced amplitude', a.forced_um),
    ...optional('RMS of what does not repeat', a.chatter_rms_um),
    ...(a.chatter_frequency_hz === null ? [] : [{ label: 'chatter frequency', value: `${fixed(a.chatter_frequency_hz, 1)} Hz` }]),
    { label: 'largest force', value: `${fixed(a.force_peak_N, 1)} N` },
    { label: 'largest power', value: `${fixed(a.power_peak_W, 0)} W` },
    // A tool that is stiff across the feed leaves the wall where it is.
    ...(movesInY(page) ? [...optional('finished wall: mean place', a.wall_error_um), ...optional('finished wall: highest less lowest', a.wall_range_um)] : []),
  ];
}

function verdict(page: SimulatePage): string {
  const a = page.answer;
  const at = a.chatter_frequency_hz === null ? '' : ` at ${fixed(a.chatter_frequency_hz, 1)} Hz`;
  const sense = a.stable ? 'The cut is stable' : `The cut chatters${at}`;
  return `${sense}: each ${page.operation === 'turning' ? 'revolution' : 'tooth'} multiplies a small vibration by ${plain(a.growth_per_tooth)}. The tool moves by up to ${fixed(a.peak_um, 1)} µm, the force reaches ${fixed(a.force_peak_N, 0)} N.`;
}

export function simulateView(page: SimulatePage): View {
  const a = page.answer;
  return {
    product: 'Steadyrest chatter simulate',
    title: page.process,
    facts: `<b>${fixed(a.speed_rpm, 0)} rev/min</b> · <b>${plain(a.depth_mm)} mm</b> deep · <b>${lawText(a)}</b>`,
    verdict: verdict(page),
    body:
      section('Displacement and force', host('motion') + host('force', 'low'), 'Bands reach from the lowest to the highest value within a stretch of time.') +
      section('The last revolutions', `<div class="panels">${host('last-motion')}${host('last-force')}</div>`) +
      section('Once a revolution', `<div class="panels">${host('turns', 'high')}${host('return', 'high')}</div>`) +
      section('Figures', figures(rowsOf(page))),
    explanation: [
      ['Displacement', 'Of the tool from where it is without a force. A forced vibration repeats with every pass; what does not repeat is chatter.'],
      ['Once a revolution', 'The displacement once in every turn of the spindle, always at the same angle. A stable cut settles on one point, chatter with the period doubled on two, quasi-periodic chatter on a closed curve. The return map draws each of these values over the one before.'],
      [page.operation === 'turning' ? 'Growth per revolution' : 'Growth per tooth', 'What one pass multiplies a small vibration by, before the tool leaves the cut.'],
      ...(!movesInY(page) || a.wall_error_um === null ? [] : [['Finished wall', 'What the last teeth leave: its mean place (above 0: too much is cut off) and the height from its lowest to its highest point.'] as const]),
    ],
    draw: (theme) => {
      plot('motion', motionPlot(page, theme), theme);
      plot('force', forcePlot(page, theme), theme);
      const [motion, force] = lastPlots(page, theme);
      plot('last-motion', motion, theme);
      plot('last-force', force, theme);
      plot('turns', turnsPlot(page, theme), theme);
      plot('return', returnPlot(page, theme), theme);
    },
  };
}
