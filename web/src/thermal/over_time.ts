// SPDX-License-Identifier: Apache-2.0
// What forecast, plan and batch draw over the minutes of the work.
import type { Maybe } from '../frame/data';
import { fixed } from '../frame/numbers';
import type { Theme } from '../frame/theme';
import { roomy } from '../plot/axes';
import type { Layer } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { BAND } from './course';
import type { Course, Transition } from './data';

export const rule = (at: readonly number[], axis: 'x' | 'y', colour: string, dashed = false): Layer => ({ kind: 'rules', at, axis, colour, dashed });
export const um = (value: Maybe | undefined) => `${fixed(value ?? 0, 1)} µm`;

export const borders = (transitions: readonly Transition[]) => transitions.slice(1).map((t) => t.start_min);
export const end = (transitions: readonly Transition[]) => Math.max(...transitions.map((t) => t.start_min + t.minutes));

/** A passport without covariance states none. */
export const statesUncertainty = (course: Course) => course.sd_um.some((v) => (v ?? 0) > 0);

/** Nothing where no uncertainty is stated. */
export function band(course: Course, colour: string): Layer[] {
  if (!statesUncertainty(course)) {
    return [];
  }
  const at = (sign: number) => course.displacement_um.map((v, i) => (v === null ? null : v + sign * BAND * (course.sd_um[i] ?? 0)));
  return [{ kind: 'band', name: 'the 95 % band of the forecast', x: course.t_min, low: at(-1), high: at(1), colour, opacity: 0.18 }];
}

export function withBand(course: Course): Maybe[] {
  return course.displacement_um.flatMap((v, i) => [(v ?? 0) - BAND * (course.sd_um[i] ?? 0), (v ?? 0) + BAND * (course.sd_um[i] ?? 0)]);
}

/** Where it is largest. */
export function largest(values: readonly Maybe[]): number {
  return values.reduce<number>((most, v, i) => (Math.abs(v ?? 0) > Math.abs(values[most] ?? 0) ? i : most), 0);
}

export function cyclogramPlot(transitions: readonly Transition[], theme: Theme): Plot {
  const x = transitions.flatMap((t) => [t.start_min, t.start_min + t.minutes]);
  const y = transitions.flatMap((t) => [Math.abs(t.speed_rpm), Math.abs(t.speed_rpm)]);
  const [min, max] = roomy(y, true);
  return {
    title: 'Cyclogram: spindle speed',
    x: { name: 'time in min', min: 0, max: end(transitions) },
    y: { name: 'spindle speed in rev/min', min, max },
    group: 'time',
    layers: [rule(borders(transitions), 'x', theme.rapid, true), { kind: 'line', name: 'spindle speed', x, y, colour: theme.faint, width: 2 }],
  };
}
