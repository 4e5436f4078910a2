// SPDX-License-Identifier: Apache-2.0
import { RUNS, type Report, type RunName, type VibrationCourse } from '../data';
import { fixed } from '../format';
import { niceAbove } from '../scale';
import { thin } from '../series';
import type { Theme } from '../theme';
import { FONT, echarts } from './echarts';

const BUCKETS = 1500;
const LEFT = 64;

interface Panel {
  name: string;
  top: number;
  height: number;
  column: (course: VibrationCourse) => (number | null)[];
}

const PANELS: Panel[] = [
  { name: 'Largest displacement of the tool in µm', top: 30, height: 180, column: (c) => c.peak_um },
  { name: 'Not from tooth to tooth: chatter, RMS in µm', top: 255, height: 180, column: (c) => c.unforced_um },
  { name: 'Spindle speed in rpm', top: 480, height: 110, column: (c) => c.speed_rpm },
];
export const VIBRATION_HEIGHT_PX = 640;

/** The tool's vibration and the spindle's speed of both runs over time. */
export class VibrationChart {
  readonly chart: echarts.ECharts;

  constructor(
    host: HTMLElement,
    private readonly report: Report,
  ) {
    this.chart = echarts.init(host);
  }

  private course(run: RunName): VibrationCourse | undefined {
    return this.report[run].vibration?.course;
  }

  private largest(column: Panel['column']): number {
    const values = RUNS.flatMap((run) => {
      const course = this.course(run);
      return course ? column(course) : [];
    });
    return values.reduce<number>((m, v) => (v != null && v > m ? v : m), 0);
  }

  draw(theme: Theme): void {
    this.chart.resize();
    this.chart.clear();
    const end = this.largest((c) => c.time_s);
    this.chart.setOption({
      animation: false,
      aria: { enabled: true, label: { description: 'Vibration of the tool and spindle speed of both runs over time' } },
      textStyle: { fontFamily: FONT, color: theme.faint },
      grid: PANELS.map((p) => ({ left: LEFT, right: 24, top: p.top, height: p.height })),
      axisPointer: { link: [{ xAxisIndex: 'all' }], lineStyle: { color: theme.faint } },
      tooltip: {
        trigger: 'axis',
        confine: true,
        transitionDuration: 0,
        backgroundColor: theme.paper,
        borderColor: theme.faint,
        textStyle: { color: theme.text, fontSize: 12 },
        valueFormatter: (v: unknown) => fixed(v as number, 1),
      },
      xAxis: PANELS.map((_, i) => ({
        type: 'value',
        gridIndex: i,
        min: 0,
        max: end,
        name: i === PANELS.length - 1 ? 'time in s' : '',
        nameLocation: 'middle',
        nameGap: 26,
        nameTextStyle: { color: theme.faint, fontSize: 12 },
        axisLine: { onZero: false, lineStyle: { color: theme.faint } },
        axisLabel: { color: theme.faint, fontSize: 11, showMaxLabel: false, formatter: (v: number) => fixed(v, v % 1 === 0 ? 0 : 1) },
        splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
      })),
      yAxis: PANELS.map((p, i) => ({
        type: 'value',
        gridIndex: i,
        name: p.name,
        nameLocation: 'end',
        nameGap: 9,
        nameTextStyle: { color: theme.text, fontSize: 12, fontWeight: 600, align: 'left', padding: [0, 0, 0, -56] },
        min: 0,
        max: niceAbove(Math.max(this.largest(p.column), 1e-3) * 1.05),
        axisLine: { show: true, lineStyle: { color: theme.faint } },
        axisLabel: { color: theme.faint, fontSize: 11, formatter: (v: number) => fixed(v, v % 1 === 0 ? 0 : 2) },
        splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
        splitNumber: 4,
      })),
      series: RUNS.flatMap((run) => {
        const course = this.course(run);
        return PANELS.map((p, i) => ({
          type: 'line',
          name: run === 'with' ? 'with the layer' : 'without the layer',
          xAxisIndex: i,
          yAxisIndex: i,
          showSymbol: false,
          silent: true,
          lineStyle: { width: run === 'with' ? 1.5 : 1.2 },
          color: theme.run[run],
          z: run === 'with' ? 3 : 2,
          data: course ? thin(course.time_s, p.column(course), 0, end, BUCKETS) : [],
        }));
      }),
    });
  }
}
