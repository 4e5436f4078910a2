// SPDX-License-Identifier: Apache-2.0
// The values behind a plot, for a spreadsheet.
import type { Maybe } from '../frame/data';
import type { Layer } from './layers';
import type { Plot } from './drawn';

export interface Columns {
  head: string;
  values: readonly (Maybe | string)[];
}

interface Block {
  x: readonly Maybe[];
  columns: Columns[];
}

/** Spreadsheets guess encodings, so heads keep to ASCII. */
function ascii(text: string): string {
  return text.replace(/µ/g, 'u').replace(/°/g, 'deg ').replace(/²/g, '2').replace(/³/g, '3').replace(/ρ/g, 'rho').replace(/±/g, '+/-').replace(/[−–]/g, '-');
}

const cell = (value: Maybe | string | undefined): string => {
  const text = value === null || value === undefined ? '' : typeof value === 'string' ? ascii(value) : String(value);
  return /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
};

function columnsOf(layer: Layer): Block | undefined {
  const name = layer.name;
  if (name === undefined) {
    return undefined;
  }
  switch (layer.kind) {
    case 'line':
      return { x: layer.x, columns: [{ head: name, values: layer.y }] };
    case 'band':
      return { x: layer.x, columns: [{ head: `${name}: low`, values: layer.low }, { head: `${name}: high`, values: layer.high }] };
    case 'dots':
      return { x: layer.dots.map((d) => d.x), columns: [{ head: name, values: layer.dots.map((d) => d.y) }] };
    default:
      return undefined;
  }
}

const same = (a: readonly Maybe[], b: readonly Maybe[]) => a === b || (a.length === b.length && a.every((v, i) => v === b[i]));

/** The columns of the named layers; layers with the same x share one column of it. */
export function columnsOfPlot(plot: Plot): Columns[] {
  const blocks: Block[] = [];
  for (const layer of plot.layers) {
    const made = columnsOf(layer);
    const shared = made && blocks.find((b) => same(b.x, made.x));
    if (shared) shared.columns.push(...made.columns);
    else if (made) blocks.push(made);
  }
  return blocks.flatMap((b) => [{ head: plot.x.name, values: b.x }, ...b.columns.map((c) => ({ ...c, head: `${plot.y.name}: ${c.head}` }))]);
}

export function csvOf(columns: readonly Columns[]): string {
  const rows = Math.max(0, ...columns.map((c) => c.values.length));
  const lines = [columns.map((c) => cell(c.head)).join(',')];
  for (let i = 0; i < rows; ++i) {
    lines.push(columns.map((c) => cell(c.values[i])).join(','));
  }
  return `${lines.join('\n')}\n`;
}
