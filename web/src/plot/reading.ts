// SPDX-License-Identifier: Apache-2.0
// What lies under the pointer.
import type { Maybe } from '../frame/data';
import { escapeHtml } from '../frame/html';
import { plain } from '../frame/numbers';
import type { echarts } from './echarts';
import { rising } from './layers';
import type { Plot } from './drawn';
import { heightOf, valueAtHeight } from './logarithmic';
import { nearestIndex } from './thin';

/** HTML, and the point that it speaks of. */
export interface Reading {
  html: string;
  at?: [number, number];
}

const REACH_PX = 14;

function line(x: readonly Maybe[], y: readonly Maybe[], at: number): Maybe {
  const i = nearestIndex(x, at);
  return i < 0 ? null : (y[i] ?? null);
}

/** The nearest values of the named lines and bands. */
export function valuesAt(plot: Plot, x: number): string | undefined {
  const rows = plot.layers.flatMap((layer): string[] => {
    if (layer.name === undefined || (layer.kind !== 'line' && layer.kind !== 'band') || !rising(layer.x)) {
      return [];
    }
    const of = (values: readonly Maybe[]) => plain(line(layer.x, values, x));
    return [`${escapeHtml(layer.name)} <b>${layer.kind === 'line' ? of(layer.y) : `${of(layer.low)} … ${of(layer.high)}`}</b>`];
  });
  return rows.length === 0 ? undefined : [`${escapeHtml(plot.x.name)} <b>${plain(x)}</b>`, ...rows].join('<br>');
}

/** A box beside the pointer and a ring about what it speaks of. */
export function follow(host: HTMLElement, chart: echarts.ECharts, plotted: () => Plot | undefined): void {
  const made = (name: string) => {
    const found = host.appendChild(document.createElement('div'));
    found.className = name;
    return found;
  };
  const [tip, ring] = [made('tip'), made('ring')];
  const hide = () => {
    tip.style.display = ring.style.display = 'none';
  };
  const show = (px: number, py: number, plot: Plot, reading: Reading) => {
    tip.innerHTML = reading.html;
    tip.style.display = 'block';
    const right = px + 16 + tip.offsetWidth < host.clientWidth;
    tip.style.left = `${right ? px + 16 : Math.max(0, px - 16 - tip.offsetWidth)}px`;
    tip.style.top = `${Math.max(0, py - tip.offsetHeight - 8)}px`;
    const [x, y] = reading.at ? (chart.convertToPixel({ gridIndex: 0 }, [reading.at[0], heightOf(plot.y, reading.at[1])]) as number[]) : [];
    ring.style.cssText = x === undefined ? 'display:none' : `display:block;left:${x}px;top:${y}px`;
  };
  chart.getZr().on('mousemove', (e: { offsetX: number; offsetY: number }) => {
    const at = [e.offsetX, e.offsetY];
    const plot = plotted();
    if (!plot || !chart.containPixel({ gridIndex: 0 }, at)) {
      hide();
      return;
    }
    const [x = 0, y = 0] = chart.convertFromPixel({ gridIndex: 0 }, at) as number[];
    const [beside = 0] = chart.convertFromPixel({ gridIndex: 0 }, [e.offsetX + REACH_PX, e.offsetY]) as number[];
    const reading = plot.readout ? plot.readout(x, valueAtHeight(plot.y, y), Math.abs(beside - x)) : valuesAt(plot, x);
    if (reading === undefined) {
      hide();
    } else {
      show(e.offsetX, e.offsetY, plot, typeof reading === 'string' ? { html: reading } : reading);
    }
  });
  chart.getZr().on('globalout', hide);
  chart.on('datazoom', hide);
}
