// SPDX-License-Identifier: Apache-2.0
// The JSON of the HTTP interface and of the stream.
import type { Maybe } from '../../frame/data';

export type Role = 'viewer' | 'operator' | 'engineer';
export type Mode = 'observe' | 'advise' | 'act';

export interface Session {
  name: string;
  role: Role;
  csrf: string;
}
export interface SessionAnswer {
  session: Session | null;
  accounts: boolean;
  key_login: boolean;
}

export interface ReasonNow {
  of: string;
  reason: string;
  sentence: string;
}
export interface Status {
  mode: Mode;
  mode_wanted: Mode;
  port?: string;
  cycles: number;
  overruns: number;
  time_s: number;
  motion?: string;
  cutting: boolean;
  program_line: number;
  contour_error_um: Maybe;
  contour_limit_um: number;
  feed_percent: number;
  feed_panel_percent: number;
  feed_effective_percent: number;
  spindle_percent: number;
  spindle_effective_percent: number;
  offset_um: number[];
  path_offset_um: number[];
  reasons: ReasonNow[];
  reload?: { number: number; utc: string; outcome: 'taken' | 'refused'; words: string } | null;
  program?: { file: string; segments: number; words: string | null; place: string } | null;
  port_fault?: string | null;
  /** Why the record ended before its run. */
  record_fault?: string | null;
}

export type Law = 'constant' | 'square' | 'pulse' | 'triangle' | 'sine' | 'random' | 'stop';
export interface Modulation {
  law: Law;
  amplitude_ratio: number;
  period_s: number;
  mean_ratio: number;
}

export interface Hello {
  type: 'hello';
  version: number;
  machine: { name: string; axes: { name: string; rotary: boolean }[] };
  cycle_s: number;
  contour: { limit_um: number; strategy: string; steps_percent: number[] };
  modulation: Modulation | null;
  thermal: boolean;
  listening: boolean;
  /** The layer sets the spindle's speed itself when it hears chatter. */
  chooses_speed?: boolean;
  /** Of the tool and the process that it listens to; null and none where it does not. */
  teeth: Maybe;
  modes_hz: number[];
  /** The server has a map of stability; it takes measured sizes. */
  lobes: boolean;
  measures: boolean;
}

type Column = Maybe[];
export interface Samples {
  t_s: number[];
  contour_error_um: Column;
  feed_asked_percent: Column;
  feed_percent: Column;
  feed_effective_percent: Column;
  panel_percent: Column;
  path_speed_mm_min: Column;
  spindle_rpm: Column;
  position_mm: Maybe[][];
  following_um: Maybe[][];
}
export interface Ahead {
  points_mm: number[][];
  /** Known where the layer expects the largest one. */
  error_um: Maybe[];
  at_mm: number[];
}
export interface ChatterNow {
  /** Does the cut chatter, and is the speed modulated against it? */
  chatter: boolean;
  modulating?: boolean;
  kind?: 'none' | 'forced' | 'hopf' | 'flip';
  frequency_hz?: Maybe;
  /** Share of the chatter in the vibration's energy, 0 … 1. */
  level?: Maybe;
  threshold?: Maybe;
  /** Level before the layer stepped in. */
  before?: Maybe;
  /** The better step by the planner's table; null: none was asked for. */
  better_spindle_percent?: Maybe;
  events?: number;
  chatter_s?: number;
  /** The strongest line and the spindle order nearest to it; null while no line stands out. */
  line?: { frequency_hz: number; nearest_order: Maybe; order_folded: boolean; from_order_hz: number; from_order_sd_hz: number; forced: boolean } | null;
  nearest_mode?: { frequency_hz: number; off_hz: number } | null;
  /** That this chatter is not forced vibration, 0 … 1. */
  confidence?: Maybe;
  /** By the orders in the signal; null: they do not show it. */
  spindle_rpm?: Maybe;
  spindle_sd_rpm?: Maybe;
  clips?: boolean;
}
export interface ThermalAxis {
  name: string;
  displacement_um: Maybe;
  sd_um: Maybe;
  offset_um: Maybe;
}
export interface AxisNow {
  name: string;
  position_mm: Maybe;
  velocity_mm_min: Maybe;
  velocity_bound_mm_min: Maybe;
  acceleration_mm_s2: Maybe;
  acceleration_bound_mm_s2: Maybe;
  following_um: Maybe;
}
/** What a step of the override would give: in force from now on, and taken until the next decision. */
export interface StepNow {
  percent: number;
  error_um: Maybe;
  change_um: Maybe;
}
export interface Frame {
  type: 'frame';
  seq: number;
  missed: number;
  lost_cycles: number;
  status: Status;
  samples: Samples;
  ahead: Ahead | null;
  path_known?: boolean;
  steps: StepNow[] | null;
  chatter: ChatterNow | null;
  /** `switched_off`: the measured sizes do not fit the thermal model; nothing is corrected until they do. */
  thermal: { axes: ThermalAxis[]; switched_off?: boolean } | null;
  axes: AxisNow[];
}
export interface Spectrum {
  type: 'spectrum';
  time_s: number;
  rate_hz: number;
  hz: number[];
  amplitude: number[];
  /** The loudest since the last message, in bands of this width from 0 up. */
  band_hz: number;
  level_db: number[];
  spindle_rpm: number;
  tooth_hz: Maybe;
  chatter_hz: Maybe;
}
export type Message = Hello | Frame | Spectrum;

