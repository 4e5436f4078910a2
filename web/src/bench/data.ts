// SPDX-License-Identifier: Apache-2.0
// What the page of `motion bench` holds; steadyrest/apps/motion_bench/bench_json.cpp is its source.

import type { Head, Maybe } from '../frame/data';

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
