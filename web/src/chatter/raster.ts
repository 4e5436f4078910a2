// SPDX-License-Identifier: Apache-2.0
// A quantity over two axes as a canvas that a plot stretches over its box.
import type { Maybe } from '../frame/data';
import { fixed } from '../frame/numbers';
import type { Scheme } from '../frame/theme';
import { niceStep } from '../plot/axes';
import type { ColourScale } from '../plot/key';
import { lowerBound } from '../plot/thin';
import { quantile } from '../plot/values';

export interface Level {
  from: number;
  to: number;
  colour: string;
}

// From the border outwards.
const STABLE: Record<Scheme, string[]> = {
  light: ['#eef5fa', '#d3e6f2', '#b0d2e7', '#86b9d8', '#5a9cc6'],
  dark: ['#1b2833', '#1e3a50', '#22506f', '#28668e', '#317eae'],
};
const UNSTABLE: Record<Scheme, string[]> = {
  light: ['#fdeede', '#fad7b4', '#f5b27c', '#e98a4d', '#d2622c'],
  dark: ['#33261d', '#553521', '#7a4626', '#a35a2b', '#cc7031'],
};
const GROWING = [1, 1.1, 1.25, 1.5, 2];
/** This share of the points is within the even steps. */
const MOST = 0.9;
const DYING = [1, 0.9, 0.8, 0.65, 0.5];

/** Classes of ln ρ on both sides of the border: steps of ρ if `perPass`, otherwise even steps of ln ρ. */
export function radiusLevels(logs: readonly Maybe[], perPass: boolean, scheme: Scheme): Level[] {
  const reach = Math.max(quantile(logs.map((v) => (v === null ? null : Math.abs(v))), MOST) ?? 0, 0.1);
  const step = niceStep(reach, 5);
  const even = GROWING.map((_, i) => i * step);
  const up = perPass ? GROWING.map(Math.log) : even;
  const down = perPass ? DYING.map(Math.log) : even.map((v) => -v);
  const stable = STABLE[scheme].map((colour, i) => ({ from: down[i + 1] ?? -Infinity, to: down[i] ?? 0, colour })).reverse();
  return [...stable, ...UNSTABLE[scheme].map((colour, i) => ({ from: up[i] ?? 0, to: up[i + 1] ?? Infinity, colour }))];
}

function bytes(colour: string): number[] {
  return [1, 3, 5].map((i) => Number.parseInt(colour.slice(i, i + 2), 16));
}

