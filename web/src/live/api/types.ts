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
  frequency_hz?: Maybe;
  level?: Maybe;
  threshold?: Maybe;
  /** Level before the layer stepped in. */
  before?: Maybe;
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
export interface Frame {
  type: 'frame';
  seq: number;
  missed: number;
  lost_cycles: number;
  status: Status;
  samples: Samples;
  ahead: Ahead | null;
  steps: { percent: number; error_um: Maybe }[] | null;
  chatter: ChatterNow | null;
  thermal: { axes: ThermalAxis[] } | null;
  axes: AxisNow[];
}
export interface Spectrum {
  type: 'spectrum';
  rate_hz: number;
  hz: number[];
  amplitude: number[];
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

export interface ThermalHistory {
  name: string;
  displacement_um: Maybe[];
  sd_um: Maybe[];
  offset_um: Maybe[];
}
export interface Thermal {
  share_k: Maybe;
  passports: { axis: string; modes: { amplitude_um: Maybe; time_constant_min: Maybe }[] }[];
  history: { t_s: number[]; axes: ThermalHistory[] };
  next: { axis: string; offset_um: number; in_s: Maybe } | null;
  readings?: { t_s: number; axis: string; displacement_um: number; reason: string; sentence: string }[];
}
export interface Verdict {
  taken?: boolean;
  reason?: string;
  sentence?: string;
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
  fault: boolean;
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
