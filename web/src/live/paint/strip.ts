// SPDX-License-Identifier: Apache-2.0
// The last seconds of some samples, as on a strip chart. Missing data are a hatched gap.
import { fixed } from '../../frame/numbers';
import type { Theme } from '../../frame/theme';
import { niceAbove } from '../../plot/axes';
import { GAP_CYCLES, type Live, type SampleColumn } from '../state/live';
import type { Unit } from '../state/units';
import { t } from '../texts/texts';
import { type Area, Canvas, hatch, overColour } from './canvas';
import { type Scale, drawFrame, inner, scale } from './frame';

export interface Curve {
  column: SampleColumn;
  colour: (theme: Theme) => string;
  width?: number;
}

export interface StripOptions {
  name: string;
  label: string;
  seconds: number;
  unit: Unit;
  curves: readonly Curve[];
  /** Of |value|; what is above it is drawn in the colour of a fault. */
  limit?: () => number | undefined;
  /** Shown even if no value reaches it. */
  atLeast?: number;
}

/** Lowest and highest value of each pixel column. NaN: no value. */
interface Columns {
  low: Float64Array;
  high: Float64Array;
}

/** Column `at` reaches to the value, too; NaN leaves it as it is. */
export function widen({ low, high }: Columns, at: number, value: number): void {
  if (Number.isNaN(value)) {
    return;
  }
  // A comparison with NaN is false: the first value of a column is taken.
  if (!((low[at] as number) <= value)) low[at] = value;
  if (!((high[at] as number) >= value)) high[at] = value;
}

export class Strip {
  readonly canvas: Canvas;
  private columns: Columns = { low: new Float64Array(0), high: new Float64Array(0) };

  constructor(
    private readonly live: Live,
    private readonly options: StripOptions,
    resized: () => void,
  ) {
    this.canvas = new Canvas(options.name, options.label, resized);
  }

  draw(theme: Theme): void {
    const area = this.canvas.begin();
    if (!area) {
      return;
    }
    const { samples } = this.live;
    const { seconds, limit } = this.options;
    const box = inner(area);
    const now = samples.newest('t_s');
    const first = Number.isFinite(now) ? samples.from('t_s', now - seconds) : samples.size;
    const most = limit?.();
    const x = scale(-seconds, 0, box.left, box.right);
    const y = this.valueScale(first, most, box.bottom, box.top);
    if (most !== undefined) {
      this.drawLimit(area, theme, y, most);
    }
    drawFrame(area, theme, x, y, (value, text) => (value === 0 ? t('seconds', { value: text }) : text));
    this.drawGaps(area, theme, x, first, now);
    for (const curve of this.options.curves) {
      this.fill(curve.column, first, now, box.left, box.right);
      this.drawCurve(area, y, curve.colour(theme), curve.width ?? 1.5);
      if (most !== undefined) {
        this.drawOver(area, theme, y, most);
      }
    }
  }

  private valueScale(first: number, most: number | undefined, bottom: number, top: number): Scale {
    const { samples } = this.live;
    const { curves, unit, atLeast = 0 } = this.options;
    let [low, high] = [0, Math.max(atLeast, most === undefined ? 0 : most * 1.4)];
    for (const { column } of curves) {
      for (let i = first; i < samples.size; ++i) {
        const value = samples.at(column, i);
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    const end = niceAbove(unit.of(high));
    // A signed error swings to both sides alike.
    const from = low < -1e-9 ? -niceAbove(Math.max(unit.of(high), unit.of(-low))) : 0;
    return scale(from, from < 0 ? -from : end, bottom, top);
  }

  private drawLimit({ pen, width, height }: Area, theme: Theme, y: Scale, most: number): void {
    const { left, right, top, bottom } = inner({ pen, width, height });
    const { unit } = this.options;
    const high = y.at(unit.of(most));
    const low = y.low < 0 ? y.at(unit.of(-most)) : bottom;
    pen.fillStyle = theme.run.with;
    pen.globalAlpha = 0.1;
    pen.fillRect(left, high, right - left, low - high);
    pen.globalAlpha = 1;
    pen.strokeStyle = theme.limit;
    pen.lineWidth = 1.2;
    pen.setLineDash([6, 4]);
    pen.beginPath();
    for (const at of y.low < 0 ? [high, low] : [high]) {
      pen.moveTo(left, Math.max(at, top));
      pen.lineTo(right, Math.max(at, top));
    }
    pen.stroke();
    pen.setLineDash([]);
    pen.fillStyle = theme.text;
    pen.textAlign = 'left';
    pen.textBaseline = 'bottom';
    pen.fillText(`${fixed(unit.of(most), unit.decimals)} ${unit.name}`, left + 6, high - 3);
  }

  private drawGaps({ pen, width, height }: Area, theme: Theme, x: Scale, first: number, now: number): void {
    const { samples, hello } = this.live;
    const { left, top, bottom } = inner({ pen, width, height });
    const longest = GAP_CYCLES * (hello?.cycle_s ?? 0.001);
    for (let i = Math.max(first, 1); i < samples.size; ++i) {
      const [from, to] = [samples.at('t_s', i - 1), samples.at('t_s', i)];
      if (to - from > longest) {
        const start = Math.max(x.at(from - now), left);
        hatch(pen, theme, start, top, Math.max(x.at(to - now) - start, 2), bottom - top);
      }
    }
  }

  private fill(column: SampleColumn, first: number, now: number, left: number, right: number): void {
    const { samples } = this.live;
    const { seconds, unit } = this.options;
    const count = Math.max(Math.ceil(right - left), 1);
    if (this.columns.low.length !== count) {
      this.columns = { low: new Float64Array(count), high: new Float64Array(count) };
    }
    const { low, high } = this.columns;
    low.fill(NaN);
    high.fill(NaN);
    for (let i = first; i < samples.size; ++i) {
      const value = unit.of(samples.at(column, i));
      const at = Math.min(Math.max(Math.floor(((samples.at('t_s', i) - now) / seconds + 1) * (count - 1)), 0), count - 1);
      widen(this.columns, at, value);
    }
  }

  private drawCurve({ pen, width, height }: Area, y: Scale, colour: string, thickness: number): void {
    const { left } = inner({ pen, width, height });
    const { low, high } = this.columns;
    pen.strokeStyle = colour;
    pen.lineWidth = thickness;
    pen.beginPath();
    let drawing = false;
    for (let i = 0; i < low.length; ++i) {
      const [a, b] = [low[i] as number, high[i] as number];
      if (Number.isNaN(a)) {
        drawing = false;
        continue;
      }
      if (!drawing) {
        pen.moveTo(left + i, y.at(a));
      }
      pen.lineTo(left + i, y.at(a));
      pen.lineTo(left + i, y.at(b));
      drawing = true;
    }
    pen.stroke();
  }

  private drawOver({ pen, width, height }: Area, theme: Theme, y: Scale, most: number): void {
    const { left } = inner({ pen, width, height });
    const { low, high } = this.columns;
    const limit = this.options.unit.of(most);
    pen.strokeStyle = overColour(theme);
    pen.lineWidth = 2;
    pen.beginPath();
    for (let i = 0; i < low.length; ++i) {
      if ((high[i] as number) > limit) {
        pen.moveTo(left + i, y.at(limit));
        pen.lineTo(left + i, y.at(high[i] as number) - 1);
      }
      if ((low[i] as number) < -limit) {
        pen.moveTo(left + i, y.at(-limit));
        pen.lineTo(left + i, y.at(low[i] as number) + 1);
      }
    }
    pen.stroke();
  }
}