function paint(width: number, height: number, colourAt: (column: number, row: number) => readonly number[]): HTMLCanvasElement {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  const context = canvas.getContext('2d');
  const image = context?.createImageData(width, height);
  if (!context || !image) {
    return canvas;
  }
  for (let row = 0; row < height; ++row) {
    for (let column = 0; column < width; ++column) {
      const [r = 0, g = 0, b = 0] = colourAt(column, row);
      image.data.set([r, g, b, 255], 4 * (row * width + column));
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

/** Index of the interval around x, and how far along it x is. */
function place(grid: readonly number[], x: number): [number, number] {
  let low = 0;
  let high = grid.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((grid[middle] ?? 0) <= x) low = middle;
    else high = middle;
  }
  const [a = 0, b = 0] = [grid[low], grid[low + 1]];
  return [low, b > a ? Math.min(Math.max((x - a) / (b - a), 0), 1) : 0];
}

export interface Grid {
  x: readonly number[];
  y: readonly number[];
  /** [x·(count of y) + y] */
  value: readonly Maybe[];
}

/** Interpolated between the grid's points. */
export function valueAt(grid: Grid, x: number, y: number): number {
  const [i, u] = place(grid.x, x);
  const [j, v] = place(grid.y, y);
  const at = (a: number, b: number) =>
    grid.value[Math.min(a, grid.x.length - 1) * grid.y.length + Math.min(b, grid.y.length - 1)] ?? -Infinity;
  const mix = (a: number, b: number, share: number) => (share === 0 ? a : a + (b - a) * share);
  return mix(mix(at(i, j), at(i, j + 1), v), mix(at(i + 1, j), at(i + 1, j + 1), v), u);
}

/** The lowest depth at which ρ is 1, at points of rising speed; null: none. */
export interface Border {
  x: readonly Maybe[];
  y: readonly Maybe[];
}

/** The border at x, interpolated; undefined: not known there. */
export function borderAt(border: Border, x: number): number | undefined {
  const at = lowerBound(border.x, x);
  const [x1, y1] = [border.x[at], border.y[at]];
  const [x0, y0] = [border.x[at - 1], border.y[at - 1]];
  if (x1 === x) return y1 ?? undefined;
  if (x0 == null || x1 == null || y0 == null || y1 == null) return undefined;
  return y0 + ((y1 - y0) * (x - x0)) / (x1 - x0);
}

/** Is a point of the grid next to (x, y) stable above the border? Then islands of stability are near. */
function stableAbove(grid: Grid, border: Border, x: number, y: number): boolean {
  const [i] = place(grid.x, x);
  const [j] = place(grid.y, y);
  return [i, i + 1].some((a) =>
    [j, j + 1].some((b) => {
      const [gx, gy] = [grid.x[a], grid.y[b]];
      const limit = gx === undefined ? undefined : borderAt(border, gx);
      return gx !== undefined && gy !== undefined && limit !== undefined && gy > limit && (grid.value[a * grid.y.length + b] ?? 0) < 0;
    }),
  );
}

/** The border is known better than the grid: near it, it decides the sign. */
export function valueBeside(grid: Grid, border: Border, x: number, y: number): number {
  const value = valueAt(grid, x, y);
  const limit = borderAt(border, x);
  if (limit === undefined) return value;
  if (y <= limit) return Math.min(value, -Number.MIN_VALUE);
  return value > 0 || stableAbove(grid, border, x, y) ? value : Number.MIN_VALUE;
}

const MAP_WIDTH = 1100;
const MAP_HEIGHT = 560;

/** The grid in the colours of its classes, with sharp edges between them. */
export function classRaster(grid: Grid, levels: readonly Level[], border: Border): HTMLCanvasElement {
  const colours = levels.map((l) => bytes(l.colour));
  const [x0 = 0, x1 = 0, y0 = 0, y1 = 0] = [grid.x[0], grid.x.at(-1), grid.y[0], grid.y.at(-1)];
  return paint(MAP_WIDTH, MAP_HEIGHT, (column, row) => {
    const value = valueBeside(grid, border, x0 + ((x1 - x0) * (column + 0.5)) / MAP_WIDTH, y1 - ((y1 - y0) * (row + 0.5)) / MAP_HEIGHT);
    const index = levels.findIndex((l) => value <= l.to);
    return colours[index < 0 ? colours.length - 1 : index] ?? [];
  });
}

// Paper for noise, dark for loud.
const LOUDNESS: Record<Scheme, string[]> = {
  light: ['#ffffff', '#dbeaf4', '#9cc7e0', '#4f97c7', '#1d5f9c', '#0a2f5c'],
  dark: ['#14181d', '#16293a', '#1d4a6d', '#2d7bb0', '#7cbde6', '#f0f8ff'],
};

/** A colour mixed from the two stops around it; share 0 … 1. */
function between(stops: readonly number[][], share: number): number[] {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  return (stops[i] ?? []).map((c, k) => c + (at - i) * ((stops[i + 1]?.[k] ?? c) - c));
}

/** This share of the cells is shown as paper. */
const QUIET_SHARE = 0.35;
const LEAST_RANGE_DB = 30;

/** The level below which a cell is paper, dB. */
export function quietLevel(levels_db: readonly number[]): number {
  return Math.min(-LEAST_RANGE_DB, quantile(levels_db, QUIET_SHARE) ?? -LEAST_RANGE_DB);
}

/** Cell by cell, `low` … 0 dB; null is paper. */
export function loudnessRaster(levels_db: readonly Maybe[], columns: number, rows: number, low: number, scheme: Scheme): HTMLCanvasElement {
  const stops = LOUDNESS[scheme].map(bytes);
  return paint(columns, rows, (column, row) => between(stops, 1 - (levels_db[column * rows + (rows - 1 - row)] ?? low) / low));
}

/** The same colours with their levels. */
export function loudnessScale(low_db: number, scheme: Scheme): ColourScale {
  const stops = LOUDNESS[scheme];
  return {
    title: 'Power relative to the strongest cell, dB',
    cells: stops.map((colour, i) => ({ colour, upTo: fixed((low_db * (stops.length - 1 - i)) / (stops.length - 1), 0) })),
  };
}
