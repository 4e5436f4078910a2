// SPDX-License-Identifier: Apache-2.0
// A recorded signal: its spectrogram with the spindle or tooth orders, and where it chatters.
import { onChoice } from '../frame/dom';
import { buttons, escapeHtml, section } from '../frame/html';
import { counted, fixed, hertz, plain, rpm } from '../frame/numbers';
import { numeric, table } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { axisFor } from '../plot/axes';
import type { Dot, Layer } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { reading } from '../plot/reading';
import { spindlePlot } from '../plot/speed';
import type { ChatterEvent, DetectPage, EdgeEvent } from './data';
import { loudnessRaster, loudnessScale, quietLevel } from './raster';
import { TYPES, typeName } from './words';

export type Orders = 'teeth' | 'spindle' | 'none';

const MOST_ORDERS = 60;

function extent(page: DetectPage): { x: { name: string; min: number; max: number }; top: number; bottom: number } {
  const s = page.spectrogram;
  const bottom = -0.5 * page.bin_hz;
  return { x: { name: 'time in s', min: page.start_s, max: page.start_s + page.answer.seconds }, bottom, top: bottom + s.rows * s.row_hz };
}

const ORDER_NAMES = { teeth: 'tooth-passing frequency and its multiples', spindle: 'spindle frequency and its multiples' };

function orderLayers(page: DetectPage, orders: Orders, theme: Theme): Layer[] {
  if (orders === 'none') {
    return [];
  }
  const { t_s, speed_rpm } = page.course;
  const { x, top } = extent(page);
  const each = orders === 'teeth' ? page.teeth : 1;
  const slowest = Math.max(Math.min(...speed_rpm), 1e-9);
  const most = Math.min(Math.floor((top * 60) / (each * slowest)), MOST_ORDERS);
  const layers: Layer[] = [];
  const labels: Dot[] = [];
  const spacing = (each * slowest) / 60;
  const every = Math.max(1, Math.ceil((22 * top) / 380 / spacing)); // a label needs 22 px of about 380
  for (let k = 1; k <= most; ++k) {
    const hz = speed_rpm.map((n) => (k * each * n) / 60);
    layers.push({ kind: 'line', name: ORDER_NAMES[orders], x: t_s, y: hz.map((f) => (f <= top ? f : null)), colour: `${theme.text}99`, width: 0.7, dashed: true });
    const end = hz.at(-1) ?? 0;
    if (k % every === 0 && end < 0.98 * top) {
      labels.push({ x: x.max, y: end, label: `${k}×`, side: 'left' });
    }
  }
  layers.push({ kind: 'dots', dots: labels, colour: 'transparent', size: 1 });
  return layers;
}

function eventLayers(events: readonly ChatterEvent[], x: { min: number; max: number }, theme: Theme): Layer[] {
  const colour = theme.run.without;
  const layers: Layer[] = events.map((e) => ({ kind: 'line', name: 'chatter, from its detection on', x: [e.start_s, e.end_s], y: [e.frequency_hz, e.frequency_hz], colour, width: 2.4, halo: true }));
  const labels = events.map((e): Dot => {
    const late = (e.start_s - x.min) / (x.max - x.min) > 0.7;
    return { x: e.start_s, y: e.frequency_hz, label: `${hertz(e.frequency_hz)}, ${typeName(e.type)}`, side: late ? 'left' : 'top' };
  });
  const shown = labels.length <= 6 ? labels : labels.map(({ x: at, y }) => ({ x: at, y }));
  layers.push({ kind: 'dots', dots: shown, colour, size: 8, bold: true });
  return layers;
}

/** Each cell in a row of its own. */
function spectrogramColumns(page: DetectPage) {
  const s = page.spectrogram;
  const of = (value: (i: number) => number) => s.level_db.map((_, i) => value(i));
  return [
    { head: 'time in s', values: of((i) => s.start_s + (Math.floor(i / s.rows) + 0.5) * s.column_s) },
    { head: 'frequency in Hz', values: of((i) => (i % s.rows) * s.row_hz) },
    { head: 'power relative to the strongest cell in dB', values: s.level_db },
  ];
}

