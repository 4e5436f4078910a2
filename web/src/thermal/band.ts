// SPDX-License-Identifier: Apache-2.0
import type { Maybe } from '../frame/data';
import type { Layer } from '../plot/layers';
import { plus } from '../plot/values';

/** 95 % of the readings lie within this many standard deviations. */
export const BAND = 1.96;

/** The lower and the upper edge of the 95 % band about the values. */
export function bandEdges(values: readonly Maybe[], sd: readonly Maybe[]): [Maybe[], Maybe[]] {
  const stated = sd.map((v) => v ?? 0);
  return [plus(values, stated, -BAND), plus(values, stated, BAND)];
}

export function bandLayer(name: string, x: readonly Maybe[], values: readonly Maybe[], sd: readonly Maybe[], colour: string): Layer {
  const [low, high] = bandEdges(values, sd);
  return { kind: 'band', name, x, low, high, colour, opacity: 0.18 };
}
