// SPDX-License-Identifier: Apache-2.0
// The tip at the pointer.
import type { Maybe } from '../frame/data';
import { escapeHtml } from '../frame/html';
import { plain } from '../frame/numbers';
import type { echarts } from './echarts';
import { rising } from './layers';
import type { Plot } from './drawn';
import { heightOf, valueAtHeight } from './logarithmic';
import { nearestIndex } from './thin';

/** HTML, and the point that it describes. */
export interface Reading {
  html: string;
  at?: [number, number];
}

/** Where the pointer is, then one line for each thing there; HTML. */
export function reading(where: string, lines: readonly string[]): string {
  return [`<b>${where}</b>`, ...lines].join('<br>');
}

/** The same as a table: a row for each quantity, a column for each curve. */
export function readingTable(where: string, columns: readonly string[], rows: readonly { name: string; values: readonly string[] }[]): string {
  const cells = (values: readonly string[]) => values.map((v) => `<td class="n">${v}</td>`).join('');
  return `<table class="tooltip"><tr><th>${where}</th>${columns.map((c) => `<th>${c}</th>`).join('')}</tr>${rows.map((r) => `<tr><td>${r.name}</td>${cells(r.values)}</tr>`).join('')}</table>`;
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

/** A box beside the pointer and a ring around the point that it describes. */
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
  const show = (px: number, py: number, plot: Plot, { html, at }: Reading) => {
    tip.innerHTML = html;
    tip.style.display = 'block';
    const right = px + 16 + tip.offsetWidth < host.clientWidth;
    tip.style.left = `${right ? px + 16 : Math.max(0, px - 16 - tip.offsetWidth)}px`;
    tip.style.top = `${Math.max(0, py - tip.offsetHeight - 8)}px`;
    const [x, y] = at ? (chart.convertToPixel({ gridIndex: 0 }, [at[0], heightOf(plot.y, at[1])]) as number[]) : [];
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
    const read = plot.readout ? plot.readout(x, valueAtHeight(plot.y, y), Math.abs(beside - x)) : valuesAt(plot, x);
    if (read === undefined) {
      hide();
    } else {
      show(e.offsetX, e.offsetY, plot, typeof read === 'string' ? { html: read } : read);
    }
  });
  chart.getZr().on('globalout', hide);
  chart.on('datazoom', hide);
}
