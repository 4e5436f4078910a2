// SPDX-License-Identifier: Apache-2.0

/** Stretches of x; a curve keeps its lowest and highest value in each. */
export const BUCKETS = 1500;

export type Point = [number, number | null];

/**
 * At most 2·buckets + 2 of the points between `from` and `to`, chosen so that no extreme is lost: of
 * each bucket the lowest and the highest value, in order. Gaps (null) stay gaps.
 */
export function thin(
  x: readonly (number | null)[],
  y: readonly (number | null)[],
  from: number,
  to: number,
  buckets: number,
): Point[] {
  const first = Math.max(lowerBound(x, from) - 1, 0);
  const end = Math.min(lowerBound(x, to) + 1, x.length);
  const points: Point[] = [];
  if (end - first <= 2 * buckets) {
    for (let i = first; i < end; ++i) {
      push(points, x[i], y[i] ?? null);
    }
    return points;
  }
  const size = (end - first) / buckets;
  for (let b = 0; b < buckets; ++b) {
    const start = first + Math.floor(b * size);
    const stop = first + Math.floor((b + 1) * size);
    let low = -1;
    let high = -1;
    let gap = -1;
    for (let i = start; i < stop; ++i) {
      const value = y[i];
      if (value == null) {
        gap = i;
        continue;
      }
      if (low < 0 || value < (y[low] as number)) low = i;
      if (high < 0 || value > (y[high] as number)) high = i;
    }
    const chosen = [...new Set([low, high, gap])].filter((i) => i >= 0).sort((a, c) => a - c);
    for (const i of chosen) {
      push(points, x[i], y[i] ?? null);
    }
  }
  return points;
}

function push(points: Point[], x: number | null | undefined, y: number | null): void {
  if (x != null) {
    points.push([x, y]);
  }
}

/** First index whose value is not below `limit`; x must not decrease. */
export function lowerBound(x: readonly (number | null)[], limit: number): number {
  let low = 0;
  let high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((x[middle] ?? -Infinity) < limit) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/** Index of the value nearest to `at`; −1 beyond the end. x must not decrease. */
export function nearestIndex(x: readonly (number | null)[], at: number): number {
  const last = x.length - 1;
  if (last < 0 || at > (x[last] ?? Infinity)) {
    return -1;
  }
  const above = Math.min(lowerBound(x, at), last);
  const distance = (i: number) => Math.abs((x[i] ?? Infinity) - at);
  return above > 0 && distance(above - 1) < distance(above) ? above - 1 : above;
}
