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
  /** Zoom acts on both axes at once; else on x, and on y by itself. */
  plane?: boolean;
  /** One unit is as long across as up; x and y are the least that is shown. */
  equal?: boolean;
  /** Plots of one group are zoomed together: along x, planes along both. */
  group?: string;
  scale?: ColourScale;
  /** What the pointer reads; without it the values of the named layers. `reach`: 14 px in units of x. */
  readout?: (x: number, y: number, reach: number) => Reading | string | undefined;
  /** What CSV holds; without it the named layers. */
  columns?: () => Columns[];
}

export interface Drawn {
  chart: echarts.ECharts;
  /** With its true values, */
  plot: Plot;
  /** and as it is drawn: a logarithmic axis as logarithms. */
  shown: Plot;
  theme: Theme;
}

const drawn = new WeakMap<HTMLElement, Drawn>();

/** What is drawn in a host now. */
export function drawnIn(where: HTMLElement): Drawn | undefined {
  return drawn.get(where);
}

export function remember(where: HTMLElement, now: Drawn): void {
  drawn.set(where, now);
}
