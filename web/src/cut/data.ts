// SPDX-License-Identifier: Apache-2.0
// What the page of `cut` holds; steadyrest/trial/cut/report_data.hpp is its source.
import type { Head, Maybe } from '../frame/data';

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
  time_s: Maybe[];
  path_mm: Maybe[];
  x_mm: Maybe[];
  y_mm: Maybe[];
  z_mm: Maybe[];
  contour_error_um: Maybe[];
  tracking_error_um: Maybe[];
  override_percent: Maybe[];
  feed_mm_min: Maybe[];
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
  surface_error_um: Maybe;
  surface_range_um: Maybe;
}

export interface VibrationCourse {
  time_s: Maybe[];
  peak_um: Maybe[];
  unforced_um: Maybe[];
  speed_rpm: Maybe[];
}

export interface Run {
  figures: Figures;
  trace: Trace;
  reasons: ReasonTime[];
  /** Where the cut of a process was simulated. */
  vibration?: { figures: VibrationFigures; course: VibrationCourse };
}

/** Why a feed would hold the limit on a line. */
export type HeldBy =
  /** Radius and servo gain, in closed form. */
  | 'closed form'
  /** The error of the record, taken as growing with the square of the feed. */
  | 'record'
  /** The feed that was driven does. */
  | 'driven';

export interface WorstLine {
  line: number;
  text: string;
  without_um: Maybe;
  with_um: Maybe;
  /** Driven where the error was largest. */
  feed_without_mm_min: Maybe;
  feed_with_mm_min: Maybe;
  /** Of the path there; null: straight. */
  radius_mm: Maybe;
  /** Would hold the limit there; null: any feed does, or nothing is known. */
  hold_feed_mm_min: Maybe;
  held_by: HeldBy;
}

/** Estimates of one axis's motion against the truth, beside the backward difference of its counts. */
export interface MotionFigures {
  axis: string;
  velocity_rms_mm_s: number;
  acceleration_rms_mm_s2: number;
  difference_velocity_rms_mm_s: number;
  difference_acceleration_rms_mm_s2: number;
  /** null: there was no bound. */
  velocity_coverage_ratio: Maybe;
  acceleration_coverage_ratio: Maybe;
}

/** A reading of the probe, and what the thermal room made of it. */
export interface ProbeFigures {
  time_s: number;
  line: number;
  axis: string;
  displacement_um: Maybe;
  innovation_um: Maybe;
  band_um: Maybe;
  reason: string;
  sentence: string;
}

/** Something about the program that the machine will not do as it is written. */
export interface Warning {
  line: number;
  text: string;
}

export interface OverrideStep {
  code: number;
  percent: number;
}

export interface Report extends Head {
  program: string;
  machine: string;
  strategy: string;
  limit_um: number;
  override_table: OverrideStep[];
  without: Run;
  with: Run;
  /** The worst with the layer and the worst without it. */
  worst_lines: WorstLine[];
  motion: MotionFigures[];
  probes: ProbeFigures[];
  /** The first of them, and how many there are in all. */
  warnings?: Warning[];
  warning_count?: number;
}

export type RunName = 'without' | 'with';
export const RUNS: readonly RunName[] = ['without', 'with'];
