// SPDX-License-Identifier: Apache-2.0
// The figures and sentences of the page of `cut`, as text.
import { change, fixed, heldPercent, measure, percent, twoDigits, um } from '../frame/numbers';
import type { Figures, MotionFigures, VibrationFigures } from './data';

export function micrometres(mm: number): string {
  return um(mm * 1000);
}

export function seconds(s: number): string {
  return measure(s, 2, 's');
}

export function overLimitShare(figures: Figures): number {
  return figures.samples > 0 ? figures.samples_over_limit / figures.samples : 0;
}

export interface FigureRow {
  key: string;
  label: string;
  without: string;
  with: string;
  change: string;
}

/** The table of figures. */
export function figureRows(without: Figures, withLayer: Figures): FigureRow[] {
  const row = (
    key: string,
    label: string,
    value: (f: Figures) => number,
    show: (v: number) => string,
    compare = true,
  ): FigureRow => ({
    key,
    label,
    without: show(value(without)),
    with: show(value(withLayer)),
    change: compare ? change(value(without), value(withLayer)) : '',
  });
  const count = (n: number) => fixed(n, 0);
  return [
    row('contour_error_max_mm', 'Contour error, max', (f) => f.contour_error_max_mm, micrometres),
    row('contour_error_rms_mm', 'Contour error, RMS', (f) => f.contour_error_rms_mm, micrometres),
    row('over_limit_s', 'Time over limit', (f) => f.over_limit_s, seconds),
    row('over_limit_ratio', 'Samples over limit', overLimitShare, (share) => percent(share, 2)),
    row('tracking_error_max_mm', 'Tracking error, max', (f) => f.tracking_error_max_mm, micrometres),
    row('cycle_time_s', 'Cycle time', (f) => f.cycle_time_s, seconds),
    row('cutting_time_s', 'Cutting time', (f) => f.cutting_time_s, seconds),
    row('override_changes', 'Feed override changes', (f) => f.override_changes, count, false),
  ];
}

export interface MotionRow {
  axis: string;
  quantity: string;
  difference: string;
  estimate: string;
  finer: string;
  coverage: string;
}

const ROTARY = 'ABC';

/** The table of axis motion: velocity and acceleration of each axis. */
export function motionRows(motion: readonly MotionFigures[]): MotionRow[] {
  return motion.flatMap((m) => {
    const length = ROTARY.includes(m.axis) ? 'rad' : 'mm';
    const row = (quantity: string, unit: string, naive: number, ours: number, coverage: number | null): MotionRow => ({
      axis: m.axis,
      quantity,
      difference: `${twoDigits(naive)} ${length}/${unit}`,
      estimate: `${twoDigits(ours)} ${length}/${unit}`,
      // On an axis at rest the differences are exact: there is nothing to improve on.
      finer: ours > 0 && naive > 0 ? `${twoDigits(naive / ours)} ×` : '–',
      coverage: coverage === null ? 'no bound' : heldPercent(coverage),
    });
    return [
      row('velocity', 's', m.difference_velocity_rms_mm_s, m.velocity_rms_mm_s, m.velocity_coverage_ratio),
      row('acceleration', 's²', m.difference_acceleration_rms_mm_s2, m.acceleration_rms_mm_s2, m.acceleration_coverage_ratio),
    ];
  });
}

/** What the layer, or a change of the program, gained, in one sentence. */
export function verdict(without: Figures, withLayer: Figures, limit_um: number, how = 'With the layer'): string {
  if (without.samples === 0 && withLayer.samples === 0) {
    return 'The program does not cut, so there is nothing to compare.';
  }
  const before = without.contour_error_max_mm;
  const after = withLayer.contour_error_max_mm;
  const time = change(without.cycle_time_s, withLayer.cycle_time_s);
  const kept = after * 1000 <= limit_um;
  const limit = kept
    ? `stays within the ${um(limit_um)} limit`
    : `exceeds the ${um(limit_um)} limit for ${seconds(withLayer.over_limit_s)}`;
  const sameTime = time === '–' || time === '0.0\u00a0%';
  return (
    `${how}, the contour error peaks at ${micrometres(after)} instead of ${micrometres(before)} ` +
    `and ${limit}; the cycle takes ${seconds(withLayer.cycle_time_s)} instead of ` +
    `${seconds(without.cycle_time_s)}${sameTime ? '' : ` (${time})`}.`
  );
}

/** What became of the tool's vibration, in one sentence; empty if the machine cut air. */
export function vibrationVerdict(without: VibrationFigures | undefined, withLayer: VibrationFigures | undefined): string {
  if (!without || !withLayer) {
    return '';
  }
  return `The tool vibrates by up to ${um(withLayer.vibration_peak_um)} instead of ${um(without.vibration_peak_um)}.`;
}

/** The table of vibration figures. */
export function vibrationRows(without: VibrationFigures, withLayer: VibrationFigures): FigureRow[] {
  const row = (key: keyof VibrationFigures, label: string, unit: string, decimals: number): FigureRow => {
    const [a, b] = [without[key], withLayer[key]];
    const show = (v: number | null) => measure(v, decimals, unit);
    return { key, label, without: show(a), with: show(b), change: a === null || b === null ? '–' : change(a, b) };
  };
  // A tool that is rigid across the feed does not move the wall.
  const moved = [without, withLayer].some((v) => v.surface_range_um !== null && v.surface_range_um > 0);
  return [
    row('unforced_rms_um', 'Chatter (vibration that does not repeat), RMS', 'µm', 2),
    row('vibration_rms_um', 'Vibration, RMS', 'µm', 1),
    row('vibration_peak_um', 'Peak displacement', 'µm', 1),
    ...(moved ? [row('surface_range_um', 'Finished wall, peak to valley', 'µm', 1), row('surface_error_um', 'Finished wall, mean offset', 'µm', 1)] : []),
    row('chip_peak_um', 'Thickest chip', 'µm', 0),
    row('force_peak_n', 'Peak force on the tool', 'N', 1),
    row('power_peak_w', 'Peak spindle power', 'W', 0),
  ];
}
