// SPDX-License-Identifier: Apache-2.0
import { RUNS, type Report, type RunName, type Trace } from '../data';
import { fixed } from '../format';
import { niceAbove } from '../scale';
import { type Point, thin } from '../series';
import type { Theme } from '../theme';
import { FONT, echarts } from './echarts';

export type Abscissa = 'time_s' | 'path_mm';

const BUCKETS = 1500;
const LABELS: Record<RunName, string> = { without: 'without the layer', with: 'with the layer' };

interface Panel {
  name: string;
  unit: string;
  decimals: number;
  top: number;
  height: number;
  step: boolean;
  column: (trace: Trace) => (number | null)[];
}

/** A rapid leaves no surface: its error is a gap. */
const errorInCut = (trace: Trace) =>
  trace.contour_error_um.map((e, i) => (trace.cutting[i] === 1 ? e : null));

const PANELS: Panel[] = [
  { name: 'Contour error', unit: 'µm', decimals: 1, top: 30, height: 250, step: false, column: errorInCut },
  { name: 'Feed override', unit: '%', decimals: 0, top: 330, height: 120, step: true, column: (t) => t.override_percent },
  { name: 'Path feed', unit: 'mm/min', decimals: 0, top: 500, height: 120, step: false, column: (t) => t.feed_mm_min },
];
export const COURSE_HEIGHT_PX = 710;

/** Contour error, override and feed of both runs, one above the other on one abscissa. */
export class CourseChart {
  readonly chart: echarts.ECharts;
  private abscissa: Abscissa = 'time_s';
  private readonly values: Record<RunName, (number | null)[][]>;

  constructor(
    host: HTMLElement,
    private readonly report: Report,
  ) {
    this.chart = echarts.init(host);
    this.values = {
      without: PANELS.map((p) => p.column(report.without.trace)),
      with: PANELS.map((p) => p.column(report.with.trace)),
    };
    this.chart.on('datazoom', () => this.chart.setOption({ series: this.series() }));
  }

  draw(abscissa: Abscissa, theme: Theme): void {
    this.abscissa = abscissa;
    this.chart.resize();
    this.chart.clear();
    const [from, to] = this.extent();
    this.chart.setOption({
      animation: false,
      aria: { enabled: true, label: { description: 'Contour error, feed override and path feed of both runs' } },
      textStyle: { fontFamily: FONT, color: theme.faint },
      grid: PANELS.map((p) => ({ left: 64, right: 24, top: p.top, height: p.height })),
      axisPointer: { link: [{ xAxisIndex: 'all' }], lineStyle: { color: theme.faint } },
      tooltip: {
        trigger: 'axis',
        confine: true,
        transitionDuration: 0,
        backgroundColor: theme.paper,
        borderColor: theme.faint,
        textStyle: { color: theme.text, fontSize: 12 },
        formatter: (items: unknown) => this.tooltip(items as { axisValue: number }[]),
      },
      xAxis: PANELS.map((_, i) => ({
        type: 'value',
        gridIndex: i,
        min: from,
        max: to,
        name: i === PANELS.length - 1 ? this.abscissaName() : '',
        nameLocation: 'middle',
        nameGap: 26,
        nameTextStyle: { color: theme.faint, fontSize: 12 },
        axisLine: { onZero: false, lineStyle: { color: theme.faint } },
        axisLabel: { color: theme.faint, fontSize: 11, showMaxLabel: false },
        splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
      })),
      yAxis: PANELS.map((p, i) => ({
        type: 'value',
        gridIndex: i,
        name: `${p.name} in ${p.unit}`,
        nameLocation: 'end',
        nameGap: 9,
        nameTextStyle: { color: theme.text, fontSize: 12, fontWeight: 600, align: 'left', padding: [0, 0, 0, -56] },
        ...this.range(i),
        axisLine: { show: true, lineStyle: { color: theme.faint } },
        axisLabel: { color: theme.faint, fontSize: 11, formatter: (v: number) => fixed(v, v % 1 === 0 ? 0 : 1) },
        splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
        splitNumber: i === 0 ? 6 : 4,
      })),
      dataZoom: [
        { type: 'inside', xAxisIndex: 'all', filterMode: 'none', zoomOnMouseWheel: 'ctrl' },
        {
          type: 'slider',
          xAxisIndex: 'all',
          filterMode: 'none',
          showDataShadow: false,
          bottom: 8,
          height: 20,
          left: 64,
          right: 24,
          brushSelect: false,
          borderColor: theme.rule,
          fillerColor: `${theme.run.with}22`,
          handleStyle: { color: theme.paper, borderColor: theme.faint },
          moveHandleSize: 0,
          textStyle: { color: theme.faint, fontSize: 11 },
          labelFormatter: (v: number) => fixed(v, 1),
        },
      ],
      series: this.series(theme),
    });
  }

