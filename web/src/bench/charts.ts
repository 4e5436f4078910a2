// SPDX-License-Identifier: Apache-2.0
import { type Band, bandSeries } from '../charts/band';
import { FONT, echarts } from '../charts/echarts';
import type { Theme } from '../theme';
import { type Bench, type Curve, type Maybe, type Row, type Trace, label } from './data';
import { short } from './format';

export interface Line {
  name: string;
  colour: string;
  x: readonly Maybe[];
  y: readonly Maybe[];
  width?: number;
  dashed?: boolean;
  dots?: boolean;
}
export interface Panel {
  title: string;
  x: string;
  lines: Line[];
  band?: Band;
  log?: boolean;
  min?: number;
  max?: number;
}

const PALETTE: Record<'light' | 'dark', string[]> = {
  light: ['#1b6aa5', '#59a0cf', '#b4501e', '#2e7d4f', '#8a5fb0', '#a08a1f', '#c0518b', '#4f5b66', '#1d2329'],
  dark: ['#69b3e7', '#3f7fae', '#f2955c', '#6cc090', '#b797dc', '#d3bd4e', '#e58bba', '#a9b4be', '#e4e8ec'],
};

const BOUND_OPACITY = 0.22;
const pairs = (x: readonly Maybe[], y: readonly Maybe[]) => x.map((v, i) => [v, y[i] ?? null]);

function series(panel: Panel) {
  const out: object[] = [];
  const base = { type: 'line', showSymbol: false, silent: true };
  if (panel.band) {
    out.push(bandSeries(panel.band, BOUND_OPACITY));
  }
  for (const line of panel.lines) {
    out.push({
      ...base,
      name: line.name,
      showSymbol: line.dots ?? false,
      symbol: 'circle',
      symbolSize: 7,
      color: line.colour,
      lineStyle: { width: line.width ?? 1.4, type: line.dashed ? 'dashed' : 'solid' },
      data: pairs(line.x, line.y),
    });
  }
  return out;
}

export function drawPanel(host: HTMLElement, panel: Panel, theme: Theme): echarts.ECharts {
  const chart = echarts.getInstanceByDom(host) ?? echarts.init(host);
  chart.resize();
  const axis = {
    axisLine: { show: true, onZero: false, lineStyle: { color: theme.faint } },
    splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
  };
  chart.setOption(
    {
      animation: false,
      aria: { enabled: true, label: { description: panel.title } },
      textStyle: { fontFamily: FONT, color: theme.faint },
      grid: { left: 62, right: 18, top: 34, bottom: 42 },
      xAxis: {
        ...axis,
        type: 'value',
        min: 'dataMin',
        max: 'dataMax',
        name: panel.x,
        nameLocation: 'middle',
        nameGap: 26,
        nameTextStyle: { color: theme.faint, fontSize: 12 },
        axisLabel: { color: theme.faint, fontSize: 11, showMaxLabel: false, formatter: short },
      },
      yAxis: {
        ...axis,
        type: panel.log ? 'log' : 'value',
        ...(panel.min === undefined ? { scale: true } : { min: panel.min }),
        ...(panel.max === undefined ? {} : { max: panel.max }),
        name: panel.title,
        nameLocation: 'end',
        nameGap: 10,
        nameTextStyle: { color: theme.text, fontSize: 12, fontWeight: 600, align: 'left', padding: [0, 0, 0, -54] },
        axisLabel: { color: theme.faint, fontSize: 11, formatter: short },
      },
      series: series(panel),
    },
    { notMerge: true },
  );
  return chart;
}

export function key(lines: readonly { name: string; colour: string; band?: boolean }[]): string {
  return lines.map((l) => `<span class="key"><i class="${l.band ? 'band' : ''}" style="background:${l.colour}"></i>${l.name}</span>`).join('');
}

const minus = (a: readonly Maybe[], b: readonly Maybe[], scale: number) =>
  a.map((v, i) => (v === null || b[i] == null ? null : (v - (b[i] ?? 0)) * scale));
const times = (a: readonly Maybe[], scale: number) => a.map((v) => (v === null ? null : v * scale));

/** Half of a range that shows nearly all of the values. */
function mostOf(values: readonly Maybe[], share: number): number {
  const sizes = values.filter((v): v is number => v !== null).map(Math.abs).sort((a, b) => a - b);
  return sizes[Math.floor(share * (sizes.length - 1))] ?? 1;
}

function nice(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return ([1, 2, 5, 10].find((m) => m * power >= value) ?? 10) * power;
}

