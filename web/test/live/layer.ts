// SPDX-License-Identifier: Apache-2.0
// A layer at work, for the mock: a part of arcs and lines at 1 kHz, an error that grows with curvature, heat, vibration.
import type { Frame, Hello, Mode, Modulation, Spectrum, Status } from '../../src/live/api/types';

export const CYCLE_S = 0.001;
const LIMIT_UM = 10;
export const STEPS = [10, 20, 30, 40, 50, 60, 70, 75, 80, 85, 90, 95, 100, 105, 110];
const FULL_MM_MIN = 4000;
const GAIN_1_S = 50;

/** A rounded square with a bay: position and radius of curvature by the distance along it. */
interface Piece {
  length: number;
  radius: number;
  at: (s: number) => [number, number];
}

function outline(): Piece[] {
  const pieces: Piece[] = [];
  let [x, y, heading] = [-30, -25, 0];
  const line = (length: number) => {
    const [x0, y0, h] = [x, y, heading];
    pieces.push({ length, radius: Infinity, at: (s) => [x0 + s * Math.cos(h), y0 + s * Math.sin(h)] });
    [x, y] = [x0 + length * Math.cos(h), y0 + length * Math.sin(h)];
  };
  const arc = (radius: number, turn: number) => {
    const [cx, cy, h] = [x - Math.sign(turn) * radius * Math.sin(heading), y + Math.sign(turn) * radius * Math.cos(heading), heading];
    const at = (s: number): [number, number] => {
      const a = h + (Math.sign(turn) * s) / radius;
      return [cx + Math.sign(turn) * radius * Math.sin(a), cy - Math.sign(turn) * radius * Math.cos(a)];
    };
    const length = radius * Math.abs(turn);
    pieces.push({ length, radius, at });
    [x, y] = at(length);
    heading += turn;
  };
  const quarter = Math.PI / 2;
  line(20);
  arc(4, quarter);
  line(6);
  arc(8, -2 * quarter);
  line(6);
  arc(4, quarter);
  line(20);
  arc(12, quarter);
  line(34);
  arc(6, quarter);
  line(60 + 2 * 12 - 8);
  arc(10, quarter);
  line(30);
  return pieces;
}

const PIECES = outline();
const LENGTH = PIECES.reduce((sum, p) => sum + p.length, 0);

function along(s: number): { x: number; y: number; radius: number } {
  let rest = ((s % LENGTH) + LENGTH) % LENGTH;
  for (const piece of PIECES) {
    if (rest <= piece.length) {
      const [x, y] = piece.at(rest);
      return { x, y, radius: piece.radius };
    }
    rest -= piece.length;
  }
  return { x: 0, y: 0, radius: Infinity };
}

const errorAt = (speed_mm_s: number, radius: number) => (1000 * speed_mm_s ** 2) / (2 * radius * GAIN_1_S ** 2);

/** Of the machine file. */
export const MODULATION: Modulation = { law: 'triangle', amplitude_ratio: 0.1, period_s: 2, mean_ratio: 0.95 };

/** Of the line that chatters. */
export const EVIDENCE = { line: { frequency_hz: 931.2, nearest_order: 11, order_folded: false, from_order_hz: -22.1, from_order_sd_hz: 0.6, forced: false }, nearest_mode: { frequency_hz: 922, off_hz: 9.2 }, confidence: 0.97, spindle_rpm: 5199.6, spindle_sd_rpm: 0.4, clips: false };

export class Layer {
  mode: Mode = 'observe';
  wanted: Mode = 'observe';
  modulation: Modulation | null = { ...MODULATION };
  reload: NonNullable<Status['reload']> | null = null;
  recordFault: string | null = null;
  limit_um = LIMIT_UM;
  pathKnown = true;
  heatSwitchedOff = false;
  hears = true;
  random: () => number = Math.random;
  private time = 1200;
  private cycles = 0;
  private way = 0;
  private feed = 100;
  private error = 0;
  private seq = 0;

