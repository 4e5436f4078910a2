// SPDX-License-Identifier: Apache-2.0
import type { Maybe } from '../frame/data';
import { fixed, plain, short } from '../frame/numbers';
import type { Theme } from '../frame/theme';

export interface Axis {
  name: string;
  min?: number;
  max?: number;
  /** How many ticks to aim at, */
  ticks?: number;
  /** or the distance between them while the whole axis is shown. */
  step?: number;
  /** Logarithmic; y only. */
  log?: boolean;
}

/** The least of `leads` × 10ⁿ that is not below `value`. */
function leastOf(leads: readonly number[], value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return (leads.find((lead) => lead * power >= value * (1 - 1e-9)) ?? 10) * power;
}

/** 1, 2 or 5 × 10ⁿ, so that about `count` steps make up the range. */
export function niceStep(range: number, count: number): number {
  return leastOf([1, 2, 5, 10], range / Math.max(count, 1));
}

/** A round number not below `value`, for the end of an axis or scale; 1 if there is nothing to show. */
export function niceAbove(value: number): number {
  return value > 0 && Number.isFinite(value) ? leastOf([1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10], value) : 1;
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

/** An axis with room for these values. */
export function axisFor(name: string, values: readonly Maybe[], withZero = false): Axis & { min: number; max: number } {
  const [min, max] = roomy(values, withZero);
  return { name, min, max };
}

function decimalsOf(interval: number): number {
  return Math.max(0, -Math.floor(Math.log10(interval) + 1e-9));
}

const MOST_DECIMALS = 5;
const WIDE = 1e6;

/** No wider than the margin; `largest`: of all values to be written. */
function labelOf(v: number, interval: number | undefined, largest: number): string {
  if (interval === undefined) {
    return short(v);
  }
  const decimals = decimalsOf(interval);
  return decimals > MOST_DECIMALS || largest >= WIDE ? plain(Math.abs(v) < 1e-6 * interval ? 0 : v, 3) : fixed(v, decimals);
}

/** `count`: how many ticks have room; `shown`: the part of the axis in view. */
export function axisOption(axis: Axis, theme: Theme, count: number, shown?: [number, number]) {
  const known = axis.min !== undefined && axis.max !== undefined;
  const range = known ? (axis.max as number) - (axis.min as number) : undefined;
  const view = shown ? shown[1] - shown[0] : range;
  const wanted = axis.ticks ?? count;
  const step = view === range ? axis.step : undefined;
  const nice = view === undefined || !(view > 0) ? undefined : niceStep(view, wanted);
  const interval = step ?? (nice !== undefined && axis.log ? Math.max(1, Math.ceil(nice)) : nice);
  const isTick = (v: number | undefined) => interval === undefined || v === undefined || Math.abs(v / interval - Math.round(v / interval)) < 1e-6;
  const [low, high] = shown ?? [axis.min, axis.max];
  return {
    type: 'value',
    ...(axis.min === undefined ? { scale: true } : { min: axis.min }),
    ...(axis.max === undefined ? {} : { max: axis.max }),
    ...(axis.log ? { minInterval: 1 } : {}),
    // `interval` counts from `min`, which suits a given step only; `splitNumber` puts the ticks on round multiples.
    interval: step ?? null,
    ...(interval === undefined || view === undefined ? {} : { splitNumber: view / interval }),
    axisLine: { show: true, onZero: false, lineStyle: { color: theme.faint } },
    axisTick: { show: true, lineStyle: { color: theme.faint } },
    splitLine: { lineStyle: { color: theme.rule, width: 0.6 } },
    axisLabel: {
      color: theme.faint,
      fontSize: 11,
      hideOverlap: true,
      showMinLabel: isTick(low),
      showMaxLabel: isTick(high),
      formatter: (v: number) => (axis.log ? short(10 ** v) : labelOf(v, interval, Math.max(Math.abs(low ?? 0), Math.abs(high ?? 0)))),
    },
  };
}
