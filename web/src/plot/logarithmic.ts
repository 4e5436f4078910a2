// SPDX-License-Identifier: Apache-2.0
// A plot with a logarithmic y axis is drawn as logarithms on a linear axis of whole decades: ECharts' own
// logarithmic axis loses values below 1 if its ends are given, and whole decades if they are not.
import type { Maybe } from '../frame/data';
import type { Theme } from '../frame/theme';
import { type Axis, span } from './axes';
import type { Plot } from './drawn';
import type { Layer } from './layers';

/** Where a value is drawn; null: nowhere, as it has no logarithm. */
export function heightOf(axis: Axis, value: number): number;
export function heightOf(axis: Axis, value: Maybe): Maybe;
export function heightOf(axis: Axis, value: Maybe): Maybe {
  return !axis.log || value === null ? value : value > 0 ? Math.log10(value) : null;
}

/** The value that is drawn there. */
export function valueAtHeight(axis: Axis, height: number): number {
  return axis.log ? 10 ** height : height;
}

function logged(layer: Layer, axis: Axis): Layer {
  const all = (values: readonly Maybe[]) => values.map((v) => heightOf(axis, v));
  switch (layer.kind) {
    case 'line':
      return { ...layer, y: all(layer.y) };
    case 'band':
      return { ...layer, low: all(layer.low), high: all(layer.high) };
    case 'dots':
      return { ...layer, dots: layer.dots.filter((d) => d.y > 0).map((d) => ({ ...d, y: heightOf(axis, d.y) })) };
    case 'rules':
      return layer.axis === 'y' ? { ...layer, at: layer.at.filter((v) => v > 0).map((v) => heightOf(axis, v)) } : layer;
    default:
      return layer;
  }
}

/** Lines at 2 … 9 of each decade, as on logarithmic paper. */
function between(min: number, max: number, theme: Theme): Layer {
  const decades = Array.from({ length: max - min }, (_, i) => min + i);
  return { kind: 'rules', axis: 'y', at: decades.flatMap((d) => [2, 3, 4, 5, 6, 7, 8, 9].map((k) => d + Math.log10(k))), colour: theme.rule, width: 0.4 };
}

/** The plot as drawn. */
export function withDecades(plot: Plot, theme: Theme): Plot {
  if (!plot.y.log) {
    return plot;
  }
  const layers = plot.layers.map((l) => logged(l, plot.y));
  const [low, high] = span(layers.flatMap((l) => (l.kind === 'line' ? l.y : l.kind === 'dots' ? l.dots.map((d) => d.y) : [])));
  const min = Math.floor(low + 1e-9);
  const max = Math.max(Math.ceil(high - 1e-9), min + 1);
  return { ...plot, layers: [between(min, max, theme), ...layers], y: { ...plot.y, min, max } };
}
