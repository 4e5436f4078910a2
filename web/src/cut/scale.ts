// SPDX-License-Identifier: Apache-2.0
// The one colour scale of both paths: classes of |contour error|, the limit always a border.
import type { Scheme } from '../frame/theme';
import { niceAbove } from '../plot/axes';

export interface ErrorClass {
  from_um: number;
  to_um: number;
  colour: string;
  over: boolean;
}

const WITHIN = {
  light: ['#9ecbe0', '#57a5cf', '#2678b2', '#0b4a86'],
  dark: ['#2a5f8f', '#3e86bd', '#6db1dc', '#b5dcf2'],
};
const OVER = {
  light: ['#f2a33c', '#e8772e', '#d0472a', '#a31f2b', '#6b0f2a'],
  dark: ['#f7c46c', '#f79a4b', '#f2703f', '#e5484d', '#ff8fa3'],
};

/** Four classes within the limit; above it as many as the largest error needs. */
export function errorClasses(limit_um: number, largest_um: number, scheme: Scheme): ErrorClass[] {
  const limit = limit_um > 0 ? limit_um : niceAbove(largest_um);
  const classes: ErrorClass[] = WITHIN[scheme].map((colour, i) => ({
    from_um: (limit * i) / 4,
    to_um: (limit * (i + 1)) / 4,
    colour,
    over: false,
  }));
  if (largest_um <= limit) {
    return classes;
  }
  const top = Math.max(niceAbove(largest_um), limit * 1.25);
  const colours = OVER[scheme];
  // By ratio, so that 1.2 times the limit and nine times the limit look different.
  const ratio = (top / limit) ** (1 / colours.length);
  colours.forEach((colour, i) => {
    classes.push({
      from_um: limit * ratio ** i,
      to_um: i === colours.length - 1 ? top : limit * ratio ** (i + 1),
      colour,
      over: true,
    });
  });
  return classes;
}

/** Index of the class of |error|; the last takes all above it. */
export function classOf(classes: readonly ErrorClass[], error_um: number): number {
  const size = Math.abs(error_um);
  const index = classes.findIndex((c) => size <= c.to_um);
  return index < 0 ? classes.length - 1 : index;
}
