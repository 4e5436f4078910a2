// SPDX-License-Identifier: Apache-2.0
// What the pages of the thermal verbs hold. Their source is steadyrest/apps/page/thermal; `answer`
// is what the verb prints with --json.
import type { Head as PageHead, Maybe } from '../frame/data';

export interface Transition {
  name: string;
  start_min: number;
  minutes: number;
  speed_rpm: number;
  cutting: boolean;
}

export interface Course {
  axis: string;
  t_min: number[];
  displacement_um: Maybe[];
  sd_um: Maybe[];
}

export interface Correction {
  t_min: number;
  delta_um: number;
  /** Sum of all corrections so far. */
  total_um: number;
}

export interface PlannedCourse extends Course {
  corrections: Correction[];
  bands: { from_min: number; to_min: number; tolerance_um: number; band_um: number }[];
}

interface Head extends PageHead {
  title: string;
}

export interface ForecastPage extends Head {
  kind: 'forecast';
  answer: { max_um: number };
  transitions: Transition[];
  courses: Course[];
}

export interface PlanPage extends Head {
  kind: 'plan';
  answer: {
    k: number;
    level: number;
    tolerance_um: number;
    axes: { axis: string; max_um: number; residual_um: number; ratio: number; corrections: number; sd_um: number; transitions: { name: string; t_min: number[]; delta_um: number[] }[] }[];
  };
  transitions: Transition[];
  courses: PlannedCourse[];
}

export interface Error {
  largest_um: number;
  rms_um: number;
}

export interface BatchPage extends Head {
  kind: 'batch';
  axis: string;
  answer: {
    band_um: number;
    program_s: number;
    total_s: number;
    without: Error;
    text: Error & { improvement: number; worse_parts: number };
    online: Error & { improvement: number; worse_parts: number };
    parts: { start_s: number; corrections: number; without: Error; text: Error; online: Error }[];
  };
  course: Record<'t_min' | 'part' | 'without_um' | 'text_um' | 'online_um' | 'model_um' | 'model_sd_um' | 'room_c', number[]>;
}

/** One displacement over one temperature. */
export interface Over {
  correlation: number;
  /** The straight line of least squares goes through the means. */
  mean_c: number;
  mean_um: number;
  slope_um_k: number;
  residual_rms_um: number;
  /** Largest difference of displacement within half a kelvin, where and from what upwards. */
  spread_um: number;
  spread_at_c: number;
  spread_from_um: number;
}

export interface Regime {
  speed_rpm: number;
  start_h: number;
  hours: number;
  t_h: number[];
  /** Of each sensor. */
  temperature_c: Maybe[][];
}

/** What was measured, and what the model makes of the inputs. */
export interface MeasuredCourse {
  axis: string;
  channel: string;
  /** Readings were used in this time only. */
  fitted_from_h: number;
  fitted_to_h: number;
  t_h: number[];
  measured_um: Maybe[];
  modelled_um: Maybe[];
  /** Standard deviation of a reading about the model. */
  sd_um: Maybe[];
}

export interface SpeedSteps {
  t_h: number[];
  speed_rpm: number[];
}

export interface FittedAxis extends MeasuredCourse {
  /** Index of the sensor that the displacement follows best; null if the log has none. */
  best_sensor: number | null;
  over: Over[];
  /** In each regime. */
  displacement_um: Maybe[][];
}

export interface ReplayPage extends Head {
  kind: 'replay';
  answer: { minutes: number; axes: { axis: string; end_um: number; end_sd_um: number; points: number; rms_um: Maybe; coverage: Maybe }[]; notes: string[] };
  speed: SpeedSteps;
  axes: MeasuredCourse[];
}

export interface FitPage extends Head {
  kind: 'fit';
  answer: {
    hours: number;
    axes: {
      axis: string;
      ambient: { sensor: string; tau_min: number; gain_um_k: number }[];
      rms_um: number;
      left_out_rms_um: Maybe;
      left_out_probed_rms_um: Maybe;
      coverage: Maybe;
      noise_um: number;
      drift_um: number;
    }[];
    modes: { axis: string; tau_min: number; rest_tau_min: number }[];
    notes: string[];
    /** Given if the bands do not hold what they promise. */
    warnings?: string[];
  };
  sensors: string[];
  regimes: Regime[];
  /** Each speed holds from its time to the next. */
  speed: SpeedSteps;
  axes: FittedAxis[];
}

export type Page = ForecastPage | PlanPage | BatchPage | FitPage | ReplayPage;

/** What corrections leave of a displacement; both values where one is made. */
export function residual(course: PlannedCourse): { t_min: number[]; um: number[] } {
  const t: number[] = [];
  const um: number[] = [];
  let next = 0;
  let off = 0;
  const put = (at: number, value: number) => {
    t.push(at);
    um.push(value);
  };
  course.t_min.forEach((at, i) => {
    const value = course.displacement_um[i] ?? 0;
    for (let c = course.corrections[next]; c !== undefined && c.t_min <= at; c = course.corrections[next]) {
      const before = i > 0 ? (course.t_min[i - 1] as number) : at;
      const from = i > 0 ? (course.displacement_um[i - 1] ?? 0) : value;
      const share = at > before ? (c.t_min - before) / (at - before) : 1;
      const there = from + share * (value - from);
      put(c.t_min, there - off);
      off = c.total_um;
      put(c.t_min, there - off);
      next += 1;
    }
    put(at, value - off);
  });
  return { t_min: t, um };
}
