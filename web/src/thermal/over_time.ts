// SPDX-License-Identifier: Apache-2.0
// What forecast and plan draw over the minutes of the job.
import type { Maybe } from '../frame/data';
import type { Theme } from '../frame/theme';
import { type Layer, rules } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { spindlePlot } from '../plot/speed';
import { bandEdges, bandLayer } from './band';
import type { Course, Transition } from './data';

const end = (transitions: readonly Transition[]) => Math.max(...transitions.map((t) => t.start_min + t.minutes));

export const jobTime = (transitions: readonly Transition[]) => ({ name: 'time in min', min: 0, max: end(transitions) });

/** An upright line where each transition starts. */
export function starts(transitions: readonly Transition[], theme: Theme): Layer {
  return rules('x', transitions.slice(1).map((t) => t.start_min), theme.rapid, true);
}

/** A passport without covariance states none. */
export const statesUncertainty = (course: Course) => course.sd_um.some((v) => (v ?? 0) > 0);

/** Nothing if no uncertainty is stated. */
export function forecastBand(course: Course, colour: string): Layer[] {
  return statesUncertainty(course) ? [bandLayer('95 % band of the forecast', course.t_min, course.displacement_um, course.sd_um, colour)] : [];
}

/** All that an axis must have room for. */
export function withBand(course: Course): Maybe[] {
  return bandEdges(course.displacement_um, course.sd_um).flat();
}

export function cyclogramPlot(transitions: readonly Transition[], theme: Theme): Plot {
  return spindlePlot({
    title: 'Cyclogram: spindle speed',
    x: jobTime(transitions),
    group: 'time',
    t: transitions.flatMap((t) => [t.start_min, t.start_min + t.minutes]),
    rpm: transitions.flatMap((t) => [Math.abs(t.speed_rpm), Math.abs(t.speed_rpm)]),
    colour: theme.faint,
    withZero: true,
    beneath: [starts(transitions, theme)],
  });
}
