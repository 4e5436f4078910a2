// SPDX-License-Identifier: Apache-2.0
import type { Maybe } from '../frame/data';
import { fixed, short } from '../frame/numbers';
import type { Theme } from '../frame/theme';

export interface Axis {
  name: string;
  min?: number;
  max?: number;
  /** Wanted count of ticks. */
  ticks?: number;
  log?: boolean;
}

/** 1, 2 or 5 times a power of ten, about `count` of them in the range. */
export function niceStep(range: number, count: number): number {
  const rough = range / Math.max(count, 1);
  const power = 10 ** Math.floor(Math.log10(rough));
  return ([1, 2, 5, 10].find((m) => m * power >= rough * (1 - 1e-9)) ?? 10) * power;
}

export function span(values: readonly Maybe[]): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const v of values) {
    if (v !== null) {
      low = Math.min(low, v);
      high = Math.max(high, v);
    }
  }
  return low <= high ? [low, high] : [0, 1];
}

/** Widened to whole steps, so that no curve touches the frame. */
export function roomy(values: readonly Maybe[], withZero = false): [number, number] {
  let [low, high] = span(values);
  if (withZero) {
    [low, high] = [Math.min(low, 0), Math.max(high, 0)];
  }
  const reach = high - low > 1e-9 * Math.max(Math.abs(low), Math.abs(high)) ? high - low : Math.max(Math.abs(high), 1) * 0.2;
  const step = niceStep(reach * 1.1, 8);
  const middle = 0.5 * (low + high);
  const [from, to] = [Math.min(low, middle - 0.5 * reach), Math.max(high, middle + 0.5 * reach)];
  const under = low === 0 && withZero ? 0 : Math.floor((from - 0.04 * reach) / step) * step;
  return [under, Math.ceil((to + 0.04 * reach) / step) * step];
}

function decimalsOf(interval: number): number {
  return Math.max(0, -Math.floor(Math.log10(interval) + 1e-9));
}

/** `count`: of ticks that have room; `shown`: the part of the axis that is in view. */
export function axisOption(axis: Axis, theme: Theme, count: number, shown?: [number, number]) {
  const known = !axis.log && axis.min !== undefined && axis.max !== undefined;
  const range = known ? (axis.max as number) - (axis.min as number) : undefined;
  const view = shown ? shown[1] - shown[0] : range;
  const wanted = axis.ticks ?? count;
  const interval = view === undefined || !(view > 0) ? undefined : niceStep(view, wanted);
  const isTick = (v: number | undefined) => interval === undefined || v === undefined || Math.abs(v / interval - Math.round(v / interval)) < 1e-6;
  const [low, high] = shown ?? [axis.min, axis.max];
  return {
    type: axis.log ? 'log' : 'value',
    // A logarithmic axis shows whole decades about its data.
    ...(axis.min === undefined || axis.log ? { scale: true } : { min: axis.min }),
    ...(axis.max === undefined || axis.log ? {} : { max: axis.max }),
    // Not `interval`, which would count from `min`: so the ticks are multiples.
    ...(interval === undefined || view === undefined ? {} : { splitNumber: view / interval }),
    axisLine: { show: true, onZero: false, lineStyle: { color: theme.faint } },
    axisTick: { show: true, lineStyle: { color: theme.faint } },
    splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
    axisLabel: {
      color: theme.faint,
      fontSize: 11,
      hideOverlap: true,
      showMinLabel: axis.log || isTick(low),
      showMaxLabel: axis.log || isTick(high),
      formatter: (v: number) => (interval === undefined ? short(v) : fixed(v, decimalsOf(interval))),
    },
  };
}