export function tracePanels(trace: Trace, theme: Theme): Panel[] {
  const counts = trace.name === 'flywheel'; // 0.001 mm and 1 ms: 1 mm/s = 1 count/tick
  const units = counts ? ['counts/tick', 'counts/tick²'] : ['mm/s', 'mm/s²'];
  const scale = counts ? 1e-3 : 1;
  const t = trace.t_s;
  const [before, after, truth] = [theme.run.without, theme.run.with, theme.text];
  const band = (bound: readonly Maybe[], by: number) => ({ x: t, low: times(bound, -by), high: times(bound, by), colour: after });
  const error_v = minus(trace.velocity_mm_s, trace.true_velocity_mm_s, 1);
  const error_a = minus(trace.acceleration_mm_s2, trace.true_acceleration_mm_s2, scale);
  const top = (bound: readonly Maybe[], by: number) => nice(2.5 * by * mostOf(bound, 0.5));
  const [tv, ta] = [top(trace.velocity_bound_mm_s, 1), top(trace.acceleration_bound_mm_s2, scale)];
  const x = 'time in s';
  return [
    {
      title: `Velocity, ${units[0]}`,
      x,
      lines: [
        { name: 'difference', colour: before, x: t, y: trace.difference_velocity_mm_s, width: 0.9 },
        { name: 'ours', colour: after, x: t, y: trace.velocity_mm_s, width: 2 },
      ],
    },
    {
      title: `Acceleration, ${units[1]}`,
      x,
      lines: [
        { name: 'difference', colour: before, x: t, y: times(trace.difference_acceleration_mm_s2, scale), width: 0.6 },
        { name: 'ours', colour: after, x: t, y: times(trace.acceleration_mm_s2, scale), width: 2 },
      ],
    },
    {
      title: `Our velocity less the true one, ${units[0]}`,
      x,
      min: -tv,
      max: tv,
      band: band(trace.velocity_bound_mm_s, 1),
      lines: [{ name: 'error', colour: after, x: t, y: error_v }],
    },
    counts
      ? {
          title: `Acceleration again, enlarged, ${units[1]}`,
          x,
          min: -0.02,
          max: 0.01,
          band: {
            x: t,
            low: minus(times(trace.acceleration_mm_s2, scale), times(trace.acceleration_bound_mm_s2, scale), 1),
            high: minus(times(trace.acceleration_mm_s2, scale), times(trace.acceleration_bound_mm_s2, -scale), 1),
            colour: after,
          },
          lines: [
            { name: 'ours', colour: after, x: t, y: times(trace.acceleration_mm_s2, scale) },
            { name: 'true', colour: truth, x: t, y: times(trace.true_acceleration_mm_s2, scale), dashed: true, width: 1 },
          ],
        }
      : {
          title: `Our acceleration less the true one, ${units[1]}`,
          x,
          min: -ta,
          max: ta,
          band: band(trace.acceleration_bound_mm_s2, scale),
          lines: [{ name: 'error', colour: after, x: t, y: error_a }],
        },
  ];
}

export function traceKey(theme: Theme): { name: string; colour: string; band?: boolean }[] {
  return [
    { name: 'difference of counts', colour: theme.run.without },
    { name: 'event-driven, limits known', colour: theme.run.with },
    { name: 'its guaranteed bound', colour: theme.run.with, band: true },
    { name: 'true', colour: theme.text },
  ];
}

export function lagLines(bench: Bench, scene: string, quantity: 'velocity' | 'acceleration', theme: Theme): Line[] {
  const names = [...new Set(bench.rows.map(label))];
  const lags = bench.lags_s.map((s) => s * 1000);
  const colours = PALETTE[theme.scheme];
  const positive = (v: Maybe) => (v !== null && v > 0 ? v : null);
  return bench.rows
    .filter((r: Row) => r.scene === scene && positive(r[quantity].rms) !== null)
    .flatMap((r) => {
      const f = r[quantity];
      const colour = colours[names.indexOf(label(r)) % colours.length] ?? theme.text;
      const line: Line = { name: label(r), colour, x: lags, y: f.rms_at_lag.map(positive), width: r.estimator === 'kalman' ? 2.4 : 1.4 };
      const own = f.own_lag_s === null ? null : f.own_lag_s * 1000;
      return [line, { ...line, name: '', x: [own], y: [f.rms_at_own_lag], dots: true }];
    });
}

export function lagPanels(bench: Bench, scene: string, theme: Theme): Panel[] {
  return (['velocity', 'acceleration'] as const).map((quantity) => ({
    title: quantity === 'velocity' ? 'RMS error of velocity, mm/s' : 'RMS error of acceleration, mm/s²',
    x: 'lag in ms',
    log: true,
    lines: lagLines(bench, scene, quantity, theme),
  }));
}

export function figurePanels(bench: Bench, theme: Theme): Panel[] {
  const lines = (curves: readonly Curve[], palette: readonly string[]) =>
    curves.map((c, i) => ({ name: c.name, colour: palette[i % palette.length] ?? theme.text, x: c.x, y: c.y, width: 1.8 }));
  const colours = [0, 2, 3].map((i) => PALETTE[theme.scheme][i] ?? theme.text);
  const [most, count] = bench.figure_5;
  return [
    { title: 'Fig. 3a: counts/tick', x: 'feed in mm/min', lines: lines(bench.figure_3a, colours) },
    { title: 'Fig. 3b: counts/tick²', x: 'overload in g', lines: lines(bench.figure_3b, colours) },
    { title: `Fig. 5: ${most?.name ?? ''}`, x: 'feed in mm/min', log: true, lines: lines(most ? [most] : [], colours) },
    { title: `Fig. 5: ${count?.name ?? ''}`, x: 'feed in mm/min', lines: lines(count ? [count] : [], colours.slice(1)) },
  ];
}