function spectrogramPlot(page: DetectPage, orders: Orders, theme: Theme): Plot {
  const s = page.spectrogram;
  const { x, bottom, top } = extent(page);
  const canvas = loudnessRaster(s.level_db, s.columns, s.rows, quietLevel(s.level_db), theme.scheme);
  return {
    title: 'Spectrogram',
    x,
    y: { name: 'frequency in Hz', min: 0, max: top },
    plane: true,
    group: 'time',
    scale: loudnessScale(quietLevel(s.level_db), theme.scheme),
    columns: () => spectrogramColumns(page),
    layers: [
      { kind: 'raster', canvas, x: [s.start_s, s.start_s + s.columns * s.column_s], y: [bottom, top] },
      ...orderLayers(page, orders, theme),
      ...eventLayers(page.answer.events, x, theme),
    ],
    readout: (t, hz) => {
      const column = Math.floor((t - s.start_s) / s.column_s);
      const row = Math.floor((hz - bottom) / s.row_hz);
      const level = column >= 0 && column < s.columns ? s.level_db[column * s.rows + row] : undefined;
      const speed = page.course.speed_rpm[Math.min(Math.floor(((t - x.min) / (x.max - x.min)) * page.course.t_s.length), page.course.t_s.length - 1)] ?? 0;
      const order = (60 * hz) / Math.max(speed, 1e-9);
      const orders = `${fixed(order, 2)} × spindle, ${fixed(order / page.teeth, 2)} × tooth`;
      return reading(`${plain(t)} s, ${fixed(hz, 0)} Hz`, [`${level === undefined ? '' : `${fixed(level, 0)} dB · `}${orders}`]);
    },
  };
}

function signalPlot(page: DetectPage, theme: Theme): Plot {
  const { t_s, low, high } = page.course;
  return {
    title: 'Signal',
    x: extent(page).x,
    y: axisFor('signal in the unit of the file', [...low, ...high], true),
    group: 'time',
    layers: [
      { kind: 'spans', name: 'tool in the cut', spans: page.answer.cuts.map((c) => [c.start_s, c.end_s]), colour: theme.text, opacity: 0.08 },
      { kind: 'spans', name: 'chatter', spans: page.answer.events.map((e) => [e.start_s, e.end_s]), colour: theme.run.without, opacity: 0.16 },
      { kind: 'band', name: 'signal, lowest to highest', x: t_s, low, high, colour: theme.run.with, opacity: 0.85, outlined: true },
    ],
  };
}

function speedPlot(page: DetectPage, theme: Theme): Plot {
  return spindlePlot({ x: extent(page).x, group: 'time', t: page.course.t_s, rpm: page.course.speed_rpm, colour: theme.text });
}

/** What the planner decided, if it advises no speed. */
const DECISIONS = { keep: 'keep this speed', constant: 'none', law: 'modulate the speed: see chatter plan', nothing: 'nothing helps at this depth' };

function advice(e: ChatterEvent): string {
  if (e.lobe_speeds_rpm?.length) {
    return `unchecked: ${e.lobe_speeds_rpm.map((n) => fixed(n, 0)).join(', ')}\u00a0rpm`;
  }
  return e.advised_speed_rpm === null ? DECISIONS[e.decision ?? 'constant'] : `${rpm(e.advised_speed_rpm)} (${plain(e.advised_override_percent)}\u00a0%)`;
}

/** Where the line is among the spindle's orders, or what else makes it chatter. */
function evidence(e: ChatterEvent): string {
  const first = e.evidence[0];
  if (e.type === 'flip' || !first) {
    return 'at half tooth orders; grew while the tooth orders held steady';
  }
  const fold = first.order_folded ? ', folded' : '';
  return `${fixed(Math.abs(first.from_order_hz), 1)} ± ${fixed(first.from_order_sd_hz, 1)}\u00a0Hz from order ${first.nearest_order}${fold}`;
}

function mode(e: ChatterEvent): string {
  return e.nearest_mode ? `${hertz(e.nearest_mode.frequency_hz)} (${e.nearest_mode.off_hz < 0 ? '−' : '+'}${fixed(Math.abs(e.nearest_mode.off_hz), 1)})` : '–';
}

