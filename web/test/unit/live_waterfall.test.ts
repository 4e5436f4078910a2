// SPDX-License-Identifier: Apache-2.0
// The course of the spectrum: its rows in time, its levels, and the line in words.
import { describe, expect, it } from 'vitest';
import type { ChatterNow, Spectrum } from '../../src/live/api/types';
import { cellsOf } from '../../src/live/paint/waterfall';
import { COLUMNS, COLUMN_S, Waterfall } from '../../src/live/state/waterfall';
import { lineWords, signalWords } from '../../src/live/views/chatter/line';

const row = (time_s: number, level_db: number[] = [-60, 0], band_hz = 10): Spectrum => ({ type: 'spectrum', time_s, rate_hz: 10e3, hz: [], amplitude: [], band_hz, level_db, spindle_rpm: 3000, tooth_hz: 100, chatter_hz: null });
/** How many columns ago each row is drawn. */
const times = (waterfall: Waterfall) => waterfall.columns().map((c) => c?.time_s);

describe('the course of the spectrum', () => {
  it('has a column for each fifth of a second, the newest at the end, whatever the jitter', () => {
    const waterfall = new Waterfall();
    for (let i = 1; i <= 50; ++i) waterfall.take(row(100 + i * COLUMN_S + (i % 2 ? 0.03 : -0.03)));
    const drawn = times(waterfall);
    expect(drawn.length).toBe(COLUMNS);
    expect(drawn.at(-1)).toBeCloseTo(109.97, 6);
    expect(new Set(drawn.slice(-50)).size).toBe(50);
    // A row stands for no more than half a second before it.
    expect(drawn.slice(0, -53).every((t) => t === undefined)).toBe(true);
    expect(waterfall.top_hz).toBe(20);
  });
  it('has a gap where nothing was heard', () => {
    const waterfall = new Waterfall();
    for (let i = 0; i < 10; ++i) waterfall.take(row(100 + i * COLUMN_S));
    for (let i = 0; i < 10; ++i) waterfall.take(row(110 + i * COLUMN_S));
    const drawn = times(waterfall);
    const first = drawn.findIndex((t) => t === 110);
    expect(drawn.slice(first - 20, first - 1).every((t) => t === undefined)).toBe(true);
  });
  it('forgets what is older, what another clock had, and bands of another width', () => {
    const waterfall = new Waterfall();
    for (let i = 0; i < 1000; ++i) waterfall.take(row(i * COLUMN_S));
    expect(times(waterfall)[0]).toBeCloseTo((1000 - COLUMNS) * COLUMN_S, 6);
    waterfall.take(row(3));
    expect(times(waterfall).filter((t) => t !== undefined && t !== 3)).toEqual([]);
    waterfall.take(row(4, [-60, 0, -60], 20));
    expect(waterfall.top_hz).toBe(60);
    expect(times(waterfall).filter((t) => t !== undefined && t !== 4)).toEqual([]);
  });
  it('is measured from its strongest cell; a gap and silence do not stretch the colours', () => {
    const heard = (level_db: number[]) => ({ time_s: 0, rpm: 3000, chatter_hz: null, level_db });
    const { level_db, low_db } = cellsOf([undefined, heard([-30, 12]), heard([-38, -8])], 2);
    expect(level_db).toEqual([null, null, -42, 0, -50, -20]);
    expect(low_db).toBe(-30);
    const quiet = Array.from({ length: 100 }, () => heard(new Array<number>(9).fill(-45)));
    expect(cellsOf([...quiet, heard(new Array<number>(9).fill(0))], 9).low_db).toBe(-50);
    const silent = Array.from({ length: 100 }, () => heard(new Array<number>(9).fill(-240)));
    expect(cellsOf([...silent, heard(new Array<number>(9).fill(0))], 9).low_db).toBe(-30);
  });
});

describe('the line', () => {
  const line = { frequency_hz: 1234.2, nearest_order: 15, order_folded: false, from_order_hz: 3.41, from_order_sd_hz: 0.62, forced: false };
  const now = (change: Partial<ChatterNow>): ChatterNow => ({ chatter: true, kind: 'hopf', line, confidence: 0.97, ...change });
  it('is told with its order, its confidence and the nearest mode', () => {
    expect(lineWords(now({}))).toBe('1234\u00a0Hz: 3.4\u00a0Hz ± 0.6 above order 15 · confidence\u00a097\u00a0%');
    expect(lineWords(now({ line: { ...line, from_order_hz: -3.41, order_folded: true }, nearest_mode: { frequency_hz: 1240, off_hz: -5.8 } }))).toBe('1234\u00a0Hz: 3.4\u00a0Hz ± 0.6 below order 15, folded · confidence\u00a097\u00a0% · 5.8\u00a0Hz below the mode at 1240\u00a0Hz');
  });
  it('is forced at an order, and at a half one it doubles the period', () => {
    expect(lineWords(now({ chatter: false, kind: 'forced', confidence: null, line: { ...line, nearest_order: 24, forced: true } }))).toBe('1234\u00a0Hz, forced: order 24');
    expect(lineWords(now({ kind: 'flip' }))).toContain('at half a tooth order');
    expect(lineWords(now({ line: { ...line, nearest_order: null } }))).toContain('no order is near');
  });
  it('says nothing where none stands out', () => {
    expect(lineWords({ chatter: false, line: null, confidence: null, nearest_mode: null })).toBe('');
    expect(lineWords({ chatter: false })).toBe('');
  });
  it('comes with what the signal says of the spindle and the sensor', () => {
    expect(signalWords({ chatter: false, spindle_rpm: 5001.24, spindle_sd_rpm: 0.31, clips: true })).toBe('Spindle by its orders: 5001.2 ± 0.3\u00a0rpm · The sensor clips.');
    expect(signalWords({ chatter: false, spindle_rpm: null, clips: false })).toBe('');
  });
});
