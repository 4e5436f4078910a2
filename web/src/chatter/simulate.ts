// SPDX-License-Identifier: Apache-2.0
// A cut over time: displacement, force, and where the tool is once a revolution.
import { section } from '../frame/html';
import { hertz, measure, plain, rpm, um } from '../frame/numbers';
import { type Figure, figures } from '../frame/table';
import { type Theme, curveColour } from '../frame/theme';
import type { Term, View } from '../frame/view';
import { axisFor } from '../plot/axes';
import type { Layer } from '../plot/layers';
import { type Plot, host, panels, plot } from '../plot/plot';
import { type SimulatePage, lawText } from './data';

/** What x and y mean. */
const AXES = {
  milling: { x: 'x, along the feed', y: 'y, across the feed' },
  turning: { x: 'x, into the work', y: 'y, along the cutting speed' },
};
/** So that each of two bands shows through the other. */
const BAND = 0.55;
/** Of the palette. */
const GREY = 7;

const DISPLACEMENT = 'displacement in µm';
const FORCE = 'force on the tool in N';
const timeAxis = (page: SimulatePage) => ({ name: 'time in s', min: 0, max: page.envelope.t_s.at(-1) ?? 1 });

function axisColours(theme: Theme): { x: string; y: string; force: string } {
  return { x: theme.run.with, y: theme.run.without, force: curveColour(theme, GREY) };
}

/** Does the tool move along y at all? */
function movesInY(page: SimulatePage): boolean {
  return [...page.envelope.y_low_um, ...page.envelope.y_high_um].some((v) => v !== 0);
}

function motionPlot(page: SimulatePage, theme: Theme): Plot {
  const { t_s, x_low_um, x_high_um, y_low_um, y_high_um } = page.envelope;
  const colours = axisColours(theme);
  const both = movesInY(page);
  const layers: Layer[] = [{ kind: 'band', name: AXES[page.operation].x, x: t_s, low: x_low_um, high: x_high_um, colour: colours.x, opacity: both ? BAND : 0.85, outlined: true }];
  if (both) {
    layers.push({ kind: 'band', name: AXES[page.operation].y, x: t_s, low: y_low_um, high: y_high_um, colour: colours.y, opacity: BAND, outlined: true });
  }
  const shown = [...x_low_um, ...x_high_um, ...(both ? [...y_low_um, ...y_high_um] : [])];
  return { title: 'Displacement', x: timeAxis(page), y: axisFor(DISPLACEMENT, shown, true), group: 'time', layers };
}

function forcePlot(page: SimulatePage, theme: Theme): Plot {
  const { t_s, force_low_N, force_high_N } = page.envelope;
  return {
    title: 'Force',
    x: timeAxis(page),
    y: axisFor(FORCE, force_high_N, true),
    group: 'time',
    layers: [{ kind: 'band', name: 'force, all directions', x: t_s, low: force_low_N, high: force_high_N, colour: axisColours(theme).force, opacity: 0.8, outlined: true }],
  };
}

