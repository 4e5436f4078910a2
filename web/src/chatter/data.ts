// SPDX-License-Identifier: Apache-2.0
// What the pages of the chatter verbs hold. Their source is steadyrest/apps/page/chatter; `answer`
// is what the verb prints with --json.

import type { Head as PageHead, Maybe } from '../frame/data';
import { plain } from '../frame/numbers';

export interface LawAnswer {
  law: string;
  rva?: number;
  rvf?: number;
  amplitude_rpm?: number;
  period_s?: Maybe;
}

export interface Point {
  speed_rpm: number;
  depth_mm: number;
  spectral_radius: number;
  log_radius: number;
  stable: boolean;
  type: string;
  frequency_hz: Maybe;
}

export interface Border {
  speed_rpm: Maybe[];
  /** null: stable at all depths. */
  depth_mm: Maybe[];
}

export interface LobeColumns {
  map: { speed_rpm: number[]; depth_mm: number[]; /** [speed·depths + depth] */ log_radius: Maybe[] };
  border: Border;
  others: (Border & { name: string })[];
  steps: { percent: number; speed_rpm: number; limit_depth_mm: Maybe }[];
}

interface Head extends PageHead {
  process: string;
}

export interface LobesPage extends Head, LobeColumns {
  kind: 'lobes';
  answer: LawAnswer & { speeds: number; depths: number; point?: Point };
}

export interface GrowthPage extends Head {
  kind: 'growth';
  answer: LawAnswer & Point & { peak_growth: number; passes: number };
  courses: { start_pass: number; time_s: number[]; log_growth: Maybe[] }[];
  worst: number;
  law_period_s: Maybe;
  pass_s: number;
  speed: { time_s: number[]; speed_rpm: number[] };
}

export interface SimulatePage extends Head {
  kind: 'simulate';
  operation: 'milling' | 'turning';
  teeth: number;
  answer: LawAnswer & {
    speed_rpm: number;
    depth_mm: number;
    peak_um: number;
    growth_per_tooth: number;
    stable: boolean;
    forced_um: Maybe;
    chatter_rms_um: Maybe;
    chatter_frequency_hz: Maybe;
    force_peak_N: number;
    power_peak_W: number;
    wall_error_um: Maybe;
    wall_range_um: Maybe;
  };
  envelope: Record<'t_s' | 'x_low_um' | 'x_high_um' | 'y_low_um' | 'y_high_um' | 'force_low_N' | 'force_high_N', number[]>;
  last: Record<'t_s' | 'turn' | 'speed_rpm' | 'x_um' | 'y_um' | 'fx_N' | 'fy_N' | 'chip_um', number[]>;
  turns: { between: number; t_s: number[]; x_um: number[]; y_um: number[] };
}

export interface ChatterEvent {
  start_s: number;
  end_s: number;
  frequency_hz: number;
  type: string;
  speed_rpm: number;
  /** Frequency over the spindle's. */
  order: number;
  /** Confidence that this is not forced vibration, 0 … 1. */
  confidence: number;
  /** Of each channel that hears it. */
  evidence: { channel: number; nearest_order: number; order_folded: boolean; from_order_hz: number; from_order_sd_hz: number; confidence: number }[];
  /** Of the process file; null without one. */
  nearest_mode: { frequency_hz: number; off_hz: number } | null;
  advised_speed_rpm: Maybe;
  advised_override_percent: Maybe;
  /** By the chatter frequency alone, unchecked; empty with a process. */
  lobe_speeds_rpm?: number[];
  /** The planner's; null if it was not asked. */
  decision: 'keep' | 'constant' | 'law' | 'nothing' | null;
}

/** Vibration that the tool's entry or exit explains, or that is there without the cut. */
export interface EdgeEvent {
  start_s: number;
  end_s: number;
  frequency_hz: number;
  at: 'entry' | 'exit' | 'air';
}

export interface DetectPage extends Head {
  kind: 'detect';
  machine: string;
  teeth: number;
  bin_hz: number;
  start_s: number;
  answer: { advice_by: string; events: ChatterEvent[]; cuts: { start_s: number; end_s: number }[]; edge_revolutions: number; at_edges: EdgeEvent[]; seconds: number; sample_rate_hz: number; sensor: string[] };
  course: Record<'t_s' | 'low' | 'high' | 'speed_rpm', number[]>;
  spectrogram: {
    start_s: number;
    column_s: number;
    row_hz: number;
    columns: number;
    rows: number;
    /** [column·rows + row] */
    level_db: number[];
  };
}

export interface Alternative extends LawAnswer {
  override_percent: number[];
  limit_depth_mm: Maybe;
  probability: Maybe;
  peak_growth: Maybe;
  speed_rpm: number;
  stable: boolean;
  growth_is_lower_bound: boolean;
  reasons: string[];
}

export interface PlanPage extends Head, LobeColumns {
  kind: 'plan';
  machine: string;
  answer: Alternative & {
    decision: 'keep' | 'constant' | 'law' | 'nothing';
    depth_mm: number;
    most_depth_mm: number;
    likely_depth_mm: Maybe;
    /** A constant override that helps although only laws were asked for. */
    helping_override_percent: Maybe;
    chatter_frequency_hz: Maybe;
    notes: string[];
    alternatives: Alternative[];
    /** Over the whole range of the spindle, best first; null: no border down to the greatest depth. */
    best_speeds: { speed_rpm: number; limit_depth_mm: Maybe; sure_depth_mm: Maybe }[];
  };
}

/** Displacement over force at the tool. */
export interface Response {
  frequency_hz: number[];
  real_um_N: Maybe[];
  imag_um_N: Maybe[];
}

export interface FitPage extends Head {
  kind: 'fit';
  answer: {
    modes: { axis: string; frequency_hz: number; damping_ratio: number; mass_kg: number; stiffness_N_um: number }[];
    residual: number;
    noise_ratio: number;
    noise_um_N: number;
    points: number;
  };
  axis: string;
  /** Of frequencies. */
  band_hz: [number, number];
  measured: (Response & { name: string; coherence?: Maybe[] })[];
  fitted: Response;
}

export type Page = LobesPage | GrowthPage | SimulatePage | DetectPage | PlanPage | FitPage;

/** The law in shop-floor words. */
export function lawText(answer: LawAnswer): string {
  if (answer.law === 'constant') {
    return 'constant speed';
  }
  const percent = `±${plain(100 * (answer.rva ?? 0), 3)}\u00a0%`;
  const period = answer.period_s ? ` every ${plain(answer.period_s, 3)}\u00a0s` : `, RVF ${plain(answer.rvf ?? 0)}`;
  return `${answer.law} ${percent}${period}`;
}
