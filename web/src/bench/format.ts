// SPDX-License-Identifier: Apache-2.0
import type { Maybe } from './data';

const SUPERSCRIPT: Record<string, string> = {
  '-': '⁻', '0': '⁰', '1': '¹', '2': '²', '3': '³', '4': '⁴', '5': '⁵', '6': '⁶', '7': '⁷', '8': '⁸', '9': '⁹',
};

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

/** The digits that count, without noughts at the end. */
export function trimmed(value: Maybe | undefined, count: number): string {
  return digits(value, count).replace(/(\.\d*?)0+(?=$|·)/, '$1').replace(/\.(?=$|·)/, '');
}

/** Two of them: for axes and heads. */
export function short(value: number): string {
  return trimmed(value, 2);
}
