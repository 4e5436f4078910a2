// SPDX-License-Identifier: Apache-2.0
// One picture out of layers: lines, bands, dots, rasters, rules.
import { ScatterChart } from 'echarts/charts';
import { bandSeries } from '../charts/band';
import { FONT, echarts } from '../charts/echarts';
import { fixed } from '../format';
import type { Theme } from '../theme';
import type { Maybe } from './data';

echarts.use([ScatterChart]);

export interface Axis {
  name: string;
  min?: number;
  max?: number;
  /** Wanted count of ticks. */
  ticks?: number;
}

export interface Dot {
  x: number;
  y: number;
  label?: string;
  /** Where the label stands. */
  side?: 'left' | 'right' | 'top' | 'bottom';
  /** Upwards from there, px. */
  lift?: number;
}

export type Layer =
  | { kind: 'line'; x: readonly Maybe[]; y: readonly Maybe[]; colour: string; width?: number; dashed?: boolean; halo?: boolean }
  | { kind: 'band'; x: readonly Maybe[]; low: readonly Maybe[]; high: readonly Maybe[]; colour: string; opacity: number }
  | { kind: 'dots'; dots: readonly Dot[]; colour: string; size: number; hollow?: boolean; opacity?: number; bold?: boolean }
  | { kind: 'raster'; canvas: HTMLCanvasElement; x: [number, number]; y: [number, number] }
  | { kind: 'spans'; spans: readonly [number, number][]; colour: string; opacity: number }
  | { kind: 'rules'; at: readonly number[]; axis: 'x' | 'y'; colour: string; dashed?: boolean }
  /** Ticks above the picture, at values of x. */
  | { kind: 'ticks'; ticks: readonly { x: number; label: string; strong: boolean }[]; colour: string };

export interface Plot {
  title: string;
  x: Axis;
  y: Axis;
  layers: Layer[];
  /** What stands under the pointer. */
  readout?: (x: number, y: number) => string | undefined;
}

const MARGIN = { left: 62, right: 18, top: 34, bottom: 42 };
const TICKS_PX = 24;
const LABEL_PX = 44;

/** 1, 2 or 5 times a power of ten, about `count` of them in the range. */
export function niceStep(range: number, count: number): number {
  const rough = range / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  return ([1, 2, 5, 10].find((m) => m * power >= rough * (1 - 1e-9)) ?? 10) * power;
}

