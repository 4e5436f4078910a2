// SPDX-License-Identifier: Apache-2.0
// What a plot is made of: lines, bands, dots, rasters, spans, rules, ticks.
import type { Maybe } from '../frame/data';
import type { Theme } from '../frame/theme';
import { FONT } from '../frame/looks';
import { BUCKETS, thin } from './thin';

export interface Dot {
  x: number;
  y: number;
  label?: string;
  /** Where the label is. */
  side?: 'left' | 'right' | 'top' | 'bottom';
  /** Raises the label, px. */
  lift?: number;
}

interface Line {
  kind: 'line';
  x: readonly Maybe[];
  y: readonly Maybe[];
  colour: string;
  width?: number;
  dashed?: boolean;
  halo?: boolean;
  /** The value holds until the next one. */
  step?: boolean;
}
interface Band {
  kind: 'band';
  x: readonly Maybe[];
  low: readonly Maybe[];
  high: readonly Maybe[];
  colour: string;
  opacity: number;
  /** To show where it has no height. */
  outlined?: boolean;
}
interface Dots {
  kind: 'dots';
  dots: readonly Dot[];
  colour: string;
  size: number;
  hollow?: boolean;
  opacity?: number;
  bold?: boolean;
}
interface Raster {
  kind: 'raster';
  canvas: HTMLCanvasElement;
  x: [number, number];
  y: [number, number];
}
interface Spans {
  kind: 'spans';
  spans: readonly [number, number][];
  colour: string;
  opacity: number;
}
interface Rules {
  kind: 'rules';
  at: readonly number[];
  axis: 'x' | 'y';
  colour: string;
  width?: number;
  dashed?: boolean;
}
/** Ticks along the top, at values of x. */
interface Ticks {
  kind: 'ticks';
  ticks: readonly { x: number; label: string; strong: boolean }[];
  colour: string;
}

/** A layer with a name appears in key, tip and CSV; `quiet` keeps it out of the key. */
export type Layer = (Line | Band | Dots | Raster | Spans | Rules | Ticks) & { name?: string; quiet?: boolean };
export type LayerOf<Kind extends Layer['kind']> = Extract<Layer, { kind: Kind }>;

/** Lines across the whole plot at these values of an axis. */
export function rules(axis: 'x' | 'y', at: readonly number[], colour: string, dashed = false): Layer {
  return { kind: 'rules', axis, at, colour, dashed };
}

const LABEL_PX = 44;

type Api = { coord: (p: number[]) => number[] };
interface Box {
  x: number;
  y: number;
  width: number;
  height: number;
}

/** A series that draws one shape in pixels. */
function custom(z: number, item: (box: Box, api: Api) => object) {
  return { type: 'custom', silent: true, clip: true, z, data: [[0, 0]], renderItem: (params: { coordSys: Box }, api: Api) => item(params.coordSys, api) };
}

export function rising(x: readonly Maybe[]): boolean {
  let last = -Infinity;
  for (const v of x) {
    if (v === null || v < last) return false;
    last = v;
  }
  return true;
}

/** The points in view. Many points are thinned; each stretch keeps its extremes. */
export function pointsOf(layer: LayerOf<'line'>, from: number, to: number): (readonly [Maybe, Maybe])[] {
  if (layer.x.length > 2 * BUCKETS && rising(layer.x)) {
    return thin(layer.x, layer.y, from, to, BUCKETS);
  }
  return layer.x.map((v, i) => [v, layer.y[i] ?? null]);
}

function lineSeries(layer: LayerOf<'line'>, theme: Theme, z: number, view: [number, number]) {
  const base = {
    type: 'line',
    showSymbol: false,
    silent: true,
    connectNulls: false,
    ...(layer.step ? { step: 'end' } : {}),
    data: pointsOf(layer, ...view),
  };
  const width = layer.width ?? 1.4;
  const line = { ...base, z, color: layer.colour, lineStyle: { width, type: layer.dashed ? [6, 4] : 'solid', cap: 'butt' } };
  return layer.halo ? [{ ...base, z: z - 0.5, color: theme.paper, lineStyle: { width: width + 2.4, opacity: 0.85 } }, line] : [line];
}

const FAR = 1e6;

