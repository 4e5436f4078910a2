// SPDX-License-Identifier: Apache-2.0
import type { Maybe } from '../frame/data';
import { type Axis, axisFor } from './axes';
import type { Plot } from './drawn';
import type { Layer } from './layers';

interface Speed {
  /** Shared with the plots above it. */
  x: Axis;
  group: string;
  t: readonly Maybe[];
  rpm: readonly Maybe[];
  colour: string;
  /** The axis starts at 0. */
  withZero?: boolean;
  beneath?: readonly Layer[];
  title?: string;
}

/** The spindle speed, drawn under the plots of what it causes. */
export function spindlePlot({ x, group, t, rpm, colour, withZero = false, beneath = [], title = 'Spindle speed' }: Speed): Plot {
  return {
    title,
    x,
    y: axisFor('spindle speed in rpm', rpm, withZero),
    group,
    layers: [...beneath, { kind: 'line', name: 'spindle speed', x: t, y: rpm, colour, width: 2 }],
  };
}
