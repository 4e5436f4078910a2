// SPDX-License-Identifier: Apache-2.0
// A recorded signal: its spectrogram with the orders of spindle and teeth, and where it chatters.
import { onChoice } from '../dom';
import { fixed } from '../format';
import { buttons, escapeHtml } from '../page';
import type { Theme } from '../theme';
import type { ChatterEvent, DetectPage } from './data';
import { type View, host, keyLine, plain, plot, section } from './frame';
import { type Dot, type Layer, type Plot, roomy } from './plot';
import { loudnessRaster, loudnessStrip } from './raster';

export type Orders = 'teeth' | 'spindle' | 'none';

const QUIET_SHARE = 0.35; // of the cells are shown as paper
const LEAST_RANGE_DB = 30;
const MOST_ORDERS = 60;

/** The level below which a cell is paper, dB. */
export function quietLevel(levels_db: readonly number[]): number {
  const sorted = [...levels_db].sort((a, b) => a - b);
  return Math.min(-LEAST_RANGE_DB, sorted[Math.floor(QUIET_SHARE * sorted.length)] ?? -LEAST_RANGE_DB);
}

function extent(page: DetectPage): { x: [number, number]; top: number; bottom: number } {
  const s = page.spectrogram;
  const bottom = -0.5 * page.bin_hz;
  return { x: [page.start_s, page.start_s + page.answer.seconds], bottom, top: bottom + s.rows * s.row_hz };
}

function orderLayers(page: DetectPage, orders: Orders, theme: Theme): Layer[] {
  if (orders === 'none') {
    return [];
  }
  const { t_s, speed_rpm } = page.course;
  const { x, top } = extent(page);
  const each = orders === 'teeth' ? page.teeth : 1;
  const slowest = Math.max(Math.min(...speed_rpm), 1e-9);
  const most = Math.min(Math.floor((top * 60) / (each * slowest)), MOST_ORDERS);
  const colour = theme.scheme === 'light' ? '#1d2329' : '#e4e8ec';
  const layers: Layer[] = [];
  const labels: Dot[] = [];
  const spacing = (each * slowest) / 60;
  const every = Math.max(1, Math.ceil((22 * top) / 380 / spacing)); // a label needs 22 px of about 380
  for (let k = 1; k <= most; ++k) {
    const hz = speed_rpm.map((n) => (k * each * n) / 60);
    layers.push({ kind: 'line', x: t_s, y: hz.map((f) => (f <= top ? f : null)), colour: `${colour}99`, width: 0.7, dashed: true });
    const end = hz.at(-1) ?? 0;
    if (k % every === 0 && end < 0.98 * top) {
      labels.push({ x: x[1], y: end, label: `${k}×`, side: 'left' });
    }
  }
  layers.push({ kind: 'dots', dots: labels, colour: 'transparent', size: 1 });
  return layers;
}

function eventLayers(events: readonly ChatterEvent[], x: [number, number], theme: Theme): Layer[] {
  const colour = theme.run.without;
  const layers: Layer[] = events.map((e) => ({ kind: 'line', x: [e.start_s, e.end_s], y: [e.frequency_hz, e.frequency_hz], colour, width: 2.4, halo: true }));
  const labels = events.map((e): Dot => {
    const late = (e.start_s - x[0]) / (x[1] - x[0]) > 0.7;
    return { x: e.start_s, y: e.frequency_hz, label: `${fixed(e.frequency_hz, 1)} Hz, ${e.type}`, side: late ? 'left' : 'top' };
  });
  const shown = labels.length <= 6 ? labels : labels.map(({ x: at, y }) => ({ x: at, y }));
  layers.push({ kind: 'dots', dots: shown, colour, size: 8, bold: true });
  return layers;
}

function spectrogramPlot(page: DetectPage, orders: Orders, theme: Theme): Plot {
  const s = page.spectrogram;
  const { x, bottom, top } = extent(page);
  const canvas = loudnessRaster(s.level_db, s.columns, s.rows, quietLevel(s.level_db), theme.scheme);
  return {
    title: 'Spectrogram',
    x: { name: 'time in s', min: x[0], max: x[1] },
    y: { name: 'frequency in Hz', min: 0, max: top },
    layers: [
      { kind: 'raster', canvas, x: [s.start_s, s.start_s + s.columns * s.column_s], y: [bottom, top] },
      ...orderLayers(page, orders, theme),
      ...eventLayers(page.answer.events, x, theme),
    ],
    readout: (t, hz) => {
      const column = Math.floor((t - s.start_s) / s.column_s);
      const row = Math.floor((hz - bottom) / s.row_hz);
      const level = column >= 0 && column < s.columns ? s.level_db[column * s.rows + row] : undefined;
      const speed = page.course.speed_rpm[Math.min(Math.floor(((t - x[0]) / (x[1] - x[0])) * page.course.t_s.length), page.course.t_s.length - 1)] ?? 0;
      const order = (60 * hz) / Math.max(speed, 1e-9);
      return `<b>${plain(t)} s, ${fixed(hz, 0)} Hz</b><br>${level === undefined ? '' : `${fixed(level, 0)} dB · `}${fixed(order, 2)} × spindle, ${fixed(order / page.teeth, 2)} × tooth`;
    },
  };
}

