// SPDX-License-Identifier: Apache-2.0
// Stability lobes: speed × depth, shaded by the spectral radius, with the border.
import { section } from '../frame/html';
import { fixed, hertz, measure, plain, rpm } from '../frame/numbers';
import { type Cell, numeric, table, valued } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { Term, View } from '../frame/view';
import { roomy } from '../plot/axes';
import type { ColourScale } from '../plot/key';
import { type Dot, type Layer, rules } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { reading } from '../plot/reading';
import { type LobeColumns, type LobesPage, type Point, lawText } from './data';
import { type Grid, type Level, classRaster, radiusLevels, valueAt } from './raster';
import { TYPES, typeName } from './words';

export interface Marked {
  speed_rpm: number;
  depth_mm: number;
  label: string;
  stable: boolean;
}

export interface LobeView {
  lobes: LobeColumns;
  /** ρ is per tooth pass (constant speed), otherwise per period of the law. */
  perPass: boolean;
  marked?: Marked | undefined;
  /** The requested depth, drawn as a line. */
  wanted_mm?: number;
  names: { border: string; marked: string };
}

export function otherColour(index: number, theme: Theme): string {
  return [theme.run.with, theme.other[4]][index % 2] ?? theme.text;
}

export function radiusText(log_radius: number, perPass: boolean): string {
  return perPass ? `ρ ${plain(Math.exp(log_radius))}` : `ln ρ ${plain(log_radius, 3)}`;
}

function markLayer(view: LobeView, theme: Theme): Layer[] {
  const at = view.marked;
  if (!at) {
    return [];
  }
  const { speed_rpm } = view.lobes.map;
  const [x0 = 0, x1 = 1] = [speed_rpm[0], speed_rpm.at(-1)];
  const top = shownDepth(view);
  const share = (at.speed_rpm - x0) / Math.max(x1 - x0, 1e-9);
  const side = share < 0.2 ? 'right' : share > 0.8 ? 'left' : at.depth_mm > 0.85 * top ? 'bottom' : 'top';
  const dot: Dot = { x: at.speed_rpm, y: at.depth_mm, label: at.label, side };
  return [{ kind: 'dots', name: view.names.marked, dots: [dot], colour: at.stable ? theme.run.with : theme.run.without, size: 13, bold: true }];
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
    ...(dots.length === 0 ? [] : [{ kind: 'dots' as const, name: 'border at an override step', dots, colour: theme.text, size: 7, hollow: true }]),
  ];
}

/** Up to a little above the border and the requested depth: a plan is computed far deeper than anybody reads it. */
function shownDepth({ lobes, wanted_mm }: LobeView): number {
  const whole = lobes.map.depth_mm.at(-1) ?? 1;
  if (wanted_mm === undefined || lobes.border.depth_mm.some((d) => d === null)) {
    return whole;
  }
  const used = lobes.border.depth_mm.reduce<number>((most, d) => Math.max(most, d ?? 0), wanted_mm);
  return Math.min(whole, roomy([0, 1.1 * used], true)[1]);
}

export function lobePlot(view: LobeView, theme: Theme): Plot {
  const { map, border, others } = view.lobes;
  const grid: Grid = { x: map.speed_rpm, y: map.depth_mm, value: map.log_radius };
  const levels = radiusLevels(map.log_radius, view.perPass, theme.scheme);
  const ends = (values: readonly number[]): [number, number] => [values[0] ?? 0, values.at(-1) ?? 1];
  const [x, y] = [ends(map.speed_rpm), ends(map.depth_mm)];
  const area = x[1] > x[0] && y[1] > y[0];
  const layers: Layer[] = area ? [{ kind: 'raster', canvas: classRaster(grid, levels, { x: border.speed_rpm, y: border.depth_mm }), x, y }] : [];
  others.forEach((o, i) => layers.push({ kind: 'line', name: o.name, x: o.speed_rpm, y: o.depth_mm, colour: otherColour(i, theme), width: 1.8, dashed: true }));
  layers.push({ kind: 'line', name: view.names.border, x: border.speed_rpm, y: border.depth_mm, colour: theme.text, width: 2.2 });
  if (view.wanted_mm !== undefined) {
    layers.push({ ...rules('y', [view.wanted_mm], theme.text, true), name: 'requested depth' });
  }
  layers.push(...stepLayers(view.lobes, theme), ...markLayer(view, theme));
  return {
    title: 'Stability lobes',
    x: { name: 'spindle speed in rpm', min: x[0], max: area ? x[1] : x[0] + 1 },
    y: { name: 'depth of cut in mm', min: y[0], max: area ? shownDepth(view) : y[1] },
    plane: true,
    scale: radiusScale(levels, view.perPass),
    layers,
    readout: (speed, depth) => {
      const log = valueAt(grid, speed, depth);
      return reading(`${rpm(speed)}, ${measure(depth, 3, 'mm')}`, [`${radiusText(log, view.perPass)}: ${log < 0 ? 'stable' : 'unstable'}`]);
    },
  };
}