/** The last stretch in revolutions, counted from its start. */
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
  const x = { name: 'spindle revolutions', min, max };
  const motion: Layer[] = [{ kind: 'line', name: AXES[page.operation].x, x: turn, y: x_um, colour: colours.x, width: 1.6 }];
  if (both) {
    motion.push({ kind: 'line', name: AXES[page.operation].y, x: turn, y: y_um, colour: colours.y, width: 1.6 });
  }
  return [
    { title: 'Displacement over the last revolutions', group: 'last', x, y: axisFor(DISPLACEMENT, [...x_um, ...(both ? y_um : [])], true), layers: motion },
    {
      title: 'Force over the last revolutions',
      group: 'last',
      x,
      y: axisFor(FORCE, [...fx_N, ...fy_N], true),
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
  const dots = (values: readonly number[]) => t_s.map((t, i) => ({ x: t, y: values[i] ?? 0 }));
  const layers: Layer[] = [{ kind: 'dots', name: AXES[page.operation].x, dots: dots(x_um), colour: colours.x, size: 4, opacity: 0.8 }];
  if (both) {
    layers.push({ kind: 'dots', name: AXES[page.operation].y, dots: dots(y_um), colour: colours.y, size: 4, opacity: 0.8 });
  }
  return { title: 'Once a revolution', x: timeAxis(page), y: axisFor(DISPLACEMENT, [...x_um, ...(both ? y_um : [])]), layers };
}

/** Each sample against the one before, on the axis that moves more. */
function returnPlot(page: SimulatePage, theme: Theme): Plot {
  const swing = (values: readonly number[]) => Math.max(...values, -Infinity) - Math.min(...values, Infinity);
  const name = swing(page.turns.y_um) > swing(page.turns.x_um) ? 'y' : 'x';
  const values = name === 'y' ? page.turns.y_um : page.turns.x_um;
  const colour = axisColours(theme)[name];
  const pairs = values.slice(1).map((v, i) => ({ x: values[i] ?? 0, y: v }));
  const half = Math.floor(pairs.length / 2);
  const later = page.turns.between === 1 ? 'one revolution later' : `${page.turns.between} revolutions later`;
  const square = axisFor(`displacement ${name} in µm, ${later}`, values);
  const diagonal = [square.min, square.max];
  return {
    title: 'Return map',
    x: { ...axisFor(`displacement ${name} in µm, once a revolution`, values), ticks: 5 },
    y: { ...square, ticks: 6 },
    plane: true,
    layers: [
      { kind: 'line', x: diagonal, y: diagonal, colour: theme.rule, width: 1 },
      { kind: 'dots', name: 'first half', dots: pairs.slice(0, half), colour: theme.rapid, size: 4 },
      { kind: 'dots', name: 'second half', dots: pairs.slice(half), colour, size: 5 },
    ],
  };
}

/** What a growth factor counts by. */
const passOf = (page: SimulatePage) => (page.operation === 'turning' ? 'revolution' : 'tooth');

function rowsOf(page: SimulatePage): Figure[] {
  const a = page.answer;
  const optional = (label: string, value: number | null) => (value === null ? [] : [{ label, value: um(value, 2) }]);
  return [
    { label: `Growth of a small vibration per ${passOf(page)}`, value: plain(a.growth_per_tooth, 5) },
    { label: 'Peak displacement', value: um(a.peak_um, 2) },
    ...optional('Forced amplitude', a.forced_um),
    ...optional('Chatter (vibration that does not repeat), RMS', a.chatter_rms_um),
    ...(a.chatter_frequency_hz === null ? [] : [{ label: 'Chatter frequency', value: hertz(a.chatter_frequency_hz) }]),
    { label: 'Peak force', value: measure(a.force_peak_N, 1, 'N') },
    { label: 'Peak power', value: measure(a.power_peak_W, 0, 'W') },
    // A tool that is rigid across the feed does not move the wall.
    ...(movesInY(page) ? [...optional('Finished wall, mean offset', a.wall_error_um), ...optional('Finished wall, peak to valley', a.wall_range_um)] : []),
  ];
}

function verdict(page: SimulatePage): string {
  const a = page.answer;
  const at = a.chatter_frequency_hz === null ? '' : ` at ${hertz(a.chatter_frequency_hz)}`;
  const sense = a.stable ? 'The cut is stable' : `The cut chatters${at}`;
  return `${sense}: each ${passOf(page)} multiplies a small vibration by ${plain(a.growth_per_tooth)}. The tool moves by up to ${um(a.peak_um)}; the force peaks at ${measure(a.force_peak_N, 0, 'N')}.`;
}

const WALL: Term = ['Finished wall', 'What the last teeth leave: its mean offset (above 0, the tool cuts too deep) and its height from the lowest to the highest point.'];

export function simulateView(page: SimulatePage): View {
  const a = page.answer;
  return {
    product: 'Steadyrest chatter simulate',
    title: page.process,
    facts: `<b>${rpm(a.speed_rpm)}</b> · <b>${plain(a.depth_mm)} mm</b> deep · <b>${lawText(a)}</b>`,
    verdict: verdict(page),
    body:
      section('Displacement and force', host('motion') + host('force', 'low'), 'Each band reaches from the lowest to the highest value in its stretch of time.') +
      section('The last revolutions', panels(['last-motion', 'last-force'])) +
      section('Once a revolution', panels(['turns', 'return'], 'high')) +
      section('Figures', figures(rowsOf(page))),
    explanation: [
      ['Displacement', 'How far the tool is from its position without force. Forced vibration repeats with every pass; what does not repeat is chatter.'],
      ['Once a revolution', 'The displacement sampled once per spindle revolution, always at the same angle. A stable cut settles on one point, period-doubling (flip) chatter on two, quasi-periodic (Hopf) chatter on a closed curve. The return map plots each sample against the one before.'],
      [`Growth per ${passOf(page)}`, 'What one pass multiplies a small vibration by, before the tool leaves the cut.'],
      ...(!movesInY(page) || a.wall_error_um === null ? [] : [WALL]),
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
