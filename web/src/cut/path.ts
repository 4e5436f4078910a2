// SPDX-License-Identifier: Apache-2.0
import { type Box } from '../plot/equal_aspect';
import type { Trace } from './data';

/** Class of rapids and of samples without a finite value. */
export const NOT_CUTTING = -1;

export type Plane = 'xy' | 'xz' | 'yz';

const COLUMNS = {
  xy: ['x_mm', 'y_mm'],
  xz: ['x_mm', 'z_mm'],
  yz: ['y_mm', 'z_mm'],
} as const;

export function columns(trace: Trace, plane: Plane): [(number | null)[], (number | null)[]] {
  const [h, v] = COLUMNS[plane];
  return [trace[h], trace[v]];
}

/** The box around all cutting moves of the traces, or around everything if nothing is cut. */
export function boundingBox(traces: readonly Trace[], plane: Plane): Box | undefined {
  const box = { left: Infinity, right: -Infinity, bottom: Infinity, top: -Infinity };
  for (const onlyCut of [true, false]) {
    for (const trace of traces) {
      const [h, v] = columns(trace, plane);
      for (let i = 0; i < h.length; ++i) {
        const x = h[i];
        const y = v[i];
        if (x == null || y == null || (onlyCut && trace.cutting[i] !== 1)) {
          continue;
        }
        box.left = Math.min(box.left, x);
        box.right = Math.max(box.right, x);
        box.bottom = Math.min(box.bottom, y);
        box.top = Math.max(box.top, y);
      }
    }
    if (box.left <= box.right) {
      return box;
    }
  }
  return undefined;
}

export interface Polylines {
  /** Null between one polyline and the next. */
  x: (number | null)[];
  y: (number | null)[];
}

/**
 * The path as polylines, grouped by class. A stretch between two samples takes the worse of both
 * classes, so a single bad sample is always drawn. Points nearer than `smallest_mm` are merged.
 */
export function polylinesByClass(
  h: readonly (number | null)[],
  v: readonly (number | null)[],
  classes: readonly number[],
  smallest_mm = 0,
): Map<number, Polylines> {
  const out = new Map<number, Polylines>();
  let current: { cls: number; lines: Polylines } | undefined;
  let last = { x: 0, y: 0 };
  let previous = -1;
  const begin = (cls: number, from: number) => {
    const lines = out.get(cls) ?? { x: [], y: [] };
    out.set(cls, lines);
    if (lines.x.length > 0) {
      lines.x.push(null);
      lines.y.push(null);
    }
    lines.x.push(h[from] as number);
    lines.y.push(v[from] as number);
    current = { cls, lines };
    return lines;
  };
  for (let i = 0; i < h.length; ++i) {
    const x = h[i];
    const y = v[i];
    if (x == null || y == null) {
      current = undefined;
      previous = -1;
      continue;
    }
    if (previous >= 0) {
      const a = classes[previous] ?? NOT_CUTTING;
      const b = classes[i] ?? NOT_CUTTING;
      const cls = a === NOT_CUTTING || b === NOT_CUTTING ? NOT_CUTTING : Math.max(a, b);
      const goesOn: Polylines | undefined = current?.cls === cls ? current.lines : undefined;
      const lines = goesOn ?? begin(cls, previous);
      if (goesOn && Math.abs(x - last.x) < smallest_mm && Math.abs(y - last.y) < smallest_mm) {
        // Too short to see: the last point moves on instead.
        lines.x[lines.x.length - 1] = x;
        lines.y[lines.y.length - 1] = y;
      } else {
        lines.x.push(x);
        lines.y.push(y);
        last = { x, y };
      }
    }
    previous = i;
  }
  return out;
}

/** Finds the sample nearest to a point of the view; a grid keeps it quick. */
export class NearestSample {
  private readonly cells = new Map<number, number[]>();
  private readonly cell_mm: number;
  private readonly box: Box | undefined;
  private readonly columns = 4096;

  constructor(
    private readonly trace: Trace,
    private readonly plane: Plane,
  ) {
    this.box = boundingBox([trace], plane);
    const box = this.box;
    this.cell_mm = box
      ? Math.max((box.right - box.left) / 200, (box.top - box.bottom) / 200, 1e-6)
      : 1;
    const [h, v] = columns(trace, plane);
    for (let i = 0; i < h.length; ++i) {
      const x = h[i];
      const y = v[i];
      if (x == null || y == null || trace.cutting[i] !== 1) {
        continue;
      }
      const key = this.key(this.column(x), this.row(y));
      const list = this.cells.get(key);
      if (list) {
        list.push(i);
      } else {
        this.cells.set(key, [i]);
      }
    }
  }

  /** Index of the nearest sample within `reach_mm`; of samples about equally near, the worst. */
  find(x: number, y: number, reach_mm: number): number | undefined {
    if (!this.box) {
      return undefined;
    }
    const [h, v] = columns(this.trace, this.plane);
    const reach = Math.min(Math.ceil(reach_mm / this.cell_mm), 8);
    let best: number | undefined;
    let bestDistance = reach_mm;
    for (let cx = this.column(x) - reach; cx <= this.column(x) + reach; ++cx) {
      for (let cy = this.row(y) - reach; cy <= this.row(y) + reach; ++cy) {
        for (const i of this.cells.get(this.key(cx, cy)) ?? []) {
          const distance = Math.hypot((h[i] as number) - x, (v[i] as number) - y);
          const tie = Math.abs(distance - bestDistance) < reach_mm / 20;
          if (distance < bestDistance - reach_mm / 20 || (tie && this.worse(i, best))) {
            best = i;
            bestDistance = Math.min(distance, bestDistance);
          }
        }
      }
    }
    return best;
  }

  private worse(i: number, best: number | undefined): boolean {
    const error = (k: number) => Math.abs(this.trace.contour_error_um[k] ?? 0);
    return best === undefined || error(i) > error(best);
  }

  private column(x: number): number {
    return Math.floor((x - (this.box?.left ?? 0)) / this.cell_mm);
  }

  private row(y: number): number {
    return Math.floor((y - (this.box?.bottom ?? 0)) / this.cell_mm);
  }

  private key(column: number, row: number): number {
    return row * this.columns + column;
  }
}
