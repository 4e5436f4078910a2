// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { counted, heldPercent, measure, percent } from '../../src/frame/numbers';
import { figures, numbers } from '../../src/frame/table';
import { reading, readingTable } from '../../src/plot/reading';
import { largestAt, largestSize, minus, plus, quantile, scaled } from '../../src/plot/values';

describe('arithmetic on columns', () => {
  it('makes a gap of a gap', () => {
    expect(scaled([1, null, -3], 2)).toEqual([2, null, -6]);
    expect(plus([1, 2, null, 4], [10, null, 30], 0.5)).toEqual([6, null, null, null]);
    expect(minus([5, 5], [2, 7])).toEqual([3, -2]);
  });
  it('finds the largest size whatever its sign', () => {
    expect(largestAt([1, null, -9, 9])).toBe(2);
    expect(largestSize([1, null, -9, 8])).toBe(9);
    expect([largestAt([]), largestSize([null])]).toEqual([0, 0]);
  });
  it('has quantiles that are values', () => {
    expect([0, 0.5, 0.99, 1].map((share) => quantile([4, null, 1, 3, 2], share))).toEqual([1, 2, 3, 4]);
    expect(quantile([null], 0.5)).toBeUndefined();
  });
});

describe('a number with its unit', () => {
  it('stays with it, and is a bare dash if it is missing', () => {
    expect(measure(12.345, 1, 'mm')).toBe('12.3\u00a0mm');
    expect([measure(null, 1, 'mm'), percent(null), heldPercent(null)]).toEqual(['–', '–', '–']);
    expect(percent(0.976)).toBe('97.6\u00a0%');
  });
  it('never rounds a share up to all', () => {
    expect([1, 0.999_99, 0.57, 0].map(heldPercent)).toEqual(['100\u00a0%', '99.99\u00a0%', '57.00\u00a0%', '0.00\u00a0%']);
  });
  it('counts one and many', () => expect([0, 1, 2].map((n) => counted(n, 'axis', 'axes'))).toEqual(['0 axes', '1 axis', '2 axes']));
});

describe('tables of numbers', () => {
  it('name each row in their first column', () => {
    const html = numbers('n', ['Axis', 'RMS'], [['Z', '0.3']]);
    expect(html).toContain('<th scope="row" data-label="Axis"><span>Z</span></th>');
    expect(html).toContain('<td class="n" data-label="RMS"><span>0.3</span></td>');
  });
  it('show labels as text and values as HTML', () => {
    expect(figures([{ label: '<b>', value: '<i>1</i>' }])).toMatch(/&#60;b&#62;.*<i>1<\/i>/);
  });
});

describe('the tip at the pointer', () => {
  it('says where it is, and a line for each thing there', () => {
    expect(reading('2 h', ['a 1', 'b 2'])).toBe('<b>2 h</b><br>a 1<br>b 2');
    expect(readingTable('2 mm', ['without', 'with'], [{ name: 'line', values: ['3', '4'] }])).toContain('<tr><td>line</td><td class="n">3</td><td class="n">4</td></tr>');
  });
});