export interface Refusal {
  file?: string;
  line?: number;
  what: string;
  to_do?: string;
}
export interface Finding {
  severity: string;
  check: string;
  what: string;
  to_do: string;
}
export type KeyValue = string | number | boolean | null | readonly (string | number | boolean)[];
export interface MachineKey {
  key: string;
  value: KeyValue;
  unit: string;
  range: string;
  explanation: string;
  /** May change while the layer runs. */
  live: boolean;
}
export interface MachineSection {
  name: string;
  title: string;
  keys: MachineKey[];
}
export interface Machine {
  file: string;
  name: string;
  sha256: string;
  text: string;
  sections: MachineSection[];
  findings: Finding[];
  reload: Status['reload'];
}
export interface Checked {
  diff: string;
  text: string;
  sha256_before: string;
  refusals: Refusal[];
  findings: Finding[];
  fits_running: boolean;
  why_not: string | null;
}

export interface Lobes {
  map: { speed_rpm: number[]; depth_mm: number[]; log_radius: number[] };
  border: { speed_rpm: number[]; depth_mm: Maybe[] };
  /** The depth that the process file gives. */
  depth_mm?: Maybe;
}

/** Null: not computed yet. */
export interface LobesAnswer {
  lobes: Lobes | null;
  progress: number;
}
export interface Plan {
  decision: 'keep' | 'constant' | 'law' | 'nothing';
  override_percent: number[];
  law: Law;
  rva: number;
  period_s: Maybe;
  speed_rpm: number;
  programmed_rpm: number;
  depth_mm: number;
  limit_depth_mm: Maybe;
  likely_depth_mm: Maybe;
  notes: string[];
}
export interface PlanAnswer {
  plan: Plan | null;
  /** 0: no speed has been programmed yet. */
  programmed_rpm: number;
  progress: number;
}

export interface ThermalHistory {
  name: string;
  displacement_um: Maybe[];
  sd_um: Maybe[];
  offset_um: Maybe[];
}
/** Of an offset. */
export interface Move {
  axis: string;
  from_um: number;
  to_um: number;
}
export interface Thermal {
  share_k: Maybe;
  passports: { axis: string; modes: { amplitude_um: Maybe; time_constant_min: Maybe }[] }[];
  history: { t_s: number[]; axes: ThermalHistory[] };
  /** Means of the time up to each instant. */
  cyclogram?: { t_s: number[]; speed_rpm: Maybe[]; feed_mm_min: Maybe[]; cutting_percent: Maybe[]; coolant_percent: Maybe[] };
  /** From now on, if the machine repeats what it did in the last `of_last_s`. */
  outlook?: { of_last_s: number; in_s: number[]; axes: ThermalHistory[] } | null;
  corrections?: { step_um: number; done: (Move & { t_s: number })[]; to_come: (Move & { in_s: number })[] };
  next: { axis: string; offset_um: number; in_s: Maybe } | null;
  readings?: { t_s: number; axis: string; displacement_um: number; reason: string; sentence: string }[];
}
export interface Verdict {
  taken?: boolean;
  reason?: string;
  sentence?: string;
}

/** Lengths in µm and mm; of a rotary axis the keys end in `_deg`. */
export interface EncoderAxis {
  name: string;
  rotary: boolean;
  encoder: { ideal: boolean; count_um?: Maybe; count_deg?: Maybe; line_period_um?: Maybe; line_period_deg?: Maybe; clock_ns: Maybe };
  calibration: {
    phase_error_um?: number[];
    phase_error_deg?: number[];
    lines: number;
    lines_learnt: number;
    periodic: boolean;
    applied: boolean;
    curve: { at_mm?: number[]; at_deg?: number[]; low_um?: Maybe[]; low_deg?: Maybe[]; high_um?: Maybe[]; high_deg?: Maybe[] } | null;
  } | null;
  estimator: { input: 'edges' | 'counts'; cycle_ms: number; lag_ms: number; bounded: boolean; line_error_um?: Maybe; line_error_deg?: Maybe } | null;
}

export interface RecordRow {
  name: string;
  start_utc: string;
  machine: string;
  program: string;
  seconds: number;
  samples: number;
  bytes: number;
  closed: boolean;
  /** Not closed, and its run is still at it. */
  writing: boolean;
  fault: boolean;
}
/** A file that cannot be read as a record, and why. */
export interface DamagedRecord {
  name: string;
  bytes: number;
  damaged: string;
}
export interface RecordDetail {
  run: Record<string, unknown>;
  events: { t_s: number; kind: string; text: string }[];
  totals: Record<string, unknown>;
  formats?: string[];
}
export interface RecordData {
  t_s: number[];
  columns: Record<string, { min: Maybe[]; max: Maybe[] }>;
}
