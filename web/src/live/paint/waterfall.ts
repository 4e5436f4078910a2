// SPDX-License-Identifier: Apache-2.0
// The course of the spectrum in the report's colours, with the spindle's orders, the chatter and the modes over it.
import { loudnessRaster, quietLevel } from '../../chatter/raster';
import type { Maybe } from '../../frame/data';
import { fixed } from '../../frame/numbers';
import type { Theme } from '../../frame/theme';
import type { Live } from '../state/live';
import { COLUMNS, COLUMN_S, type Heard } from '../state/waterfall';
import { t } from '../texts/texts';
import { type Area, Canvas } from './canvas';
import { type Scale, drawFrame, inner, scale } from './frame';

type Columns = readonly (Heard | undefined)[];

/** What is quieter has the colour of silence, whatever the rest is. */
const LEAST_DB = -80;
/** Steps of the colour scale's lower end, so that it does not flicker. */
const STEP_DB = 10;
/** Of so many cells one is asked how loud it is. */
const ASKED = 7;
/** Orders nearer to one another than this are left out, px. */
const APART_PX = 7;
const LABEL_PX = 24;
/** Where the speed changes by more than this share from one column to the next, as at a start, orders would be a black fan. */
const RUNS_UP = 0.1;

export const toothOrders = ({ text }: Theme) => `${text}cc`;
export const spindleOrders = ({ text }: Theme) => `${text}55`;
export const modeColour = ({ other }: Theme) => other[3] as string;

/** Cells below the strongest one, column by column, and the level that is shown as silence. */
export function cellsOf(columns: Columns, bands: number): { level_db: Maybe[]; low_db: number } {
  const most = columns.reduce((loudest, c) => Math.max(loudest, ...(c?.level_db ?? [])), -Infinity);
  const level_db = columns.flatMap((c) => (c ? c.level_db.map((level) => level - most) : new Array<null>(bands).fill(null)));
  const asked = level_db.filter((level, i): level is number => i % ASKED === 0 && level !== null && level > 2 * LEAST_DB);
  return { level_db, low_db: Math.max(LEAST_DB, STEP_DB * Math.floor(quietLevel(asked) / STEP_DB)) };
}

export class WaterfallPicture {
  readonly canvas: Canvas;
  low_db = 0;
  private drawn: Heard | undefined;

  constructor(
    private readonly live: Live,
    resized: () => void,
  ) {
    this.canvas = new Canvas('waterfall', t('waterfall'), resized);
  }

  /** A row comes a few times a second: what has not changed is left as it is, unless `again`. */
  draw(theme: Theme, again = false): void {
    const { waterfall, hello } = this.live;
    if (waterfall.newest === this.drawn && !again) {
      return;
    }
    const area = this.canvas.begin();
    if (!area || !waterfall.newest) {
      return;
    }
    this.drawn = waterfall.newest;
    const columns = waterfall.columns();
    const bands = waterfall.newest.level_db.length;
    const { left, right, top, bottom } = inner(area);
    const seconds = scale(-COLUMNS * COLUMN_S, 0, left, right);
    const hz = scale(0, waterfall.top_hz, bottom, top);
    drawFrame(area, theme, seconds, hz, (value, text) => (value === 0 ? t('seconds', { value: text }) : text));
    const { level_db, low_db } = cellsOf(columns, bands);
    this.low_db = low_db;
    area.pen.imageSmoothingEnabled = false;
    area.pen.drawImage(loudnessRaster(level_db, COLUMNS, bands, low_db, theme.scheme), left + 1, top, right - left - 1, bottom - top);
    const modes = (hello?.modes_hz ?? []).filter((mode) => mode < hz.high);
    modes.forEach((mode) => this.course(area, columns.map(() => waterfall.newest), () => mode, hz, modeColour(theme), 1.4));
    const labelled = this.orders(area, theme, columns, hz, hello?.teeth ?? 1);
    this.course(area, columns, (c) => c.chatter_hz, hz, theme.paper, 5);
    this.course(area, columns, (c) => c.chatter_hz, hz, theme.run.without, 2.4);
    modes.forEach((mode) => this.label(area, theme, t('hertz', { value: fixed(mode, 0) }), hz.at(mode), 'left', modeColour(theme)));
    labelled.forEach((k) => this.label(area, theme, `${fixed(k, 0)}×`, hz.at(k * this.now_hz), 'right', theme.text));
  }

  private get now_hz(): number {
    return (this.drawn?.rpm ?? 0) / 60;
  }

  /** Those that are far enough apart to be told apart, while they are; returns those that get a label. */
  private orders(area: Area, theme: Theme, columns: Columns, hz: Scale, teeth: number): number[] {
    const apart_hz = (APART_PX * hz.high) / (hz.at(0) - hz.at(hz.high));
    const steady = columns.map((c, i) => (c && Math.abs(c.rpm - (columns[i - 1]?.rpm ?? c.rpm)) < RUNS_UP * c.rpm ? c : undefined));
    area.pen.setLineDash([5, 3]);
    for (let k = 1; k * apart_hz < teeth * hz.high; ++k) {
      const tooth = k % teeth === 0;
      const least_hz = tooth ? apart_hz / teeth : apart_hz;
      this.course(area, steady, ({ rpm }) => (rpm / 60 < least_hz ? null : (k * rpm) / 60), hz, tooth ? toothOrders(theme) : spindleOrders(theme), tooth ? 1.1 : 0.8);
    }
    area.pen.setLineDash([]);
    const every = teeth * Math.ceil((LABEL_PX * apart_hz) / (APART_PX * teeth * this.now_hz));
    return Array.from({ length: Math.floor((0.98 * hz.high) / (every * this.now_hz)) || 0 }, (_, i) => (i + 1) * every);
  }

  /** A frequency over time, with the gaps of what is not known. */
  private course(area: Area, columns: Columns, of: (column: Heard) => Maybe, hz: Scale, colour: string, width: number): void {
    const { pen } = area;
    const { left, right } = inner(area);
    const wide = (right - left) / COLUMNS;
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    let joined = false;
    columns.forEach((c, i) => {
      const at = c ? of(c) : null;
      const known = at !== null && at <= hz.high;
      if (known) {
        const y = hz.at(at);
        if (!joined) pen.moveTo(left + i * wide, y);
        pen.lineTo(left + (i + 1) * wide, y);
      }
      joined = known;
    });
    pen.stroke();
  }

  private label(area: Area, theme: Theme, text: string, y: number, side: 'left' | 'right', colour: string): void {
    const { pen } = area;
    const { left, right } = inner(area);
    const wide = pen.measureText(text).width;
    const from = side === 'left' ? left + 5 : right - wide - 4;
    pen.fillStyle = theme.paper;
    pen.fillRect(from - 2, y - 7, wide + 4, 14);
    pen.fillStyle = colour;
    pen.textAlign = 'left';
    pen.textBaseline = 'middle';
    pen.fillText(text, from, y);
  }
}