export function span(values: readonly Maybe[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const v of values) {
    if (v !== null) {
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

/** Widened to whole steps, so that no curve touches the frame. */
export function roomy(values: readonly Maybe[], withZero = false): [number, number] {
  let [low, high] = span(values);
  if (withZero) {
    [low, high] = [Math.min(low, 0), Math.max(high, 0)];
  }
  const reach = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? high - low : Math.max(Math.abs(high), 1) * 0.2;
  const step = niceStep(reach * 1.1, 8);
  const middle = 0.5 * (low + high);
  const [from, to] = [Math.min(low, middle - 0.5 * reach), Math.max(high, middle + 0.5 * reach)];
  const under = low === 0 && withZero ? 0 : Math.floor((from - 0.04 * reach) / step) * step;
  return [under, Math.ceil((to + 0.04 * reach) / step) * step];
}

function axisOption(axis: Axis, theme: Theme, count: number) {
  const range = axis.min !== undefined && axis.max !== undefined ? axis.max - axis.min : undefined;
  const interval = range === undefined ? undefined : niceStep(range, axis.ticks ?? count);
  const isTick = (v: number | undefined) => interval === undefined || v === undefined || Math.abs(v / interval - Math.round(v / interval)) < 1e-6;
  const decimals = interval === undefined ? 0 : Math.max(0, -Math.floor(Math.log10(interval) + 1e-9));
  return {
    type: 'value',
    ...(axis.min === undefined ? { scale: true } : { min: axis.min }),
    ...(axis.max === undefined ? {} : { max: axis.max }),
    // Not `interval`, which would count from `min`: so the ticks are multiples.
    ...(interval === undefined || range === undefined ? {} : { splitNumber: range / interval }),
    axisLine: { show: true, onZero: false, lineStyle: { color: theme.faint } },
    axisTick: { show: true, lineStyle: { color: theme.faint } },
    splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
    axisLabel: {
      color: theme.faint,
      fontSize: 11,
      hideOverlap: true,
      showMinLabel: isTick(axis.min),
      showMaxLabel: isTick(axis.max),
      formatter: (v: number) => fixed(v, decimals),
    },
  };
}

type Api = { coord: (p: number[]) => number[] };
interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}
type Params = { coordSys: Box };

/** A series that draws one thing, in pixels. */
function custom(z: number, item: (params: Params, api: Api) => object) {
  return { type: 'custom', silent: true, clip: true, z, data: [[0, 0]], renderItem: item };
}

function lineSeries(layer: Extract<Layer, { kind: 'line' }>, theme: Theme, z: number) {
  const base = {
    type: 'line',
    showSymbol: false,
    silent: true,
    connectNulls: false,
    data: layer.x.map((v, i) => [v, layer.y[i] ?? null]),
  };
  const width = layer.width ?? 1.4;
  const line = { ...base, z, color: layer.colour, lineStyle: { width, type: layer.dashed ? [6, 4] : 'solid', cap: 'butt' } };
  return layer.halo ? [{ ...base, z: z - 0.5, color: theme.paper, lineStyle: { width: width + 2.4, opacity: 0.85 } }, line] : [line];
}

function dotSeries(layer: Extract<Layer, { kind: 'dots' }>, theme: Theme, z: number) {
  return {
    type: 'scatter',
    silent: true,
    z,
    symbolSize: layer.size,
    clip: false,
    itemStyle: {
      color: layer.hollow ? theme.paper : layer.colour,
      opacity: layer.opacity ?? 1,
      borderColor: layer.hollow ? layer.colour : theme.paper,
      borderWidth: layer.hollow ? 2 : layer.size > 5 ? 1 : 0,
    },
    data: layer.dots.map((d) => ({
      value: [d.x, d.y],
      label: {
        show: d.label !== undefined,
        formatter: d.label ?? '',
        position: d.side ?? 'right',
        offset: [0, -(d.lift ?? 0)],
        color: theme.text,
        fontSize: 12,
        fontWeight: layer.bold ? 600 : 400,
        backgroundColor: `${theme.paper}d8`,
        padding: [2, 4],
        lineHeight: 16,
        ...(d.side === 'top' || d.side === 'bottom' ? { align: 'center' } : {}),
      },
    })),
  };
}

function ticksSeries(layer: Extract<Layer, { kind: 'ticks' }>, theme: Theme, z: number) {
  return {
    ...custom(z, ({ coordSys }, api) => {
      let last = -Infinity;
      const places = layer.ticks.map((t) => ({ ...t, px: api.coord([t.x, 0])[0] ?? 0 }));
      const strong = places.find((p) => p.strong)?.px ?? -Infinity;
      const children = places
        .filter((p) => p.px >= coordSys.x - 1 && p.px <= coordSys.x + coordSys.width + 1)
        .flatMap((p) => {
          const top = coordSys.y;
          const tick = {
            type: 'line',
            shape: { x1: p.px, y1: top - 6, x2: p.px, y2: top + (p.strong ? coordSys.height : 5) },
            style: { stroke: layer.colour, lineWidth: p.strong ? 1.2 : 1, lineDash: p.strong ? [2, 3] : null },
          };
          const room = p.strong || (p.px - last >= LABEL_PX && Math.abs(p.px - strong) >= LABEL_PX);
          if (!room) {
            return [tick];
          }
          last = p.px;
          const style = { text: p.label, x: p.px, y: top - 9, fill: theme.text, font: `${p.strong ? '600 ' : ''}11px ${FONT}`, align: 'center', verticalAlign: 'bottom' };
          return [tick, { type: 'text', style }];
        });
      return { type: 'group', children };
    }),
    clip: false,
  };
}

function series(layer: Layer, theme: Theme, z: number): object[] {
  switch (layer.kind) {
    case 'line':
      return lineSeries(layer, theme, z);
    case 'band':
      return [{ ...bandSeries(layer, layer.opacity), z }];
    case 'dots':
      return [dotSeries(layer, theme, z)];
    case 'ticks':
      return [ticksSeries(layer, theme, z)];
    case 'raster':
      return [
        custom(z, (_, api) => {
          const [left = 0, top = 0] = api.coord([layer.x[0], layer.y[1]]);
          const [right = 0, bottom = 0] = api.coord([layer.x[1], layer.y[0]]);
          return { type: 'image', style: { image: layer.canvas, x: left, y: top, width: right - left, height: bottom - top } };
        }),
      ];
    case 'spans':
      return [
        custom(z, ({ coordSys }, api) => ({
          type: 'group',
          children: layer.spans.map(([from, to]) => {
            const x = api.coord([from, 0])[0] ?? 0;
            const width = Math.max((api.coord([to, 0])[0] ?? 0) - x, 1);
            return { type: 'rect', shape: { x, y: coordSys.y, width, height: coordSys.height }, style: { fill: layer.colour, opacity: layer.opacity } };
          }),
        })),
      ];
    case 'rules':
      return [
        custom(z, ({ coordSys: box }, api) => ({
          type: 'group',
          children: layer.at.map((value) => {
            const across = layer.axis === 'x';
            const at = api.coord(across ? [value, 0] : [0, value])[across ? 0 : 1] ?? 0;
            const shape = across ? { x1: at, x2: at, y1: box.y, y2: box.y + box.height } : { x1: box.x, x2: box.x + box.width, y1: at, y2: at };
            return { type: 'line', shape, style: { stroke: layer.colour, lineWidth: 1, lineDash: layer.dashed ? [5, 4] : null } };
          }),
        })),
      ];
  }
}

const readouts = new WeakMap<HTMLElement, (x: number, y: number) => string | undefined>();

/** A box beside the pointer; made once for each host. */
function follow(host: HTMLElement, chart: echarts.ECharts): void {
  const tip = host.appendChild(document.createElement('div'));
  tip.className = 'tip';
  const hide = () => {
    tip.style.display = 'none';
  };
  chart.getZr().on('mousemove', (e: { offsetX: number; offsetY: number }) => {
    const at = [e.offsetX, e.offsetY];
    const inside = chart.containPixel({ gridIndex: 0 }, at);
    const [x, y] = inside ? (chart.convertFromPixel({ gridIndex: 0 }, at) as number[]) : [];
    const text = x === undefined || y === undefined ? undefined : readouts.get(host)?.(x, y);
    if (text === undefined) {
      hide();
      return;
    }
    tip.innerHTML = text;
    tip.style.display = 'block';
    const right = e.offsetX + 16 + tip.offsetWidth < host.clientWidth;
    tip.style.left = `${right ? e.offsetX + 16 : Math.max(0, e.offsetX - 16 - tip.offsetWidth)}px`;
    tip.style.top = `${Math.max(0, e.offsetY - tip.offsetHeight - 8)}px`;
  });
  chart.getZr().on('globalout', hide);
}

export function drawPlot(host: HTMLElement, plot: Plot, theme: Theme): void {
  let chart = echarts.getInstanceByDom(host);
  if (!chart) {
    chart = echarts.init(host);
    follow(host, chart);
  }
  if (plot.readout) {
    readouts.set(host, plot.readout);
  }
  chart.resize();
  const extra = plot.layers.some((l) => l.kind === 'ticks') ? TICKS_PX : 0;
  const width = Math.max(chart.getWidth() - MARGIN.left - MARGIN.right, 50);
  const height = Math.max(chart.getHeight() - MARGIN.top - extra - MARGIN.bottom, 50);
  chart.setOption(
    {
      animation: false,
      aria: { enabled: true, label: { description: plot.title } },
      textStyle: { fontFamily: FONT, color: theme.faint },
      grid: { ...MARGIN, top: MARGIN.top + extra },
      xAxis: {
        ...axisOption(plot.x, theme, width / 70),
        name: plot.x.name,
        nameLocation: 'middle',
        nameGap: 26,
        nameTextStyle: { color: theme.faint, fontSize: 12 },
      },
      yAxis: {
        ...axisOption(plot.y, theme, height / 48),
        name: plot.y.name,
        nameLocation: 'end',
        nameGap: 10 + extra,
        nameTextStyle: { color: theme.text, fontSize: 12, fontWeight: 600, align: 'left', padding: [0, 0, 0, -54] },
      },
      series: plot.layers.flatMap((layer, i) => series(layer, theme, 2 + i)),
    },
    { notMerge: true },
  );
}