  /** Series of the visible stretch; each pixel column keeps its extremes. */
  private series(theme?: Theme) {
    const [from, to] = this.visible();
    return RUNS.flatMap((run) =>
      PANELS.map((p, i) => ({
        id: `${run}-${i}`,
        ...(theme ? this.look(run, i, p, theme) : {}),
        data: this.points(run, i, from, to),
      })),
    );
  }

  private points(run: RunName, panel: number, from: number, to: number): Point[] {
    return thin(this.report[run].trace[this.abscissa], this.values[run][panel] ?? [], from, to, BUCKETS);
  }

  private look(run: RunName, index: number, panel: Panel, theme: Theme) {
    const limit = this.report.limit_um;
    const line = (value: number, position: string) => ({
      yAxis: value,
      label: {
        show: value > 0,
        formatter: `limit ±${fixed(limit, 1)} µm`,
        position,
        color: theme.text,
        fontSize: 11,
      },
    });
    return {
      type: 'line',
      name: LABELS[run],
      xAxisIndex: index,
      yAxisIndex: index,
      showSymbol: false,
      connectNulls: false,
      silent: true,
      ...(panel.step ? { step: 'end' } : {}),
      lineStyle: { width: run === 'with' ? 1.5 : 1.2 },
      color: theme.run[run],
      z: run === 'with' ? 3 : 2,
      ...(index === 0 && run === 'with'
        ? {
            markLine: {
              silent: true,
              symbol: 'none',
              animation: false,
              lineStyle: { color: theme.limit, type: [6, 4], width: 1 },
              data: [line(limit, 'insideEndTop'), line(-limit, 'insideEndBottom')],
            },
          }
        : {}),
    };
  }

  private range(panel: number) {
    if (panel === 0) {
      const reach = Math.max(...RUNS.map((r) => largest(this.values[r][0] ?? [])), this.report.limit_um * 1.3);
      const low = Math.min(...RUNS.map((r) => smallest(this.values[r][0] ?? [])), -this.report.limit_um * 1.3);
      return { max: niceAbove(reach), min: -niceAbove(-low) };
    }
    const inCut = RUNS.map((r) => {
      const { cutting } = this.report[r].trace;
      return largest((this.values[r][panel] ?? []).map((v, i) => (cutting[i] === 1 ? v : null)));
    });
    const top = Math.max(...inCut, panel === 1 ? 100 : 1);
    return { min: 0, max: niceAbove(top * 1.05) };
  }

  private extent(): [number, number] {
    const ends = RUNS.map((r) => this.report[r].trace[this.abscissa].at(-1) ?? 0);
    return [0, Math.max(...ends, 1e-3)];
  }

  private visible(): [number, number] {
    const [from, to] = this.extent();
    const option = this.chart.getOption() as { dataZoom?: { start: number; end: number }[] } | undefined;
    const zoom = option?.dataZoom?.[0];
    return zoom ? [from + ((to - from) * zoom.start) / 100, from + ((to - from) * zoom.end) / 100] : [from, to];
  }

  private abscissaName(): string {
    return this.abscissa === 'time_s' ? 'time in s' : 'path length in mm';
  }

  private tooltip(items: { axisValue: number }[]): string {
    const x = items[0]?.axisValue ?? 0;
    const head = this.abscissa === 'time_s' ? `${fixed(x, 3)} s` : `${fixed(x, 3)} mm of path`;
    const indices = RUNS.map((r) => nearestIndex(this.report[r].trace[this.abscissa], x));
    const row = (label: string, cells: string[]) =>
      `<tr><td>${label}</td>${cells.map((c) => `<td class="n">${c}</td>`).join('')}</tr>`;
    return (
      `<table class="tooltip"><tr><th>${head}</th><th>without</th><th>with</th></tr>` +
      row('line', RUNS.map((r, k) => String(this.report[r].trace.line[indices[k] ?? -1] ?? '–'))) +
      PANELS.map((p, i) =>
        row(
          `${p.name.toLowerCase()}, ${p.unit}`,
          RUNS.map((r, k) => fixed(this.values[r][i]?.[indices[k] ?? -1], p.decimals)),
        ),
      ).join('') +
      '</table>'
    );
  }
}

function largest(values: readonly (number | null)[]): number {
  return values.reduce<number>((m, v) => (v != null && v > m ? v : m), 0);
}

function smallest(values: readonly (number | null)[]): number {
  return values.reduce<number>((m, v) => (v != null && v < m ? v : m), 0);
}

/** Index of the value nearest to `at`; −1 beyond the end: that run is over. */
function nearestIndex(x: readonly (number | null)[], at: number): number {
  let low = 0;
  let high = x.length - 1;
  if (high < 0 || at > (x[high] ?? Infinity)) {
    return -1;
  }
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((x[middle] ?? -Infinity) < at) {
      low = middle;
    } else {
      high = middle;
    }
  }
  const distance = (i: number) => Math.abs((x[i] ?? Infinity) - at);
  return distance(low) <= distance(high) ? low : high;
}