/** The area between two curves as one polygon; where a curve has no value, the area runs off the plot. */
function bandSeries(band: LayerOf<'band'>, z: number) {
  const points = [
    ...band.x.map((x, i) => [x ?? 0, band.high[i] ?? FAR]),
    ...band.x.map((x, i) => [x ?? 0, band.low[i] ?? -FAR]).reverse(),
  ];
  return custom(z, (_, api) => ({ type: 'polygon', shape: { points: points.map((p) => api.coord(p)) }, style: { fill: band.colour, opacity: band.opacity, ...(band.outlined ? { stroke: band.colour, lineWidth: 1 } : {}) } }));
}

function dotSeries(layer: LayerOf<'dots'>, theme: Theme, z: number) {
  return {
    type: 'scatter',
    silent: true,
    z,
    symbolSize: layer.size,
    clip: true,
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

function ticksSeries(layer: LayerOf<'ticks'>, theme: Theme, z: number) {
  const drawn = custom(z, (box, api) => {
    let last = -Infinity;
    const places = layer.ticks.map((t) => ({ ...t, px: api.coord([t.x, 0])[0] ?? 0 }));
    const strong = places.find((p) => p.strong)?.px ?? -Infinity;
    const children = places
      .filter((p) => p.px >= box.x - 1 && p.px <= box.x + box.width + 1)
      .flatMap((p) => {
        const top = box.y;
        const tick = {
          type: 'line',
          shape: { x1: p.px, y1: top - 6, x2: p.px, y2: top + (p.strong ? box.height : 5) },
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
  });
  return { ...drawn, clip: false };
}

const MOST_RASTER_PX = 4096;

/** Redrawn at the proportions of its place: an image among vectors is not stretched. */
function shaped(canvas: HTMLCanvasElement, width: number, height: number): HTMLCanvasElement {
  const sharpness = Math.min(2, MOST_RASTER_PX / Math.max(width, height));
  const out = document.createElement('canvas');
  [out.width, out.height] = [Math.round(sharpness * width), Math.round(sharpness * height)];
  out.getContext('2d')?.drawImage(canvas, 0, 0, out.width, out.height);
  return out;
}

function rasterSeries(layer: LayerOf<'raster'>, theme: Theme, z: number) {
  return custom(z, (_, api) => {
    const [left = 0, top = 0] = api.coord([layer.x[0], layer.y[1]]);
    const [right = 0, bottom = 0] = api.coord([layer.x[1], layer.y[0]]);
    const [width, height] = [right - left, bottom - top];
    const image = theme.printing ? shaped(layer.canvas, width, height) : layer.canvas;
    return { type: 'image', style: { image, x: left, y: top, width, height } };
  });
}

function spansSeries(layer: LayerOf<'spans'>, z: number) {
  return custom(z, (box, api) => ({
    type: 'group',
    children: layer.spans.map(([from, to]) => {
      const x = api.coord([from, 0])[0] ?? 0;
      const width = Math.max((api.coord([to, 0])[0] ?? 0) - x, 1);
      return { type: 'rect', shape: { x, y: box.y, width, height: box.height }, style: { fill: layer.colour, opacity: layer.opacity } };
    }),
  }));
}

function rulesSeries(layer: LayerOf<'rules'>, z: number) {
  return custom(z, (box, api) => ({
    type: 'group',
    children: layer.at.map((value) => {
      const across = layer.axis === 'x';
      const at = api.coord(across ? [value, 0] : [0, value])[across ? 0 : 1] ?? 0;
      const shape = across ? { x1: at, x2: at, y1: box.y, y2: box.y + box.height } : { x1: box.x, x2: box.x + box.width, y1: at, y2: at };
      return { type: 'line', shape, style: { stroke: layer.colour, lineWidth: layer.width ?? 1, lineDash: layer.dashed ? [5, 4] : null } };
    }),
  }));
}

export function seriesOf(layer: Layer, theme: Theme, z: number, view: [number, number]): object[] {
  switch (layer.kind) {
    case 'line':
      return lineSeries(layer, theme, z, view);
    case 'band':
      return [bandSeries(layer, z)];
    case 'dots':
      return [dotSeries(layer, theme, z)];
    case 'ticks':
      return [ticksSeries(layer, theme, z)];
    case 'raster':
      return [rasterSeries(layer, theme, z)];
    case 'spans':
      return [spansSeries(layer, z)];
    case 'rules':
      return [rulesSeries(layer, z)];
  }
}
