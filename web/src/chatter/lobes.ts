// SPDX-License-Identifier: Apache-2.0
// The stability lobes: speed × depth, shaded by the spectral radius, with the border.
import { fixed } from '../format';
import type { Theme } from '../theme';
import { type LobeColumns, type LobesPage, type Point, lawText } from './data';
import { type Key, type View, host, keyLine, plain, plot, section } from './frame';
import { type Dot, type Layer, type Plot } from './plot';
import { type Grid, type Level, classRaster, radiusLevels, valueAt } from './raster';

export interface Marked {
  speed_rpm: number;
  depth_mm: number;
  label: string;
  stable: boolean;
}

export interface LobeView {
  lobes: LobeColumns;
  /** ρ is that of one tooth pass (constant speed), else of a period of the law. */
  perPass: boolean;
  marked?: Marked | undefined;
  /** A line at the depth that is wanted. */
  wanted_mm?: number;
}

export function otherColour(index: number, theme: Theme): string {
  return [theme.run.with, theme.rapid === '#c3c9cf' ? '#8a5fb0' : '#b797dc'][index % 2] ?? theme.text;
}

export function radiusText(log_radius: number, perPass: boolean): string {
  return perPass ? `ρ ${plain(Math.exp(log_radius))}` : `ln ρ ${plain(log_radius, 3)}`;
}

function markLayer(view: LobeView, theme: Theme): Layer[] {
  const at = view.marked;
  if (!at) {
    return [];
  }
  const { speed_rpm, depth_mm } = view.lobes.map;
  const [x0 = 0, x1 = 1] = [speed_rpm[0], speed_rpm.at(-1)];
  const top = depth_mm.at(-1) ?? 1;
  const share = (at.speed_rpm - x0) / Math.max(x1 - x0, 1e-9);
  const side = share < 0.2 ? 'right' : share > 0.8 ? 'left' : at.depth_mm > 0.85 * top ? 'bottom' : 'top';
  const dot: Dot = { x: at.speed_rpm, y: at.depth_mm, label: at.label, side };
  return [{ kind: 'dots', dots: [dot], colour: at.stable ? theme.run.with : theme.run.without, size: 13, bold: true }];
}

function stepLayers(lobes: LobeColumns, theme: Theme): Layer[] {
  if (lobes.steps.length === 0) {
    return [];
  }
  const ticks = lobes.steps.map((s) => ({ x: s.speed_rpm, label: `${plain(s.percent, 3)} %`, strong: Math.abs(s.percent - 100) < 1e-6 }));
  const shown = lobes.steps.filter((s) => s.speed_rpm >= (lobes.map.speed_rpm[0] ?? 0) && s.speed_rpm <= (lobes.map.speed_rpm.at(-1) ?? 0));
  const dots = shown.flatMap((s) => (s.limit_depth_mm === null ? [] : [{ x: s.speed_rpm, y: s.limit_depth_mm }]));
  return [
    { kind: 'ticks', ticks, colour: theme.faint },
    { kind: 'dots', dots, colour: theme.text, size: 7, hollow: true },
  ];
}

export function lobePlot(view: LobeView, theme: Theme): Plot {
  const { map, border, others } = view.lobes;
  const grid: Grid = { x: map.speed_rpm, y: map.depth_mm, value: map.log_radius };
  const ends = (values: readonly number[]): [number, number] => [values[0] ?? 0, values.at(-1) ?? 1];
  const [x, y] = [ends(map.speed_rpm), ends(map.depth_mm)];
  const area = x[1] > x[0] && y[1] > y[0];
  const layers: Layer[] = area ? [{ kind: 'raster', canvas: classRaster(grid, radiusLevels(map.log_radius, view.perPass, theme.scheme)), x, y }] : [];
  others.forEach((o, i) => layers.push({ kind: 'line', x: o.speed_rpm, y: o.depth_mm, colour: otherColour(i, theme), width: 1.8, dashed: true }));
  layers.push({ kind: 'line', x: border.speed_rpm, y: border.depth_mm, colour: theme.text, width: 2.2 });
  if (view.wanted_mm !== undefined) {
    layers.push({ kind: 'rules', at: [view.wanted_mm], axis: 'y', colour: theme.text, dashed: true });
  }
  layers.push(...stepLayers(view.lobes, theme), ...markLayer(view, theme));
  return {
    title: 'Stability lobes',
    x: { name: 'spindle speed in rev/min', min: x[0], max: area ? x[1] : x[0] + 1 },
    y: { name: 'depth of cut in mm', min: y[0], max: y[1] },
    layers,
    readout: (speed, depth) => {
      const log = valueAt(grid, speed, depth);
      return `<b>${fixed(speed, 0)} rev/min, ${fixed(depth, 3)} mm</b><br>${radiusText(log, view.perPass)}: ${log < 0 ? 'stable' : 'unstable'}`;
    },
  };
}

function edge(value: number, perPass: boolean): string {
  return Number.isFinite(value) ? plain(perPass ? Math.exp(value) : value, 3) : '';
}

