// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { columnsOfPlot, csvOf } from '../../src/plot/csv';
import type { Plot } from '../../src/plot/drawn';
import type { Layer } from '../../src/plot/layers';

const t = [0, 1, 2];
const of = (layers: Layer[]): Plot => ({ title: 'T', x: { name: 'time in s' }, y: { name: 'error in µm' }, layers });
const line = (name: string, x: number[], y: (number | null)[]): Layer => ({ kind: 'line', name, x, y, colour: 'red' });

describe('a CSV', () => {
  // RFC 4180: fields with commas, quotes or line breaks are quoted, quotes doubled.
  it('is quoted as RFC 4180 says', () => {
    expect(csvOf([{ head: 'a, b', values: ['say "x"', 'one\ntwo', 'plain'] }])).toBe('"a, b"\n"say ""x"""\n"one\ntwo"\nplain\n');
  });
  it('leaves gaps empty and short columns short', () => {
    expect(csvOf([{ head: 'a', values: [1, null, 3] }, { head: 'b', values: [0.5] }])).toBe('a,b\n1,0.5\n,\n3,\n');
  });
  it('of nothing has its empty head alone', () => expect(csvOf([])).toBe('\n'));
  it('keeps every digit of a value', () => expect(csvOf([{ head: 'a', values: [0.1 + 0.2, 1e-9, -12345.678] }])).toBe('a\n0.30000000000000004\n1e-9\n-12345.678\n'));
  it('has heads that every spreadsheet reads, whatever encoding it guesses', () => {
    const head = csvOf([{ head: 'ρ of x in µm, ±2 mm/s² at 5 °C – m³', values: [] }]);
    expect(head).toBe('"rho of x in um, +/-2 mm/s2 at 5 deg C - m3"\n');
  });
});

describe('the columns of a plot', () => {
  it('share one x where layers share it', () => {
    const heads = columnsOfPlot(of([line('without', t, [1, 2, 3]), line('with', [...t], [4, 5, 6])])).map((c) => c.head);
    expect(heads).toEqual(['time in s', 'error in µm: without', 'error in µm: with']);
  });
  it('have another x where a layer has its own, in length or in value', () => {
    const columns = columnsOfPlot(of([line('a', t, [1, 2, 3]), line('b', [0, 1], [4, 5]), line('c', [0, 1, 9], [6, 7, 8])]));
    expect(columns.filter((c) => c.head === 'time in s').map((c) => c.values)).toEqual([t, [0, 1], [0, 1, 9]]);
  });
  it('keep a later layer beside the x that it shares', () => {
    const columns = columnsOfPlot(of([line('a', t, [1, 2, 3]), line('b', [5], [4]), line('c', t, [6, 7, 8])]));
    expect(columns.map((c) => c.head.replace('error in µm: ', ''))).toEqual(['time in s', 'a', 'c', 'time in s', 'b']);
  });
  it('hold both edges of a band and the places of dots', () => {
    const columns = columnsOfPlot(of([
      { kind: 'band', name: 'band', x: t, low: [0, 0, 0], high: [1, 1, 1], colour: 'red', opacity: 0.2 },
      { kind: 'dots', name: 'peak', dots: [{ x: 1, y: 7 }], colour: 'red', size: 4 },
    ]));
    expect(columns.map((c) => c.head)).toEqual(['time in s', 'error in µm: band: low', 'error in µm: band: high', 'time in s', 'error in µm: peak']);
    expect(columns.at(-1)?.values).toEqual([7]);
  });
  it('leave out what only decorates: rules, spans and layers without a name', () => {
    const columns = columnsOfPlot(of([
      { kind: 'rules', name: 'limit', axis: 'y', at: [1], colour: 'red' },
      { kind: 'spans', name: 'part', spans: [[0, 1]], colour: 'red', opacity: 0.1 },
      { kind: 'line', x: t, y: t, colour: 'red' },
    ]));
    expect(columns).toEqual([]);
  });
});
