// SPDX-License-Identifier: Apache-2.0
import type { Trace } from '../data';
import { fixed } from '../format';
import {
  NOT_CUTTING,
  NearestSample,
  type Box,
  type Plane,
  columns,
  polylinesByClass,
  withEqualAspect,
} from '../path';
import { type ErrorClass, classOf } from '../scale';
import type { Theme } from '../theme';
import { FONT, echarts } from './echarts';

const MARGIN = { left: 52, right: 14, top: 10, bottom: 34 };
const REACH_PX = 14;

/** One path, coloured by contour error, at one scale in both directions. */
export class PathChart {
  readonly chart: echarts.ECharts;
  private readonly tip: HTMLElement;
  private readonly ring: HTMLElement;
  private plane: Plane = 'xy';
  private nearest: NearestSample | undefined;
  private view: Box | undefined;

  constructor(
    private readonly host: HTMLElement,
    private readonly trace: Trace,
    private readonly title: string,
  ) {
    this.chart = echarts.init(host);
    this.tip = host.appendChild(document.createElement('div'));
    this.tip.className = 'tip';
    this.ring = host.appendChild(document.createElement('div'));
    this.ring.className = 'ring';
    const mouse = this.chart.getZr();
    mouse.on('mousemove', (e: { offsetX: number; offsetY: number }) => this.point(e.offsetX, e.offsetY));
    mouse.on('globalout', () => this.hideTip());
    this.chart.on('datazoom', () => this.hideTip());
  }

  draw(plane: Plane, box: Box | undefined, classes: readonly ErrorClass[], theme: Theme): void {
    this.hideTip();
    this.chart.resize();
    if (plane !== this.plane || !this.nearest) {
      this.nearest = new NearestSample(this.trace, plane);
      this.plane = plane;
    }
    const width = Math.max(this.chart.getWidth() - MARGIN.left - MARGIN.right, 10);
    const height = Math.max(this.chart.getHeight() - MARGIN.top - MARGIN.bottom, 10);
    this.view = withEqualAspect(box ?? { left: 0, right: 1, bottom: 0, top: 1 }, width, height);
    const step_mm = (this.view.right - this.view.left) / width / 8;
    const [h, v] = columns(this.trace, plane);
    const classOfSample = h.map((_, i) => {
      const error = this.trace.contour_error_um[i];
      return this.trace.cutting[i] === 1 && error != null ? classOf(classes, error) : NOT_CUTTING;
    });
    const lines = polylinesByClass(h, v, classOfSample, step_mm);
    const order = [...lines.keys()].sort((a, b) => a - b); // the worst lies on top
    const [horizontal, vertical] = plane.toUpperCase();
    this.chart.setOption(
      {
        animation: false,
        aria: { enabled: true, label: { description: `${this.title}: path coloured by contour error` } },
        textStyle: { fontFamily: FONT, color: theme.faint },
        grid: { ...MARGIN, containLabel: false },
        xAxis: axis(theme, `${horizontal} in mm`, this.view.left, this.view.right),
        yAxis: { ...axis(theme, `${vertical} in mm`, this.view.bottom, this.view.top), nameGap: 36 },
        dataZoom: [
          { type: 'inside', xAxisIndex: 0, filterMode: 'none', zoomOnMouseWheel: 'ctrl' },
          { type: 'inside', yAxisIndex: 0, filterMode: 'none', zoomOnMouseWheel: 'ctrl' },
        ],
        series: order.map((cls) => ({
          type: 'lines',
          coordinateSystem: 'cartesian2d',
          polyline: true,
          large: true,
          largeThreshold: 1,
          progressive: 0,
          silent: true,
          clip: true,
          data: lines.get(cls),
          lineStyle:
            cls === NOT_CUTTING
              ? { color: theme.rapid, width: 0.8, opacity: 0.9 }
              : { color: classes[cls]?.colour ?? theme.text, width: 2.2, opacity: 1 },
        })),
      },
      { notMerge: true },
    );
  }

  resetView(): void {
    [0, 1].forEach((i) => this.chart.dispatchAction({ type: 'dataZoom', dataZoomIndex: i, start: 0, end: 100 }));
  }

  private point(px: number, py: number): void {
    const at = this.chart.convertFromPixel({ gridIndex: 0 }, [px, py]) as [number, number] | undefined;
    const beside = this.chart.convertFromPixel({ gridIndex: 0 }, [px + REACH_PX, py]) as [number, number];
    const found = at && this.nearest?.find(at[0], at[1], Math.abs(beside[0] - at[0]));
    if (found === undefined) {
      this.hideTip();
      return;
    }
    const t = this.trace;
    const [h, v] = columns(t, this.plane);
    const [x = 0, y = 0] = this.chart.convertToPixel({ gridIndex: 0 }, [h[found] ?? 0, v[found] ?? 0]) as number[];
    this.ring.style.cssText = `display:block;left:${x}px;top:${y}px`;
    this.tip.innerHTML = [
      `<b>Line ${t.line[found]}</b>`,
      `contour error <b>${fixed(t.contour_error_um[found], 1)} µm</b>`,
      `X ${fixed(t.x_mm[found], 3)}  Y ${fixed(t.y_mm[found], 3)}  Z ${fixed(t.z_mm[found], 3)}`,
      `at ${fixed(t.time_s[found], 3)} s, override ${fixed(t.override_percent[found], 0)} %, ` +
        `feed ${fixed(t.feed_mm_min[found], 0)} mm/min`,
    ].join('<br>');
    this.tip.style.display = 'block';
    const right = x + 14 + this.tip.offsetWidth < this.host.clientWidth;
    const below = y + 14 + this.tip.offsetHeight < this.host.clientHeight;
    this.tip.style.left = `${right ? x + 14 : Math.max(x - 14 - this.tip.offsetWidth, 0)}px`;
    this.tip.style.top = `${below ? y + 14 : Math.max(y - 14 - this.tip.offsetHeight, 0)}px`;
  }

  private hideTip(): void {
    this.tip.style.display = 'none';
    this.ring.style.display = 'none';
  }
}

function axis(theme: Theme, name: string, min: number, max: number) {
  return {
    type: 'value',
    name,
    nameLocation: 'middle',
    nameGap: 21,
    nameTextStyle: { color: theme.faint, fontSize: 12 },
    min,
    max,
    axisLine: { show: true, onZero: false, lineStyle: { color: theme.faint } },
    axisTick: { show: true },
    axisLabel: {
      color: theme.faint,
      fontSize: 11,
      showMinLabel: false,
      showMaxLabel: false,
      hideOverlap: true,
      formatter: (value: number) => fixed(value, Math.abs(value) % 1 > 1e-9 ? 1 : 0),
    },
    splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
  };
}
