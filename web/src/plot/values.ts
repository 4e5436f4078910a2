// SPDX-License-Identifier: Apache-2.0
// Arithmetic on columns with gaps: a result is a gap wherever an operand is.
import type { Maybe } from '../frame/data';

type Column = readonly (Maybe | undefined)[];

export const known = (v: Maybe | undefined): v is number => v !== null && v !== undefined;

export function scaled(values: Column, by: number): Maybe[] {
  return values.map((v) => (known(v) ? v * by : null));
}

/** a + times·b. */
export function plus(a: Column, b: Column, times = 1): Maybe[] {
  return a.map((v, i) => {
    const w = b[i];
    return known(v) && known(w) ? v + times * w : null;
  });
}

export const minus = (a: Column, b: Column): Maybe[] => plus(a, b, -1);

/** Index of the value of the largest size. */
export function largestAt(values: Column): number {
  return values.reduce<number>((best, v, i) => (Math.abs(v ?? 0) > Math.abs(values[best] ?? 0) ? i : best), 0);
}

export function largestSize(values: Column): number {
  return Math.abs(values[largestAt(values)] ?? 0);
}

/** This share of the values is not above it; undefined if there are none. */
export function quantile(values: Column, share: number): number | undefined {
  const sorted = values.filter(known).sort((a, b) => a - b);
  return sorted[Math.floor(share * (sorted.length - 1))];
}
