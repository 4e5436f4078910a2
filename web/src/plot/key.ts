// SPDX-License-Identifier: Apache-2.0
// What a plot's curves and colours mean, on the page and in the saved picture.
import { escapeHtml } from '../frame/html';
import type { Layer } from './layers';

export type Mark = 'line' | 'dashed' | 'area' | 'dot' | 'hoop';

export interface Key {
  name: string;
  colour: string;
  mark: Mark;
  /** That of the area in the plot. */
  opacity?: number;
}

/** Colours of a quantity; each is for values up to the number under its right edge. */
export interface ColourScale {
  title: string;
  cells: readonly { colour: string; upTo: string; /** An upright mark at its left edge. */ marked?: boolean }[];
  /** A line outside the scale. */
  beside?: Key;
}

function markOf(layer: Layer): Mark {
  switch (layer.kind) {
    case 'band':
    case 'spans':
      return 'area';
    case 'dots':
      return layer.hollow ? 'hoop' : 'dot';
    case 'line':
    case 'rules':
      return layer.dashed ? 'dashed' : 'line';
    default:
      return 'line';
  }
}

/** A fainter swatch cannot be seen. */
const LEAST_OPACITY = 0.15;

/** Each name once. */
export function keysOf(layers: readonly Layer[]): Key[] {
  const keys = new Map<string, Key>();
  for (const layer of layers) {
    if (layer.name !== undefined && !layer.quiet && layer.kind !== 'raster' && !keys.has(layer.name)) {
      const area = layer.kind === 'band' || layer.kind === 'spans';
      keys.set(layer.name, { name: layer.name, colour: layer.colour, mark: markOf(layer), ...(area ? { opacity: Math.max(layer.opacity, LEAST_OPACITY) } : {}) });
    }
  }
  return [...keys.values()];
}

/** Colours are data until `ink` sets them: the live page's content-security policy forbids styles in HTML. */
export function keyLine(keys: readonly Key[]): string {
  return keys.map((k) => `<span class="key"><i class="${k.mark}" data-ink="${k.colour}"${k.opacity === undefined ? '' : ` data-opacity="${k.opacity}"`}></i>${escapeHtml(k.name)}</span>`).join('');
}

export function scaleLine(scale: ColourScale): string {
  const cells = scale.cells.map((c) => `<span${c.marked ? ' class="marked"' : ''}><i data-ink="${c.colour}"></i><em>${escapeHtml(c.upTo)}</em></span>`).join('');
  return `<span class="scale-title">${escapeHtml(scale.title)}</span><span class="scale">${cells}</span>${scale.beside ? keyLine([scale.beside]) : ''}`;
}

/** Gives the swatches within their colours. */
export function ink(where: HTMLElement): void {
  for (const swatch of where.querySelectorAll<HTMLElement>('[data-ink]')) {
    swatch.style.setProperty('--ink', swatch.dataset['ink'] ?? '');
    swatch.style.opacity = swatch.dataset['opacity'] ?? '';
  }
}