  hello(): Hello {
    return {
      type: 'hello',
      version: 1,
      machine: { name: 'VMC with SINUMERIK 840D', axes: ['X', 'Y', 'Z', 'C'].map((name) => ({ name, rotary: name === 'C' })) },
      cycle_s: CYCLE_S,
      contour: { limit_um: this.limit_um, strategy: 'feed_priority', steps_percent: STEPS },
      modulation: this.modulation,
      thermal: true,
      listening: this.hears,
      teeth: this.hears ? 2 : null,
      modes_hz: this.hears ? [922] : [],
      lobes: true,
      measures: true,
    };
  }

  /** Time passes without anybody looking. */
  skip(cycles: number): void {
    this.time += cycles * CYCLE_S;
    this.cycles += cycles;
  }

  frame(cycles: number, missed = 0): Frame {
    this.mode = this.wanted;
    const samples: Frame['samples'] = { t_s: [], contour_error_um: [], feed_asked_percent: [], feed_percent: [], feed_effective_percent: [], panel_percent: [], path_speed_mm_min: [], spindle_rpm: [], position_mm: [], following_um: [] };
    for (let i = 0; i < cycles; ++i) {
      this.step(samples);
    }
    this.seq += 1;
    return { type: 'frame', seq: this.seq, missed, lost_cycles: 0, status: this.status(), samples, ...this.surroundings() };
  }

  private asked(): number {
    const tight = Math.min(...[0, 1, 2, 3, 4].map((mm) => along(this.way + mm).radius));
    return [...STEPS].reverse().find((p) => errorAt((FULL_MM_MIN / 60) * (p / 100), tight) <= 0.9 * this.limit_um) ?? 10;
  }

  private step(samples: Frame['samples']): void {
    const asked = Math.min(this.asked(), 110);
    const allowed = this.mode === 'act' ? Math.min(asked, 100) : 100;
    this.feed += (allowed - this.feed) * 0.03;
    const speed = (FULL_MM_MIN / 60) * (this.feed / 100);
    this.way += speed * CYCLE_S;
    this.time += CYCLE_S;
    this.cycles += 1;
    const { x, y, radius } = along(this.way);
    this.error += (errorAt(speed, radius) - this.error) * 0.03;
    const round = (v: number, d: number) => Number(v.toFixed(d));
    samples.t_s.push(round(this.time, 4));
    samples.contour_error_um.push(round(Math.abs(this.error + 0.4 * Math.sin(180 * this.time) + 0.5 * (this.random() - 0.5)), 2));
    samples.feed_asked_percent.push(asked);
    samples.feed_percent.push(allowed);
    samples.feed_effective_percent.push(round(this.feed, 1));
    samples.panel_percent.push(100);
    samples.path_speed_mm_min.push(round(60 * speed, 1));
    samples.spindle_rpm.push(this.rpm());
    samples.position_mm.push([round(x, 4), round(y, 4), -12.5]);
    samples.following_um.push([round(20 * speed, 1), round(18 * speed, 1), 0]);
  }

  status(): Status {
    const reason = this.mode === 'act' ? (this.feed < 99 ? 'contour_limit' : 'contour_within_limit') : 'observe_only';
    const sentences: Record<string, string> = { contour_limit: 'Feed reduced to hold the contour limit.', contour_within_limit: 'Highest feed step that holds the contour limit.', observe_only: 'This mode does not write.', thermal_correcting: 'The axis offsets cancel the forecast drift.', none: 'Nothing to correct.', chatter_detected: 'The cut chatters.' };
    const reasons = [['feed', reason], ['spindle', 'chatter_detected'], ['offset', this.mode === 'act' ? 'thermal_correcting' : 'observe_only'], ['path_offset', 'none']] as const;
    return {
      mode: this.mode, mode_wanted: this.wanted, port: 'sim', cycles: this.cycles, overruns: 0, time_s: this.time, cutting: true, program_line: 120 + (Math.floor(this.way / 15) % 40),
      contour_error_um: this.error, contour_limit_um: this.limit_um,
      feed_percent: this.mode === 'act' ? Math.min(this.asked(), 100) : 100, feed_panel_percent: 100, feed_effective_percent: this.feed,
      spindle_percent: 100, spindle_effective_percent: 100,
      offset_um: this.mode === 'act' ? [0, 1.2, -4.1] : [0, 0, 0], path_offset_um: [0, 0, 0],
      reasons: reasons.map(([of, name]) => ({ of, reason: name, sentence: sentences[name] ?? '' })),
      reload: this.reload, port_fault: null, record_fault: this.recordFault,
    };
  }

