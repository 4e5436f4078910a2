// SPDX-License-Identifier: Apache-2.0
// What the pages of the motion verbs hold. Their source is steadyrest/apps/page/motion.
import type { Head, Maybe } from '../frame/data';

/** The lowest and highest value and the widest bound of each stretch of ticks; null: none. */
export interface Course {
  low: Maybe[];
  high: Maybe[];
  bound: Maybe[];
}

export interface EstimatePage extends Head {
  kind: 'estimate';
  log: string;
  count_mm: number;
  answer: {
    estimator: string;
    ticks: number;
    edges: number;
    rows: number;
    clock_s: number;
    lag_s: number;
    jumps: number;
    /** How many findings, including those left out of `findings`. */
    reports: number;
    findings: { line: number; what: string; to_do: string }[];
    /** The log was read to its end. */
    complete: boolean;
    /** If the log is of cycles. */
    cycle: { mean_s: number; jitter_rms_s: number; missed_cycles: number; gaps: number } | null;
  };
  /** Ticks in one stretch. */
  ticks_each: number;
  t_s: number[];
  position_mm: Course;
  velocity_mm_s: Course;
  acceleration_mm_s2: Course;
}

/** Of one estimator in one scene. */
export interface Figures {
  rms: Maybe;
  max: Maybe;
  own_lag_s: Maybe;
  rms_at_own_lag: Maybe;
  gain: Maybe;
  coverage: Maybe;
  bound_ratio: Maybe;
  efficiency: Maybe;
  target: Maybe;
  rms_at_lag: Maybe[];
}

export interface Row {
  scene: string;
  estimator: string;
  limits: boolean;
  ticks: number;
  velocity: Figures;
  acceleration: Figures;
  contradictions: number;
  ns_per_tick: Maybe;
  ns_per_edge: Maybe;
}

export type Verdict = 'met' | 'forbidden' | 'missed';

export interface Requirement {
  speed_mm_s: number;
  clock_s: number;
  line_error_counts: number;
  jerk_mm_s3: number;
  cycle_hz: number;
  acceleration: boolean;
  fine: boolean;
  required: number;
  guaranteed_floor: Maybe;
  bound: Maybe;
  guaranteed: Verdict;
  optimum: Maybe;
  rms: Maybe;
  typical: Verdict;
}

export interface Trace {
  name: string;
  t_s: Maybe[];
  true_velocity_mm_s: Maybe[];
  true_acceleration_mm_s2: Maybe[];
  difference_velocity_mm_s: Maybe[];
  difference_acceleration_mm_s2: Maybe[];
  velocity_mm_s: Maybe[];
  velocity_bound_mm_s: Maybe[];
  acceleration_mm_s2: Maybe[];
  acceleration_bound_mm_s2: Maybe[];
}

export interface Curve {
  name: string;
  x: Maybe[];
  y: Maybe[];
}

export interface Bench extends Head {
  lags_s: number[];
  scenes: { name: string; what: string }[];
  rows: Row[];
  notes: string[];
  requirement: Requirement[];
  traces: Trace[];
  figure_3a: Curve[];
  figure_3b: Curve[];
  figure_5: Curve[];
}

export function scenes(bench: Bench): string[] {
  return [...new Set(bench.rows.map((r) => r.scene))];
}

export function label(row: Row): string {
  return row.limits ? `${row.estimator} + limits` : row.estimator;
}