function edge(value: number, perPass: boolean): string {
  return Number.isFinite(value) ? plain(perPass ? Math.exp(value) : value, 3) : '';
}

function radiusScale(levels: readonly Level[], perPass: boolean): ColourScale {
  return {
    title: `${perPass ? 'Spectral radius ρ per tooth pass' : 'ln ρ per modulation period'}: stable left, unstable right`,
    cells: levels.map((l, i) => ({ colour: l.colour, upTo: edge(l.to, perPass), marked: l.from === 0 && i > 0 })),
  };
}

export function drawLobes(view: LobeView, theme: Theme): void {
  plot('lobes', lobePlot(view, theme), theme);
}

export function frequencyText(frequency_hz: number | null): string {
  return frequency_hz === null ? '' : `, ${hertz(frequency_hz)}`;
}

function pointLabel(point: Point, perPass: boolean): string {
  const radius = radiusText(point.log_radius, perPass);
  return point.stable || point.frequency_hz === null ? radius : `${radius}\n${hertz(point.frequency_hz)}`;
}

function stepsTable(page: LobesPage): string {
  if (page.steps.length === 0) {
    return '';
  }
  const most = page.map.depth_mm.at(-1) ?? 0;
  const wanted = page.answer.point?.depth_mm;
  const rows = page.steps.map((s): Cell[] => {
    const limit = s.limit_depth_mm === null ? valued(`over ${plain(most)}`, most) : fixed(s.limit_depth_mm, 3);
    const stable = wanted !== undefined && (s.limit_depth_mm === null || s.limit_depth_mm > wanted);
    return [`${plain(s.percent)} %`, fixed(s.speed_rpm, 0), limit, ...(wanted === undefined ? [] : [stable ? 'stable' : 'chatters'])];
  });
  const columns = [numeric('Override'), numeric('Speed, rpm'), numeric('Border, mm'), ...(wanted === undefined ? [] : [{ head: `At ${plain(wanted)} mm` }])];
  return section('Override steps', table({ id: 'steps', columns, rows, sortable: true }));
}

export const LOBE_TERMS: readonly Term[] = [
  ['Border', 'The depth at which the cut is just stable (ρ = 1), at each speed the lowest. At less depth a vibration dies; at more it grows from tooth to tooth: chatter. The border is computed exactly, and refined between the speeds of the map.'],
  ['Spectral radius ρ', 'What one tooth pass multiplies a small vibration by in the long run. Below 1 the vibration dies, above 1 it grows. Under a speed law it is for a whole period of the law, and its logarithm is shown.'],
  ['Colours', 'ρ, interpolated between the points of the map; near the border the colours follow the border.'],
  TYPES,
];

export const STEP_TERM: Term = ['Override step', 'A position of the machine’s spindle override: the speeds that can be set while the program runs.'];
const SKETCH: Term = ['Zero-order sketch', 'The border from the mean cutting forces alone (after Altintas and Budak), as most software draws it, for comparison. It has no flip lobes.'];

function verdict(page: LobesPage, perPass: boolean): string {
  const point = page.answer.point;
  const known = page.border.depth_mm.flatMap((d, i) => (d === null ? [] : [{ d, n: page.border.speed_rpm[i] ?? 0 }]));
  const low = known.reduce<{ d: number; n: number } | undefined>((a, b) => (a && a.d <= b.d ? a : b), undefined);
  const lowest = low ? `The border is lowest at ${rpm(low.n)}: ${measure(low.d, 3, 'mm')}.` : 'Every point of the map is stable.';
  if (!point) {
    return lowest;
  }
  const where = `${rpm(point.speed_rpm)} and ${plain(point.depth_mm)}\u00a0mm`;
  const step = perPass ? 'Each tooth pass' : 'Each period of the law';
  const times = `${step} multiplies a vibration by ${plain(point.spectral_radius)}`;
  return point.stable
    ? `At ${where} the cut is stable. ${times}. ${lowest}`
    : `At ${where} the cut chatters (${typeName(point.type)}${frequencyText(point.frequency_hz)}). ${times}. ${lowest}`;
}

export function lobesView(page: LobesPage): View {
  const perPass = page.answer.law === 'constant';
  const point = page.answer.point;
  const view: LobeView = {
    lobes: page,
    perPass,
    marked: point && { ...point, label: pointLabel(point, perPass) },
    names: { border: perPass ? 'border, ρ = 1' : 'border under the law, ρ = 1', marked: 'requested cut' },
  };
  return {
    product: 'Steadyrest chatter lobes',
    title: page.process,
    facts: `<b>${lawText(page.answer)}</b> · map of <b>${page.answer.speeds} × ${page.answer.depths}</b> points`,
    verdict: verdict(page, perPass),
    body: section('Stability lobes', host('lobes', 'tall')) + stepsTable(page),
    explanation: [...LOBE_TERMS, ...(page.steps.length > 0 ? [STEP_TERM] : []), ...(page.others.some((o) => o.name === SKETCH[0].toLowerCase()) ? [SKETCH] : [])],
    draw: (theme) => drawLobes(view, theme),
  };
}