  private surroundings(): Pick<Frame, 'ahead' | 'steps' | 'path_known' | 'chatter' | 'thermal' | 'axes'> {
    const points = Array.from({ length: 60 }, (_, i) => along(this.way + 0.5 * i));
    const tight = Math.min(...points.slice(0, 20).map((p) => p.radius));
    const speed = (FULL_MM_MIN / 60) * (this.feed / 100);
    const here = along(this.way);
    const axis = (name: string, position: number, velocity: number) => ({ name, position_mm: position, velocity_mm_min: velocity, velocity_bound_mm_min: 0.4, acceleration_mm_s2: velocity / 9, acceleration_bound_mm_s2: 22, following_um: velocity / 3 });
    const warm = 6 * (1 - Math.exp(-this.time / 4000));
    return {
      ahead: { points_mm: points.map((p) => [p.x, p.y, -12.5]), error_um: points.map((p) => errorAt(speed, p.radius)), at_mm: points.map((_, i) => 0.5 * i) },
      path_known: this.pathKnown,
      steps: this.pathKnown ? STEPS.map((percent) => ({ percent, error_um: Number.isFinite(tight) ? errorAt((FULL_MM_MIN / 60) * (percent / 100), tight) : 0.4, change_um: this.error + 0.1 })) : null,
      chatter: { chatter: true, modulating: true, kind: 'hopf', frequency_hz: 931, better_spindle_percent: 90, events: 1, chatter_s: 0.4, level: 0.31 + 0.04 * Math.sin(this.time), threshold: 0.25, before: 0.92, ...EVIDENCE },
      thermal: { axes: [{ name: 'Y', displacement_um: 0.3 * warm, sd_um: 0.4, offset_um: 0 }, { name: 'Z', displacement_um: warm, sd_um: 0.7, offset_um: -4.1 }], switched_off: this.heatSwitchedOff },
      axes: [axis('X', here.x, 60 * speed * 0.7), axis('Y', here.y, -60 * speed * 0.5), axis('Z', -12.5, 0), axis('C', 90, 0)],
    };
  }

  private rpm(): number {
    return Math.round(5200 + 180 * Math.sin(this.time / 2));
  }

  spectrum(): Spectrum {
    const [hz, rpm] = [Array.from({ length: 256 }, (_, i) => 8 * i), this.rpm()];
    const tooth_hz = rpm / 30;
    const peak = (f: number, at: number, width: number, height: number) => height / (1 + ((f - at) / width) ** 2);
    const amplitude = hz.map((f) => 0.02 + 0.01 * this.random() + peak(f, tooth_hz, 6, 0.35) + peak(f, 2 * tooth_hz, 6, 0.2) + peak(f, 931, 10, 0.8 + 0.1 * this.random()));
    const level_db = Array.from({ length: 128 }, (_, i) => Math.round(20 * Math.log10(Math.max(amplitude[2 * i] as number, amplitude[2 * i + 1] as number))));
    return { type: 'spectrum', time_s: this.time, rate_hz: 4096, hz, amplitude, band_hz: 16, level_db, spindle_rpm: rpm, tooth_hz, chatter_hz: 931 };
  }
}
