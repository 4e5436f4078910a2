// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { buttons, capital, choices, escapeHtml, none, section } from '../../src/frame/html';
import { digits, plain, short } from '../../src/frame/numbers';
import { numeric, table, valued } from '../../src/frame/table';

const count = (html: string, piece: string) => html.split(piece).length - 1;

describe('a table', () => {
  const grouped = table({
    id: 'g',
    columns: [{ head: 'Axis' }, numeric('RMS', 'before'), numeric('max', 'before'), numeric('RMS', 'after')],
    rows: [['X', '1', '2', '3']],
  });
  it('has one head over neighbours of one group', () => {
    expect(grouped).toContain('<tr class="groups"><th colspan="1"></th><th colspan="2">before</th><th colspan="1">after</th></tr>');
  });
  it('marks where a group begins, in head and body', () => expect(count(grouped, 'class="n first"')).toBe(4));
  it('names group and column in each cell, for narrow screens', () => {
    expect(grouped).toContain('data-label="before, max"');
    expect(grouped).toContain('data-label="after, RMS"');
  });
  it('has no row of groups where there are none', () => expect(table({ id: 'a', columns: [{ head: 'a' }], rows: [] })).not.toContain('groups'));

  it('sorts by true values, not by what is shown', () => {
    const html = table({ id: 's', sortable: true, columns: [{ head: 'a' }, numeric('b')], rows: [['x', valued('≥ 1.2', 1.23456)], ['y', valued('–', null)]] });
    expect(html).toContain('data-sort="1.23456"');
    expect(html).toContain('data-sort=""');
    expect(count(html, 'class="sort"')).toBe(2);
  });
  it('gives no button to a head without text', () => expect(count(table({ id: 's', sortable: true, columns: [{ head: '' }, { head: 'b' }], rows: [] }), 'class="sort"')).toBe(1));
  it('says by which column its rows come sorted', () => {
    const html = table({ id: 's', columns: [{ head: 'a' }, numeric('b')], rows: [], sorted: 1 });
    expect(count(html, 'aria-sort="descending"')).toBe(1);
    expect(html.indexOf('aria-sort')).toBeGreaterThan(html.indexOf('>a<'));
  });
  it('shows what a program wrote as text', () => {
    const html = table({ id: 'e', columns: [{ head: '<i>' }], rows: [['<img src=x onerror=alert(1)>']] });
    expect(html).not.toMatch(/<img|<i>/);
  });
});

describe('HTML', () => {
  // The five characters that OWASP names for element content and quoted attributes.
  it('has none of the five characters that end text or an attribute', () => {
    expect(escapeHtml(`a<b>&"c"'d'`)).toBe('a&#60;b&#62;&#38;&#34;c&#34;&#39;d&#39;');
    expect(escapeHtml('100 µm – ±5 °C')).toBe('100 µm – ±5 °C');
  });
  it('presses exactly the chosen button', () => {
    const html = buttons('q', 'Quantity', [['v', 'Velocity'], ['a', 'Acceleration']], 'a');
    expect(html).toContain('data-value="v" aria-pressed="false"');
    expect(html).toContain('data-value="a" aria-pressed="true"');
  });
  it('selects exactly the chosen option', () => {
    const html = choices('q', 'Sensor', [['0', 'a "b"'], ['1', 'c']], '1');
    expect(html).toContain('<option value="1" selected>c</option>');
    expect(count(html, ' selected')).toBe(1);
    expect(html).toContain('a &#34;b&#34;');
  });
  it('has a hint and controls only where there are any', () => {
    expect(section('T', '<p>b</p>')).toBe('<section><h2>T</h2><p>b</p></section>');
    expect(section('T', 'b', 'why', '<x>')).toBe('<section><div class="bar-head"><h2>T</h2><div class="controls"><x></div></div><p class="hint">why</p>b</section>');
    expect([none('No data.'), none('No data.', 'n')]).toEqual(['<p class="none">No data.</p>', '<p class="none" id="n">No data.</p>']);
  });
  it('begins a sentence with a capital', () => expect(['position of X', ''].map(capital)).toEqual(['Position of X', '']));
});

describe('significant digits', () => {
  it('are as many as asked for, with a power of ten only far from one', () => {
    expect([0.000123456, 99_999, 100_000, 0.00009999].map((v) => digits(v))).toEqual(['0.000123', '99999', '1.00·10⁵', '1.00·10⁻⁴']);
    expect([1.005, 0.5, 12, 123.4].map((v) => digits(v, 2))).toEqual(['1.0', '0.50', '12', '123']);
  });
  it('have a true minus on the number and on the power', () => expect([-0.5, -2e-7].map((v) => digits(v, 2))).toEqual(['−0.50', '−2.0·10⁻⁷']));
  it('are a dash for what is no number', () => expect([null, undefined, NaN, -Infinity].map((v) => digits(v))).toEqual(['–', '–', '–', '–']));
  it('lose trailing zeros behind the point, but not before it', () => {
    expect([1.5, 1, 100, 20.50001, 3e8].map((v) => plain(v))).toEqual(['1.5', '1', '100', '20.5', '3·10⁸']);
    expect(short(0.126)).toBe('0.13');
  });
});
