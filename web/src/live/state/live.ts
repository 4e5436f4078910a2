// SPDX-License-Identifier: Apache-2.0
// What the stream has brought, in fixed memory.
import type { Maybe } from '../../frame/data';
import type { Frame, Hello, Message, Spectrum, Status } from '../api/types';
import { Ring } from './ring';
import { Waterfall } from './waterfall';

/** 16 s at 1 kHz: more than the longest plot shows. */
const SAMPLES = 16_384;
/** A longer distance between two samples, in cycles, is missing data. */
export const GAP_CYCLES = 1.5;
/** The tool's trail: points this far apart, mm. */
const TRAIL = 4096;
const TRAIL_STEP_MM = 0.25;

const COLUMNS = ['t_s', 'error_um', 'asked', 'allowed', 'effective', 'panel', 'speed_mm_min', 'rpm', 'x', 'y', 'z', 'following_0', 'following_1', 'following_2'] as const;
export type SampleColumn = (typeof COLUMNS)[number];

/** Ends a stretch of the trail: where the tool went meanwhile is unknown. */
const NOWHERE = { x: NaN, y: NaN, z: NaN, error_um: NaN };

const value = (v: Maybe | undefined) => v ?? NaN;

/** How much of the stream did not arrive since its first frame. */
export interface Missing {
  seconds: number;
  frames: number;
  cycles: number;
}

export class Live {
  readonly samples = new Ring<SampleColumn>(COLUMNS, SAMPLES);
  readonly waterfall = new Waterfall();
  readonly trail = new Ring(['x', 'y', 'z', 'error_um'] as const, TRAIL);
  hello: Hello | undefined;
  frame: Frame | undefined;
  spectrum: Spectrum | undefined;
  readonly missing: Missing = { seconds: 0, frames: 0, cycles: 0 };
  /** Set by each message, cleared by who draws. */
  changed = false;

  private first = true;
  private worst = NaN;
  private readonly row = Object.fromEntries(COLUMNS.map((c) => [c, NaN])) as Record<SampleColumn, number>;

  get status(): Status | undefined {
    return this.frame?.status;
  }

  /** True if the machine file was read anew. */
  take(message: Message): boolean {
    this.changed = true;
    switch (message.type) {
      case 'hello':
        this.hello = message;
        return true;
      case 'frame':
        this.takeFrame(message);
        return false;
      case 'spectrum':
        this.spectrum = message;
        this.waterfall.take(message);
        return false;
    }
  }

  private takeFrame(frame: Frame): void {
    this.frame = frame;
    const first = this.first;
    this.first = false;
    if (!first) {
      this.missing.frames += frame.missed;
      this.missing.cycles += frame.lost_cycles;
    }
    const { samples } = frame;
    const cycle_s = this.hello?.cycle_s ?? 0.001;
    const { row } = this;
    for (let i = 0; i < samples.t_s.length; ++i) {
      const t = samples.t_s[i] as number;
      const before = this.samples.newest('t_s');
      const gap = t - before > GAP_CYCLES * cycle_s;
      if (t < before || (gap && first)) {
        // The control's clock has started again, or the first frame has samples from before anybody watched.
        this.samples.clear();
        this.trail.clear();
      } else if (gap) {
        this.missing.seconds += t - before - cycle_s;
        this.trail.push(NOWHERE);
      }
      row.t_s = t;
      row.error_um = value(samples.contour_error_um[i]);
      row.asked = value(samples.feed_asked_percent[i]);
      row.allowed = value(samples.feed_percent[i]);
      row.effective = value(samples.feed_effective_percent[i]);
      row.panel = value(samples.panel_percent[i]);
      row.speed_mm_min = value(samples.path_speed_mm_min[i]);
      row.rpm = value(samples.spindle_rpm[i]);
      const [at, following] = [samples.position_mm[i], samples.following_um[i]];
      [row.x, row.y, row.z] = [value(at?.[0]), value(at?.[1]), value(at?.[2])];
      [row.following_0, row.following_1, row.following_2] = [value(following?.[0]), value(following?.[1]), value(following?.[2])];
      this.samples.push(row);
      this.leaveTrail();
    }
  }

  /** Each point has the largest error since the one before. */
  private leaveTrail(): void {
    const { row, trail } = this;
    const error = Math.abs(row.error_um);
    this.worst = Number.isNaN(this.worst) || error > this.worst ? error : this.worst;
    // A machine of two axes has no z: NaN, which counts as no way.
    const way = (name: 'x' | 'y' | 'z') => row[name] - trail.newest(name) || 0;
    if (trail.size === 0 || Number.isNaN(trail.newest('x')) || Math.hypot(way('x'), way('y'), way('z')) >= TRAIL_STEP_MM) {
      trail.push({ x: row.x, y: row.y, z: row.z, error_um: this.worst });
      this.worst = NaN;
    }
  }
}
