// SPDX-License-Identifier: Apache-2.0
// What report.json holds; steadyrest/apps/report/report_data.hpp is its source.

export interface Figures {
  cycle_time_s: number;
  cutting_time_s: number;
  contour_error_max_mm: number;
  contour_error_rms_mm: number;
  tracking_error_max_mm: number;
  over_limit_s: number;
  samples: number;
  samples_over_limit: number;
  override_changes: number;
}

/** One value per sample, all columns equally long; null where the value was not finite. */
export interface Trace {
  time_s: (number | null)[];
  path_mm: (number | null)[];
  x_mm: (number | null)[];
  y_mm: (number | null)[];
  z_mm: (number | null)[];
  contour_error_um: (number | null)[];
  tracking_error_um: (number | null)[];
  override_percent: (number | null)[];
  feed_mm_min: (number | null)[];
  line: number[];
  cutting: number[];
}

export interface ReasonTime {
  reason: string;
  sentence: string;
  seconds: number;
}

/** Of a tool that vibrates in the cut. */
export interface VibrationFigures {
  vibration_rms_um: number;
  vibration_peak_um: number;
  unforced_rms_um: number;
  force_peak_n: number;
  power_peak_w: number;
  chip_peak_um: number;
  surface_error_um: number | null;
  surface_range_um: number | null;
}

export interface VibrationCourse {
  time_s: (number | null)[];
  peak_um: (number | null)[];
  unforced_um: (number | null)[];
  speed_rpm: (number | null)[];
}

export interface Run {
  figures: Figures;
  trace: Trace;
  reasons: ReasonTime[];
  /** Where the cut of a process was simulated. */
  vibration?: { figures: VibrationFigures; course: VibrationCourse };
}

export interface WorstLine {
  line: number;
  text: string;
  without_um: number | null;
  with_um: number | null;
}

/** Estimates of one axis's motion against the truth, beside the backward difference of its counts. */
export interface MotionFigures {
  axis: string;
  velocity_rms_mm_s: number;
  acceleration_rms_mm_s2: number;
  difference_velocity_rms_mm_s: number;
  difference_acceleration_rms_mm_s2: number;
  /** null: there was no bound. */
  velocity_coverage_ratio: number | null;
  acceleration_coverage_ratio: number | null;
}

/** A reading of the probe, and what the thermal room made of it. */
export interface ProbeFigures {
  time_s: number;
  line: number;
  axis: string;
  displacement_um: number | null;
  innovation_um: number | null;
  band_um: number | null;
  reason: string;
  sentence: string;
}

export interface OverrideStep {
  code: number;
  percent: number;
}

export interface Report {
  schema: string;
  version: string;
  program: string;
  machine: string;
  strategy: string;
  limit_um: number;
  override_table: OverrideStep[];
  without: Run;
  with: Run;
  worst_lines: WorstLine[];
  motion: MotionFigures[];
  probes: ProbeFigures[];
}

export type RunName = 'without' | 'with';
export const RUNS: readonly RunName[] = ['without', 'with'];

const SCHEMA = 'steadyrest-report/1';

/** The report in the page's data element, or a sentence that says why there is none. */
export function parseReport(text: string): Report | string {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return 'The data in this page is not valid JSON; write the report again.';
  }
  if (typeof value !== 'object' || value === null) {
    return 'This page holds no data yet; `steadyrest cut … --report DIR` fills it.';
  }
  const report = value as Report;
  if (report.schema !== SCHEMA) {
    return `This page reads ${SCHEMA}; its data is ${String(report.schema)}.`;
  }
  return report;
}
