// SPDX-License-Identifier: Apache-2.0
// The course of the vibration's spectrum: rows as they come, and the even columns that are drawn of them.
import type { Maybe } from '../../frame/data';
import type { Spectrum } from '../api/types';

export const COLUMNS = 225;
export const COLUMN_S = 0.2;
/** A row covers this much time before it; a longer pause is shown as a gap. */
const HOLD_S = 0.5;

export interface Heard {
  time_s: number;
  rpm: number;
  chatter_hz: Maybe;
  level_db: readonly number[];
}

export class Waterfall {
  band_hz = 0;
  private rows: Heard[] = [];

  get newest(): Heard | undefined {
    return this.rows.at(-1);
  }

  get top_hz(): number {
    return this.band_hz * (this.newest?.level_db.length ?? 0);
  }

  take({ time_s, spindle_rpm: rpm, chatter_hz, band_hz, level_db }: Spectrum): void {
    if (level_db.length === 0) {
      return;
    }
    const before = this.newest;
    // The control's clock has started again, or the sensor has another rate.
    if (before && (time_s < before.time_s || band_hz !== this.band_hz || level_db.length !== before.level_db.length)) {
      this.rows = [];
    }
    this.band_hz = band_hz;
    this.rows.push({ time_s, rpm, chatter_hz, level_db });
    const kept = this.rows.findIndex((row) => row.time_s > time_s - (COLUMNS + 1) * COLUMN_S);
    this.rows.splice(0, kept);
  }

  /** Oldest first; undefined where nothing was heard. */
  columns(): (Heard | undefined)[] {
    const end = Math.round((this.newest?.time_s ?? 0) / COLUMN_S);
    let at = 0;
    return Array.from({ length: COLUMNS }, (_, i) => {
      const middle_s = (end - COLUMNS + i + 0.5) * COLUMN_S;
      while (at < this.rows.length && (this.rows[at] as Heard).time_s < middle_s) {
        at += 1;
      }
      const row = this.rows[at];
      return row && row.time_s - middle_s < HOLD_S ? row : undefined;
    });
  }
}
