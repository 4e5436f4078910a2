// SPDX-License-Identifier: Apache-2.0
import type { echarts } from './echarts';
import { type Drawn, type Plot, drawnIn } from './drawn';

/** What is in view; undefined if the axis finds its own ends. */
export interface Window {
  x?: [number, number] | undefined;
  y?: [number, number] | undefined;
}

interface Range {
  start: number;
  end: number;
}

/** Ctrl + wheel zooms both axes of a plane, otherwise x; Shift + wheel zooms y. A plot redrawn over the same axes keeps its view. */
export function zoomOption(plot: Plot, before?: Drawn): object[] {
  const kept = before && before.plot.x.name === plot.x.name && before.plot.y.name === plot.y.name ? ranges(before.chart) : [];
  const inside = { type: 'inside', filterMode: 'none', preventDefaultMouseMove: false };
  return [
    { ...inside, xAxisIndex: 0, zoomOnMouseWheel: 'ctrl', ...kept[0] },
    { ...inside, yAxisIndex: 0, zoomOnMouseWheel: plot.plane ? 'ctrl' : 'shift', ...kept[1] },
  ];
}

/** A wheel without a key scrolls the page; the chart would swallow it. */
export function letPageScroll(where: HTMLElement): void {
  for (const type of ['wheel', 'mousewheel']) {
    const keep = (event: Event) => (event as WheelEvent).ctrlKey || (event as WheelEvent).shiftKey || event.stopPropagation();
    where.addEventListener(type, keep, { capture: true, passive: true });
  }
}

function ranges(chart: echarts.ECharts): Range[] {
  return ((chart.getOption() as { dataZoom?: Range[] }).dataZoom ?? []).map(({ start, end }) => ({ start, end }));
}

function set(chart: echarts.ECharts, all: readonly Range[]): void {
  chart.dispatchAction({ type: 'dataZoom', batch: all.map((r, dataZoomIndex) => ({ dataZoomIndex, ...r })) });
}

export function inView(chart: echarts.ECharts, plot: Plot): Window {
  const [x, y] = ranges(chart);
  const part = ({ min, max }: Plot['x'], range: Range | undefined): [number, number] | undefined => {
    if (min === undefined || max === undefined) {
      return undefined;
    }
    const at = (percent: number) => min + ((max - min) * percent) / 100;
    return [at(range?.start ?? 0), at(range?.end ?? 100)];
  };
  return { x: part(plot.x, x), y: part(plot.y, y) };
}

/** Zooms about the middle of the view, both axes of a plane, otherwise x; `factor` > 1 zooms in. */
export function zoomBy(where: HTMLElement, factor: number): void {
  const drawn = drawnIn(where);
  if (drawn) {
    set(
      drawn.chart,
      ranges(drawn.chart).map(({ start, end }, axis) => {
        if (axis > 0 && !drawn.plot.plane) {
          return { start, end };
        }
        const half = Math.min((end - start) / 2 / factor, 50);
        const middle = Math.min(Math.max((start + end) / 2, half), 100 - half);
        return { start: middle - half, end: middle + half };
      }),
    );
  }
}

export function showWhole(where: HTMLElement): void {
  const chart = drawnIn(where)?.chart;
  if (chart) {
    set(chart, ranges(chart).map(() => ({ start: 0, end: 100 })));
  }
}

const near = (a: readonly Range[], b: readonly Range[]) => a.every((r, i) => Math.abs(r.start - (b[i]?.start ?? 0)) < 1e-9 && Math.abs(r.end - (b[i]?.end ?? 0)) < 1e-9);

/** A plot was zoomed: redraws it and those of its group for what is now in view. Only planes share heights. */
export function onZoom(where: HTMLElement, redraw: (where: HTMLElement) => void): void {
  const source = drawnIn(where);
  if (!source) {
    return;
  }
  redraw(where);
  const all = ranges(source.chart);
  const wanted = source.plot.plane ? all : all.slice(0, 1);
  for (const other of document.querySelectorAll<HTMLElement>('.plot')) {
    const drawn = drawnIn(other);
    if (other !== where && drawn && source.plot.group !== undefined && drawn.plot.group === source.plot.group && !near(wanted, ranges(drawn.chart))) {
      set(drawn.chart, wanted);
    }
  }
}