function eventsTable({ events, advice_by }: DetectPage['answer']): string {
  return table({
    id: 'events',
    sortable: true,
    columns: [numeric('From, s'), numeric('To, s'), numeric('Frequency, Hz'), { head: 'Type' }, numeric('Order of the spindle'), { head: 'Evidence' }, numeric('Confidence, %'), { head: 'Nearest mode' }, numeric('Speed, rpm'), { head: `Better speed, by the ${advice_by}` }],
    rows: events.map((e) => [fixed(e.start_s, 3), fixed(e.end_s, 3), fixed(e.frequency_hz, 1), typeName(e.type), fixed(e.order, 2), evidence(e), fixed(100 * e.confidence, 0), mode(e), fixed(e.speed_rpm, 0), advice(e)]),
  });
}

function edgeWords(e: EdgeEvent, revolutions: number): string {
  const where = e.at === 'air' ? 'begins while the tool is out of the cut' : `within ${plain(revolutions)} revolutions of the tool’s ${e.at}`;
  return `${fixed(e.start_s, 3)} to ${fixed(e.end_s, 3)} s: ${hertz(e.frequency_hz)} ${where}; not counted as chatter`;
}

function verdict(page: DetectPage): string {
  const { events, seconds } = page.answer;
  const first = events[0];
  if (!first) {
    return `No chatter in ${plain(seconds)} s.`;
  }
  const more = events.length > 1 ? `The cut chatters ${events.length} times, first` : 'The cut chatters';
  const better = first.advised_speed_rpm === null && first.decision === null && !first.lobe_speeds_rpm?.length ? 'No override step is better.' : `${first.lobe_speeds_rpm?.length ? 'Lobes' : 'Better speed'}, by the ${page.answer.advice_by}: ${advice(first)}.`;
  return `${more} from ${fixed(first.start_s, 3)} to ${fixed(first.end_s, 3)} s at ${hertz(first.frequency_hz)} (${typeName(first.type)}). ${better}`;
}

export function detectView(page: DetectPage): View {
  let orders: Orders = 'teeth';
  const choices = buttons('orders', 'Orders', [['teeth', 'Tooth orders'], ['spindle', 'Spindle orders'], ['none', 'None']], orders);
  return {
    product: 'Steadyrest chatter detect',
    title: page.process,
    facts: `<b>${plain(page.answer.seconds)} s</b> at <b>${fixed(page.answer.sample_rate_hz, 0)} Hz</b> · <b>${counted(page.teeth, 'tooth', 'teeth')}</b> · ${escapeHtml(page.machine)}`,
    verdict: verdict(page),
    body:
      section('Spectrogram', host('spectrogram', 'tall') + host('signal', 'low') + host('speed', 'low'), '', choices) +
      (page.answer.events.length > 0 ? section('Where it chatters', eventsTable(page.answer)) : '') +
      (page.answer.sensor.length + page.answer.at_edges.length > 0 ? section('What this recording can and cannot show', `<ul>${[...page.answer.sensor, ...page.answer.at_edges.map((e) => edgeWords(e, page.answer.edge_revolutions))].map((words) => `<li>${escapeHtml(words)}</li>`).join('')}</ul>`) : ''),
    explanation: [
      ['Spectrogram', 'Signal power over time and frequency, in dB relative to the strongest cell. Forced vibration lies on multiples of the tooth-passing frequency; chatter lies between them.'],
      ['Orders', 'Multiples of the tooth-passing frequency (teeth × speed) or of the spindle speed itself, measured from the orders in the signal where they show it. With runout, forced vibration lies on the spindle orders.'],
      ['Evidence', 'How far the line is from the nearest spindle order it could belong to, with the standard deviation. Vibration at an order is forced by definition. Confidence: the probability that the line is not at that order, averaged over the spectra of the stretch and reduced for short stretches; for flip, its share of the energy.'],
      TYPES,
      ['Better speed', 'By the chatter frequency: the lobes’ speeds, at which a whole number of chatter waves fits between two teeth; it knows neither depth nor border, so no step is advised. By the deepest step: with a process file, the step with the deepest border. By the planner: with a process file and a depth, the answer of <code>chatter plan</code>.'],
    ],
    draw: (theme) => {
      plot('spectrogram', spectrogramPlot(page, orders, theme), theme);
      plot('signal', signalPlot(page, theme), theme);
      plot('speed', speedPlot(page, theme), theme);
    },
    bind: (redraw) =>
      onChoice('orders', (value) => {
        orders = value as Orders;
        redraw();
      }),
  };
}
