// SPDX-License-Identifier: Apache-2.0
// What the page of `cut` holds. Its source is steadyrest/trial/cut/report_data.hpp.
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

/** How a tool vibrates in the cut. */
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
  /** If the cutting process was simulated. */
  vibration?: { figures: VibrationFigures; course: VibrationCourse };
}

/** How it is known which feed holds the limit on a line. */
export type HeldBy =
  /** From radius and servo gain. */
  | 'closed form'
  /** From the recorded error, which grows with the square of the feed. */
  | 'record'
  /** The actual feed held it. */
  | 'driven';

export interface WorstLine {
  line: number;
  text: string;
  without_um: Maybe;
  with_um: Maybe;
  /** Actual feed where the error was largest. */
  feed_without_mm_min: Maybe;
  feed_with_mm_min: Maybe;
  /** Of the path there; null: straight. */
  radius_mm: Maybe;
  /** The feed that holds the limit there; null: any feed does, or nothing is known. */
  hold_feed_mm_min: Maybe;
  held_by: HeldBy;
}

/** RMS errors of one axis's motion: estimated, and by the backward difference of its counts. */
export interface MotionFigures {
  axis: string;
  velocity_rms_mm_s: number;
  acceleration_rms_mm_s2: number;
  difference_velocity_rms_mm_s: number;
  difference_acceleration_rms_mm_s2: number;
  /** null: no bound was given. */
  velocity_coverage_ratio: Maybe;
  acceleration_coverage_ratio: Maybe;
}

/** A probe reading, and what the thermal room made of it. */
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

/** Something in the program that the machine will not do as written. */
export interface Warning {
  line: number;
  text: string;
}

export interface OverrideStep {
  code: number;
  percent: number;
}

/** A way to cut the part; `changed…`: by the changed program, the others by its original or the only program. */
export type WayName = 'alone' | 'setting' | 'text' | 'text_held' | 'text_feeds' | 'feed_override' | 'path_offsets' | 'changed' | 'changed_feed_override' | 'changed_path_offsets';

export interface WayFigures extends Figures {
  way: WayName;
  /** The command or the setting that gives it. */
  get?: string;
}

/** The best of the ways; null where nothing is better. */
export interface BestWays {
  /** In the program's own time. */
  same_time: WayFigures | null;
  any_time: WayFigures | null;
  /** The cheapest cure: a setting of the control. */
  setting: WayFigures | null;
}

/** A line that stays over the limit in the best way of the same time. */
export interface OverLimitLine {
  line: number;
  error_um: number;
  reason: string;
  /** With its price; null: none was found. */
  cure: string | null;
}

/** The feed override alone, told to keep another limit. */
export interface CurvePoint extends Figures {
  limit_um: number;
}

export interface Report extends Head {
  program: string;
  machine: string;
  strategy: string;
  limit_um: number;
  override_table: OverrideStep[];
  without: Run;
  with: Run;
  /** Those with the layer and those without it. */
  worst_lines: WorstLine[];
  motion: MotionFigures[];
  probes: ProbeFigures[];
  /** The original of a changed program, by whose path errors are judged. */
  against?: string;
  /** Empty if they were not compared. */
  ways: WayFigures[];
  /** By rising limit; empty if not asked for. */
  curve: CurvePoint[];
  /** Only where the plain question was asked: what is the best that this part can be? */
  best?: BestWays;
  over_limit?: OverLimitLine[];
  /** The cut in the best way of the same time. */
  best_run?: Run;
  /** The first few, and how many there are in all. */
  warnings?: Warning[];
  warning_count?: number;
}

export type RunName = 'without' | 'with';
export const RUNS: readonly RunName[] = ['without', 'with'];
