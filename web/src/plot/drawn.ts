// SPDX-License-Identifier: Apache-2.0
import type { Theme } from '../frame/theme';
import type { Axis } from './axes';
import type { Columns } from './csv';
import type { echarts } from './echarts';
import type { ColourScale } from './key';
import type { Layer } from './layers';
import type { Reading } from './reading';

export interface Plot {
  title: string;
  x: Axis;
  y: Axis;
  layers: Layer[];
  /** Zooms both axes at once; otherwise x and y zoom separately. */
  plane?: boolean;
  /** One unit is as long across as up; the axes are widened to fit. */
  equal?: boolean;
  /** Plots of one group zoom together: along x, planes along both axes. */
  group?: string;
  scale?: ColourScale;
  /** What the tip at the pointer says; by default the values of the named layers. `reach`: 14 px in units of x. */
  readout?: (x: number, y: number, reach: number) => Reading | string | undefined;
  /** What the CSV holds; by default the named layers. */
  columns?: () => Columns[];
}

export interface Drawn {
  chart: echarts.ECharts;
  /** With true values, */
  plot: Plot;
  /** and as drawn: a logarithmic axis as logarithms. */
  shown: Plot;
  theme: Theme;
}

const drawn = new WeakMap<HTMLElement, Drawn>();

/** What is now drawn in a place. */
export function drawnIn(where: HTMLElement): Drawn | undefined {
  return drawn.get(where);
}

export function remember(where: HTMLElement, now: Drawn): void {
  drawn.set(where, now);
}