/** Cells of the colours, the number under the edge between two. */
export function radiusLegend(view: LobeView, theme: Theme): string {
  const levels = radiusLevels(view.lobes.map.log_radius, view.perPass, theme.scheme);
  const cell = (l: Level) => `<span><i style="background:${l.colour}"></i><em>${edge(l.to, view.perPass)}</em></span>`;
  const what = view.perPass ? 'Spectral radius ρ of a tooth pass' : 'ln ρ of a modulation period';
  return `<span class="scale-title">${what}: left stable, right unstable</span><span class="scale">${levels.map(cell).join('')}</span>`;
}

export function lobeKeys(view: LobeView, theme: Theme, names: { border: string; marked: string }): Key[] {
  const keys: Key[] = [{ name: names.border, colour: theme.text }];
  view.lobes.others.forEach((o, i) => keys.push({ name: o.name, colour: otherColour(i, theme), kind: 'dashed' }));
  if (view.lobes.steps.some((s) => s.limit_depth_mm !== null)) {
    keys.push({ name: 'border at an override step', colour: theme.text, kind: 'hoop' });
  }
  if (view.marked) {
    keys.push({ name: names.marked, colour: view.marked.stable ? theme.run.with : theme.run.without, kind: 'dot' });
  }
  return keys;
}

export function lobeHosts(): string {
  return `<div class="key-line" id="key-lobes"></div>${host('lobes', 'tall')}<div class="radius-legend" id="legend"></div>`;
}

export function drawLobes(view: LobeView, theme: Theme, names: { border: string; marked: string }): void {
  plot('lobes', lobePlot(view, theme), theme);
  const put = (id: string, html: string) => {
    const where = document.getElementById(id);
    if (where) where.innerHTML = html;
  };
  put('key-lobes', keyLine(lobeKeys(view, theme, names)));
  put('legend', radiusLegend(view, theme));
}

export function frequencyText(frequency_hz: number | null): string {
  return frequency_hz === null ? '' : `, ${fixed(frequency_hz, 1)} Hz`;
}

function pointLabel(point: Point, perPass: boolean): string {
  const radius = radiusText(point.log_radius, perPass);
  return point.stable || point.frequency_hz === null ? radius : `${radius}\n${fixed(point.frequency_hz, 1)} Hz`;
}

function stepsTable(page: LobesPage): string {
  if (page.steps.length === 0) {
    return '';
  }
  const most = page.map.depth_mm.at(-1) ?? 0;
  const depth = page.answer.point?.depth_mm ?? 0;
  const rows = page.steps
    .map((s) => {
      const carries = s.limit_depth_mm === null || s.limit_depth_mm > depth;
      const limit = s.limit_depth_mm === null ? `over ${plain(most)}` : fixed(s.limit_depth_mm, 3);
      return `<tr><td class="n">${plain(s.percent)} %</td><td class="n">${fixed(s.speed_rpm, 0)}</td><td class="n">${limit}</td><td>${carries ? 'carries it' : 'too deep'}</td></tr>`;
    })
    .join('');
  const head = `<th class="n">override</th><th class="n">rev/min</th><th class="n">border, mm</th><th>${plain(depth)} mm</th>`;
  return section('Override steps of the machine', `<div class="wide"><table id="steps"><thead><tr>${head}</tr></thead><tbody>${rows}</tbody></table></div>`);
}

function verdict(page: LobesPage, perPass: boolean): string {
  const point = page.answer.point;
  const known = page.border.depth_mm.flatMap((d, i) => (d === null ? [] : [{ d, n: page.border.speed_rpm[i] ?? 0 }]));
  const low = known.reduce<{ d: number; n: number } | undefined>((a, b) => (a && a.d <= b.d ? a : b), undefined);
  const lowest = low ? `The lowest border is ${fixed(low.d, 3)} mm at ${fixed(low.n, 0)} rev/min.` : 'All points of the map are stable.';
  if (!point) {
    return lowest;
  }
  const where = `${fixed(point.speed_rpm, 0)} rev/min and ${plain(point.depth_mm)} mm`;
  const step = perPass ? 'Every tooth pass' : 'Every period of the law';
  const times = `${step} multiplies a vibration by ${plain(point.spectral_radius)}`;
  return point.stable
    ? `At ${where} the cut is stable. ${times}. ${lowest}`
    : `At ${where} the cut chatters (${point.type}${frequencyText(point.frequency_hz)}). ${times}. ${lowest}`;
}

export function lobesView(page: LobesPage): View {
  const perPass = page.answer.law === 'constant';
  const point = page.answer.point;
  const view: LobeView = {
    lobes: page,
    perPass,
    marked: point && { ...point, label: pointLabel(point, perPass) },
  };
  return {
    product: 'Steadyrest chatter lobes',
    title: page.process,
    facts: `<b>${lawText(page.answer)}</b> · map of <b>${page.answer.speeds} × ${page.answer.depths}</b> points`,
    verdict: verdict(page, perPass),
    body: section('Stability lobes', lobeHosts()) + stepsTable(page),
    draw: (theme) => drawLobes(view, theme, { border: perPass ? 'border, ρ = 1' : 'border under the law, ρ = 1', marked: 'the wanted cut' }),
  };
}
