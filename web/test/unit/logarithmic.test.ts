// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { theme } from '../../src/frame/theme';
import { axisOption } from '../../src/plot/axes';
import { columnsOfPlot } from '../../src/plot/csv';
import type { Plot } from '../../src/plot/drawn';
import { keysOf } from '../../src/plot/key';
import type { LayerOf } from '../../src/plot/layers';
import { heightOf, valueAtHeight, withDecades } from '../../src/plot/logarithmic';
import { valuesAt } from '../../src/plot/reading';

const LIGHT = theme(true);
const receptance: Plot = {
  title: 'Magnitude',
  x: { name: 'frequency in Hz', min: 0, max: 3 },
  y: { name: 'magnitude in µm/N', log: true },
  layers: [
    { kind: 'line', name: 'measured', x: [0, 1, 2, 3], y: [0.004, 0.5, 12, null], colour: 'red' },
    { kind: 'band', name: 'scatter', x: [0, 1], low: [0, 0.4], high: [0.005, 0.6], colour: 'red', opacity: 0.2 },
    { kind: 'dots', name: 'mode', dots: [{ x: 2, y: 10 }, { x: 3, y: 0 }], colour: 'blue', size: 4 },
    { kind: 'rules', at: [0.1, -1], axis: 'y', colour: 'grey' },
    { kind: 'rules', at: [1.5], axis: 'x', colour: 'grey' },
  ],
};

describe('a logarithmic axis', () => {
  const shown = withDecades(receptance, LIGHT);
  const of = (kind: string, nth = 0) => shown.layers.filter((l) => l.kind === kind)[nth];

  it('is drawn over whole decades, with every value that has a logarithm', () => {
    expect([shown.y.min, shown.y.max]).toEqual([-3, 2]);
    expect(of('line')).toMatchObject({ y: [Math.log10(0.004), Math.log10(0.5), Math.log10(12), null] });
    expect(of('band')).toMatchObject({ low: [null, Math.log10(0.4)], high: [Math.log10(0.005), Math.log10(0.6)] });
    expect(of('dots')).toMatchObject({ dots: [{ x: 2, y: 1 }] });
    expect(of('rules', 1)).toMatchObject({ at: [-1] });
    expect(of('rules', 2)).toMatchObject({ at: [1.5] });
  });

  it('has lines at 2 to 9 of each decade', () => {
    expect(of('rules')).toMatchObject({ axis: 'y' });
    const at = (of('rules') as LayerOf<'rules'>).at;
    expect(at.length).toBe(5 * 8);
    expect(at[0]).toBeCloseTo(Math.log10(0.002), 12);
    expect(at.at(-1)).toBeCloseTo(Math.log10(90), 12);
  });

  it('is labelled at decades, by their true values', () => {
    const { axisLabel, minInterval } = axisOption(shown.y, LIGHT, 20);
    expect(minInterval).toBe(1);
    expect([-3, -1, 0, 2].map(axisLabel.formatter)).toEqual(['0.001', '0.1', '1', '100']);
  });

  it('keeps the true values in the key, in the reading and in the CSV', () => {
    expect(keysOf(receptance.layers).map((k) => k.name)).toEqual(['measured', 'scatter', 'mode']);
    expect(valuesAt(receptance, 2.1)).toContain('measured <b>12</b>');
    expect(columnsOfPlot(receptance)[1]).toEqual({ head: 'magnitude in µm/N: measured', values: [0.004, 0.5, 12, null] });
  });

  it('is a decade long at least, and an even axis is left as it is', () => {
    const flat = withDecades({ ...receptance, layers: [{ kind: 'line', x: [0, 1], y: [1, 1], colour: 'red' }] }, LIGHT);
    expect([flat.y.min, flat.y.max]).toEqual([0, 1]);
    const even = { ...receptance, y: { name: 'magnitude' } };
    expect(withDecades(even, LIGHT)).toBe(even);
  });

  it('leads from a value to its place and back', () => {
    for (const axis of [{ name: 'even' }, { name: 'log', log: true }]) {
      expect(valueAtHeight(axis, heightOf(axis, 0.037))).toBeCloseTo(0.037, 12);
    }
  });
});
