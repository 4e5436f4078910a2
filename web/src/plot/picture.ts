// SPDX-License-Identifier: Apache-2.0
// A plot as a picture of its own, with its title, the name of its y axis, key and colour scale above it.
import { capital } from '../frame/html';
import type { Theme } from '../frame/theme';
import type { echarts } from './echarts';
import { FONT } from '../frame/looks';
import { type ColourScale, type Key, keysOf } from './key';
import type { Plot } from './drawn';

const SHARPNESS = 2;
const LINE_PX = 20;
const PAD_PX = 10;

type Pen = CanvasRenderingContext2D;

function mark(pen: Pen, key: Key, x: number, y: number): void {
  pen.strokeStyle = pen.fillStyle = key.colour;
  pen.lineWidth = 2.5;
  pen.setLineDash(key.mark === 'dashed' ? [6, 3] : []);
  pen.beginPath();
  pen.globalAlpha = key.opacity ?? 1;
  if (key.mark === 'area') pen.fillRect(x, y - 5, 18, 10);
  else if (key.mark === 'dot' || key.mark === 'hoop') pen.arc(x + 9, y, 4.5, 0, 7);
  else {
    pen.moveTo(x, y);
    pen.lineTo(x + 18, y);
  }
  if (key.mark === 'dot') pen.fill();
  else if (key.mark !== 'area') pen.stroke();
  pen.globalAlpha = 1;
  pen.setLineDash([]);
}

/** The key, wrapped into lines; returns its height. With `draw` false it only measures. */
function keys(pen: Pen, all: readonly Key[], theme: Theme, width: number, top: number, draw: boolean): number {
  let [x, y] = [PAD_PX, top + LINE_PX / 2];
  for (const key of all) {
    const wide = 24 + pen.measureText(key.name).width;
    if (x > PAD_PX && x + wide > width - PAD_PX) {
      [x, y] = [PAD_PX, y + LINE_PX];
    }
    if (draw) {
      mark(pen, key, x, y);
      pen.fillStyle = theme.text;
      pen.fillText(key.name, x + 24, y);
    }
    x += wide + 16;
  }
  return all.length === 0 ? 0 : y + LINE_PX / 2 - top;
}

function scale(pen: Pen, what: ColourScale, theme: Theme, width: number, top: number): void {
  const cell = Math.min(44, (width - 2 * PAD_PX) / Math.max(what.cells.length, 1));
  pen.fillStyle = theme.faint;
  pen.fillText(what.title, PAD_PX, top + LINE_PX / 2);
  what.cells.forEach((c, i) => {
    const x = PAD_PX + i * cell;
    pen.fillStyle = c.colour;
    pen.fillRect(x, top + LINE_PX, cell, 9);
    pen.fillStyle = theme.text;
    if (c.marked) pen.fillRect(x - 1, top + LINE_PX - 2, 2, 14);
    pen.textAlign = 'right';
    pen.fillText(c.upTo, x + cell, top + 1.5 * LINE_PX + 9);
    pen.textAlign = 'left';
  });
}

export function picture(chart: echarts.ECharts, plot: Plot, theme: Theme): HTMLCanvasElement {
  const body = chart.renderToCanvas({ pixelRatio: SHARPNESS, backgroundColor: theme.paper });
  const width = chart.getWidth();
  const out = document.createElement('canvas');
  const pen = out.getContext('2d') as Pen;
  const prepare = () => {
    pen.font = `12px ${FONT}`;
    pen.textBaseline = 'middle';
  };
  prepare();
  const all = [...keysOf(plot.layers), ...(plot.scale?.beside ? [plot.scale.beside] : [])];
  const keyHeight = keys(pen, all, theme, width, 0, false);
  const scaleHeight = plot.scale ? 3 * LINE_PX : 0;
  const head = PAD_PX + 2 * LINE_PX;
  const top = head + keyHeight + scaleHeight;
  out.width = width * SHARPNESS;
  out.height = (top + chart.getHeight()) * SHARPNESS;
  pen.scale(SHARPNESS, SHARPNESS);
  pen.fillStyle = theme.paper;
  pen.fillRect(0, 0, out.width, out.height);
  prepare();
  pen.fillStyle = theme.text;
  pen.font = `600 13px ${FONT}`;
  pen.fillText(plot.title, PAD_PX, PAD_PX + LINE_PX / 2);
  prepare();
  pen.fillStyle = theme.faint;
  pen.fillText(capital(plot.y.name), PAD_PX, PAD_PX + 1.5 * LINE_PX);
  keys(pen, all, theme, width, head, true);
  if (plot.scale) {
    scale(pen, plot.scale, theme, width, head + keyHeight);
  }
  pen.drawImage(body, 0, top, width, chart.getHeight());
  return out;
}
