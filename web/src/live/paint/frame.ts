// SPDX-License-Identifier: Apache-2.0
// The frame around a live plot: its grid and the figures along its edges.
import { fixed } from '../../frame/numbers';
import type { Theme } from '../../frame/theme';
import { niceStep } from '../../plot/axes';
import type { Area } from './canvas';

export const MARGIN = { left: 46, right: 10, top: 10, bottom: 22 };

export interface Scale {
  low: number;
  high: number;
  /** Pixels of a value. */
  at: (value: number) => number;
}

export function scale(low: number, high: number, from_px: number, to_px: number): Scale {
  const per = (to_px - from_px) / (high - low || 1);
  return { low, high, at: (value) => from_px + (value - low) * per };
}

export function inner({ width, height }: Area): { left: number; right: number; top: number; bottom: number } {
  return { left: MARGIN.left, right: width - MARGIN.right, top: MARGIN.top, bottom: height - MARGIN.bottom };
}

/** Round multiples within the scale. */
export function ticks({ low, high }: Scale, count: number): { value: number; text: string }[] {
  const step = niceStep(high - low, count);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const out: { value: number; text: string }[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) {
    out.push({ value: k * step, text: fixed(k * step, decimals) });
  }
  return out;
}

const TICK_WIDTH_PX = 80;
const TICK_HEIGHT_PX = 36;

export function drawFrame(area: Area, theme: Theme, x: Scale, y: Scale, xText: (value: number, text: string) => string = (_, text) => text): void {
  const { pen } = area;
  const { left, right, top, bottom } = inner(area);
  pen.strokeStyle = theme.rule;
  pen.fillStyle = theme.faint;
  pen.lineWidth = 1;
  pen.textBaseline = 'middle';
  pen.textAlign = 'right';
  pen.beginPath();
  for (const { value, text } of ticks(y, Math.max((bottom - top) / TICK_HEIGHT_PX, 2))) {
    const at = Math.round(y.at(value)) + 0.5;
    pen.moveTo(left, at);
    pen.lineTo(right, at);
    pen.fillText(text, left - 6, at);
  }
  pen.textBaseline = 'top';
  for (const { value, text } of ticks(x, Math.max((right - left) / TICK_WIDTH_PX, 2))) {
    const at = Math.round(x.at(value)) + 0.5;
    const label = xText(value, text);
    pen.moveTo(at, bottom);
    pen.lineTo(at, bottom + 4);
    pen.textAlign = at + pen.measureText(label).width / 2 > area.width ? 'right' : 'center';
    pen.fillText(label, at, bottom + 7);
  }
  pen.stroke();
  pen.strokeStyle = theme.faint;
  pen.beginPath();
  pen.moveTo(left + 0.5, top);
  pen.lineTo(left + 0.5, bottom + 0.5);
  pen.lineTo(right, bottom + 0.5);
  pen.stroke();
}
