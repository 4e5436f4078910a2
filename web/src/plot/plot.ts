// SPDX-License-Identifier: Apache-2.0
// The one plot of all pages: a figure with name, key, zoom, PNG, CSV, and its layers.
import { element, put } from '../frame/dom';
import { escapeHtml } from '../frame/html';
import type { Theme } from '../frame/theme';
import { axisOption } from './axes';
import { type Plot, drawnIn, remember } from './drawn';
import { echarts } from './echarts';
import { FONT } from '../frame/looks';
import { type Box, withEqualAspect } from './equal_aspect';
import { ink, keyLine, keysOf, scaleLine } from './key';
import { seriesOf } from './layers';
import { withDecades } from './logarithmic';
import { follow } from './reading';
import { ENGLISH, type ToolWords, bindTools, toolButtons } from './tools';
import { type Window, inView, letPageScroll, onZoom, zoomOption } from './zoom';

export type { Plot };

const MARGIN = { left: 62, right: 18, top: 12, bottom: 42 };
const TICKS_PX = 24;

/** A place for a plot; `kind`: low, high, tall, square. */
export function host(id: string, kind = '', words: ToolWords = ENGLISH): string {
  return `<figure class="frame" id="${id}-frame"><figcaption><span class="name" id="${id}-name"></span><span class="key-line" id="key-${id}"></span>${toolButtons(words)}</figcaption>
    <div class="plot ${kind}" id="${id}"></div><div class="scale-line" id="scale-${id}"></div></figure>`;
}

/** Places for plots side by side. */
export function panels(ids: readonly string[], kind = ''): string {
  return `<div class="panels">${ids.map((id) => host(id, kind)).join('')}</div>`;
}

function margins(plot: Plot) {
  return plot.layers.some((l) => l.kind === 'ticks') ? { ...MARGIN, top: MARGIN.top + TICKS_PX } : MARGIN;
}

/** With one scale for both axes, they are widened to fill the place. */
function fitted(plot: Plot, width: number, height: number): Plot {
  if (!plot.equal) {
    return plot;
  }
  const box: Box = { left: plot.x.min ?? 0, right: plot.x.max ?? 1, bottom: plot.y.min ?? 0, top: plot.y.max ?? 1 };
  const { left, right, bottom, top } = withEqualAspect(box, width, height);
  return { ...plot, x: { ...plot.x, min: left, max: right }, y: { ...plot.y, min: bottom, max: top } };
}

/** Everything but the zoom; `shown`: what is in view. */
function option(plot: Plot, theme: Theme, width: number, height: number, shown?: Window) {
  const view = shown?.x ?? [plot.x.min ?? -Infinity, plot.x.max ?? Infinity];
  return {
    xAxis: { ...axisOption(plot.x, theme, width / 70, shown?.x), name: plot.x.name, nameLocation: 'middle', nameGap: 26, nameTextStyle: { color: theme.faint, fontSize: 12 } },
    yAxis: axisOption(plot.y, theme, height / 48, shown?.y),
    series: plot.layers.flatMap((layer, i) => seriesOf(layer, theme, 2 + i, view).map((s, k) => ({ id: `${i}.${k}`, ...s }))),
  };
}

function size(chart: echarts.ECharts, plot: Plot): [number, number] {
  const { left, right, top, bottom } = margins(plot);
  return [Math.max(chart.getWidth() - left - right, 50), Math.max(chart.getHeight() - top - bottom, 50)];
}

/** Vectors on paper, because they are sharp; pixels on the screen, because they are quick. */
function chartIn(where: HTMLElement, theme: Theme): echarts.ECharts {
  const before = drawnIn(where);
  if (before && before.theme.printing === theme.printing) {
    before.chart.resize();
    return before.chart;
  }
  before?.chart.dispose();
  const chart = echarts.init(where, null, { renderer: theme.printing ? 'svg' : 'canvas' });
  follow(where, chart, () => drawnIn(where)?.plot);
  chart.on('datazoom', () => onZoom(where, redrawZoomed));
  if (!before) {
    bindTools(where);
    letPageScroll(where);
  }
  return chart;
}

function redrawZoomed(where: HTMLElement): void {
  const now = drawnIn(where);
  if (now) {
    now.chart.setOption(option(now.shown, now.theme, ...size(now.chart, now.plot), inView(now.chart, now.shown)));
  }
}

export function plot(id: string, given: Plot, theme: Theme): void {
  const where = element(id);
  const before = drawnIn(where);
  const zoom = zoomOption(given, before);
  const chart = chartIn(where, theme);
  const [width, height] = size(chart, given);
  const what = fitted(given, width, height);
  const shown = withDecades(what, theme);
  remember(where, { chart, plot: what, shown, theme });
  chart.setOption(
    {
      animation: false,
      aria: { enabled: true, label: { description: what.title } },
      textStyle: { fontFamily: FONT, color: theme.faint },
      grid: margins(what),
      dataZoom: zoom,
      ...option(shown, theme, width, height),
    },
    { notMerge: true },
  );
  if (before) {
    redrawZoomed(where);
  }
  put(`${id}-name`, escapeHtml(what.y.name));
  put(`key-${id}`, keyLine(keysOf(what.layers)));
  put(`scale-${id}`, what.scale ? scaleLine(what.scale) : '');
  ink(element(`${id}-frame`));
}
