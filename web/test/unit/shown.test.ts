// SPDX-License-Identifier: Apache-2.0
import { describe, expect, test } from 'vitest';
import { escapeHtml } from '../../src/frame/html';
import { shown } from '../../src/frame/shown';

describe('a name that somebody else chose', () => {
  test('is shown as it is where it can be seen', () => {
    for (const name of ['part 1.mpf', 'Hüftgelenk_µm.ngc', 'деталь.mpf', '零件.nc', 'شغل.nc', '🛠️.nc', '1\u202f000\u00a0µm', 'a\n\tb']) {
      expect(shown(name)).toBe(name);
    }
  });
  test('shows what would not be seen or would turn the rest', () => {
    expect(shown('part\u202egpj.mpf')).toBe('part\\u202egpj.mpf');
    expect(shown('a\u2066b\u2069\u061c\u200f\u200b\ufeff')).toBe('a\\u2066b\\u2069\\u061c\\u200f\\u200b\\ufeff');
    expect(shown('\u001b[31m\u0085\u{e0041}')).toBe('\\x1b[31m\\u0085\\U000e0041');
    expect(escapeHtml('<b>\u202e')).toBe('&#60;b&#62;\\u202e');
  });
});
