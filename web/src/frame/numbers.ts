// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them.
import type { Maybe } from './data';

const SUPERSCRIPT: Record<string, string> = {
  '-': '⁻', '0': '⁰', '1': '¹', '2': '²', '3': '³', '4': '⁴', '5': '⁵', '6': '⁶', '7': '⁷', '8': '⁸', '9': '⁹',
};

/** A number with a fixed count of decimals, a thin space between thousands and a true minus sign. */
export function fixed(value: Maybe | undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return '–';
  }
  const [whole = '', part] = Math.abs(value).toFixed(decimals).split('.');
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, '\u2009') : whole;
  const digits = part === undefined ? grouped : `${grouped}.${part}`;
  return value < 0 && /[1-9]/.test(digits) ? `−${digits}` : digits;
}

/** `+12.3 %`, `−87.0 %`; a dash where there is nothing to compare with. */
export function change(before: number, after: number): string {
  if (!Number.isFinite(before) || !Number.isFinite(after) || before === 0) {
    return '–';
  }
  const percent = fixed((100 * (after - before)) / before, 1);
  return `${after > before && percent !== '0.0' ? '+' : ''}${percent} %`;
}

/** Two digits that count, from 0.0012 to 1200. */
export function twoDigits(value: number): string {
  const decimals = value > 0 ? Math.min(6, Math.max(0, 1 - Math.floor(Math.log10(value)))) : 0;
  return fixed(value, decimals);
}

/** Three digits, powers of ten beyond four places; a dash where there is no number. */
export function digits(value: Maybe | undefined, count = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return '–';
  }
  if (value === 0) {
    return '0';
  }
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e5) {
    const [mantissa = '', exponent = ''] = value.toExponential(count - 1).split('e');
    const power = [...exponent.replace('+', '')].map((c) => SUPERSCRIPT[c] ?? c).join('');
    return `${mantissa.replace('-', '−')}·10${power}`;
  }
  const places = Math.max(0, count - 1 - Math.floor(Math.log10(size)));
  return value.toFixed(Math.min(places, 6)).replace('-', '−');
}

export function percent(share: Maybe): string {
  return share === null ? '–' : `${share === 1 ? '100' : (100 * share).toFixed(2)} %`;
}

/** The digits that count, without noughts at the end: 0.00326, 1.406, 33.3, 5000. */
export function plain(value: Maybe | undefined, count = 4): string {
  return digits(value, count).replace(/(\.\d*?)0+(?=$|·)/, '$1').replace(/\.(?=$|·)/, '');
}

/** Two of them: for axes and heads. */
export function short(value: number): string {
  return plain(value, 2);
}