function signalPlot(page: DetectPage, theme: Theme): Plot {
  const { t_s, low, high } = page.course;
  const [min, max] = roomy([...low, ...high], true);
  const { x } = extent(page);
  return {
    title: 'Signal',
    x: { name: 'time in s', min: x[0], max: x[1] },
    y: { name: 'signal, unit of the file', min, max },
    layers: [
      { kind: 'spans', spans: page.answer.events.map((e) => [e.start_s, e.end_s]), colour: theme.run.without, opacity: 0.16 },
      { kind: 'band', x: t_s, low, high, colour: theme.run.with, opacity: 0.85 },
    ],
  };
}

function speedPlot(page: DetectPage, theme: Theme): Plot {
  const { t_s, speed_rpm } = page.course;
  const [min, max] = roomy(speed_rpm);
  const { x } = extent(page);
  return {
    title: 'Spindle speed',
    x: { name: 'time in s', min: x[0], max: x[1] },
    y: { name: 'spindle speed in rev/min', min, max },
    layers: [{ kind: 'line', x: t_s, y: speed_rpm, colour: theme.text, width: 1.6 }],
  };
}

function advice(e: ChatterEvent): string {
  return e.advised_speed_rpm === null ? 'none' : `${fixed(e.advised_speed_rpm, 0)} rev/min (${plain(e.advised_override_percent)} %)`;
}

function eventsTable(events: readonly ChatterEvent[]): string {
  const row = (e: ChatterEvent) =>
    `<tr><td class="n">${fixed(e.start_s, 3)}</td><td class="n">${fixed(e.end_s, 3)}</td><td class="n">${fixed(e.frequency_hz, 1)}</td><td>${e.type}</td>
    <td class="n">${fixed(e.speed_rpm, 0)}</td><td>${advice(e)}</td></tr>`;
  return `<div class="wide"><table id="events"><thead><tr><th class="n">from, s</th><th class="n">to, s</th><th class="n">Hz</th><th>type</th>
    <th class="n">at rev/min</th><th>better speed</th></tr></thead><tbody>${events.map(row).join('')}</tbody></table></div>`;
}

function verdict(page: DetectPage): string {
  const { events, seconds } = page.answer;
  const first = events[0];
  if (!first) {
    return `No chatter in ${plain(seconds)} s.`;
  }
  const more = events.length > 1 ? `${events.length} stretches of chatter; the first` : 'Chatter';
  const better = first.advised_speed_rpm === null ? 'No override step is better.' : `Better: ${advice(first)}.`;
  return `${more} from ${fixed(first.start_s, 3)} to ${fixed(first.end_s, 3)} s at ${fixed(first.frequency_hz, 1)} Hz (${first.type}). ${better}`;
}

export function detectView(page: DetectPage): View {
  let orders: Orders = 'teeth';
  const choices: [string, string][] = [['teeth', 'Orders of the teeth'], ['spindle', 'of the spindle'], ['none', 'none']];
  const head = `<div class="bar-head"><h2>Spectrogram</h2><div class="controls">${buttons('orders', 'Orders', choices, orders)}</div></div>`;
  const events = page.answer.events.length > 0 ? section('Stretches of chatter', eventsTable(page.answer.events)) : '';
  const loudness = `<div class="radius-legend"><span class="scale-title">Power under the strongest cell, dB</span><span class="strip"><i id="strip"></i><b id="strip-ends"></b></span></div>`;
  return {
    product: 'Steadyrest chatter detect',
    title: page.process,
    facts: `<b>${plain(page.answer.seconds)} s</b> at <b>${fixed(page.answer.sample_rate_hz, 0)} Hz</b> · <b>${page.teeth}</b> ${page.teeth === 1 ? 'tooth' : 'teeth'} · ${escapeHtml(page.machine)}`,
    verdict: verdict(page),
    body: `<section>${head}<div class="key-line" id="key-detect"></div>${host('spectrogram', 'tall')}${loudness}${host('signal', 'low')}${host('speed', 'low')}</section>${events}`,
    draw: (theme) => {
      plot('spectrogram', spectrogramPlot(page, orders, theme), theme);
      plot('signal', signalPlot(page, theme), theme);
      plot('speed', speedPlot(page, theme), theme);
      const put = (id: string, change: (where: HTMLElement) => void) => {
        const where = document.getElementById(id);
        if (where) change(where);
      };
      put('strip', (e) => (e.style.background = loudnessStrip(theme.scheme)));
      put('strip-ends', (e) => (e.innerHTML = `<span>${fixed(quietLevel(page.spectrogram.level_db), 0)}</span><span>0</span>`));
      put('key-detect', (e) => {
        e.innerHTML = keyLine([
          { name: 'chatter: from when it was told, at the frequency that was named', colour: theme.run.without },
          ...(orders === 'none' ? [] : [{ name: orders === 'teeth' ? 'tooth passing frequency and its multiples' : 'spindle frequency and its multiples', colour: theme.faint, kind: 'dashed' as const }]),
        ]);
      });
    },
    bind: (redraw) =>
      onChoice('orders', (value) => {
        orders = value as Orders;
        redraw();
      }),
  };
}
