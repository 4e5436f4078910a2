// SPDX-License-Identifier: Apache-2.0
// Numbers as people read them.
import type { Maybe } from './data';

const SUPERSCRIPT: Record<string, string> = {
  '-': '⁻', '0': '⁰', '1': '¹', '2': '²', '3': '³', '4': '⁴', '5': '⁵', '6': '⁶', '7': '⁷', '8': '⁸', '9': '⁹',
};

/** Shown for a missing number. */
const NONE = '–';

/** A fixed count of decimals, a narrow space that does not break between thousands and a true minus sign. */
export function fixed(value: Maybe | undefined, decimals: number): string {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return NONE;
  }
  const [whole = '', part] = Math.abs(value).toFixed(decimals).split('.');
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, '\u202f') : whole;
  const digits = part === undefined ? grouped : `${grouped}.${part}`;
  return value < 0 && /[1-9]/.test(digits) ? `−${digits}` : digits;
}

/** `+12.3 %`, `−87.0 %`; a dash if there is nothing to compare with. */
export function change(before: number, after: number): string {
  if (!Number.isFinite(before) || !Number.isFinite(after) || before === 0) {
    return NONE;
  }
  const change = fixed((100 * (after - before)) / before, 1);
  return `${after > before && change !== '0.0' ? '+' : ''}${change}\u00a0%`;
}

/** Two significant digits, from 0.0012 to 1200. */
export function twoDigits(value: number): string {
  const decimals = value > 0 ? Math.min(6, Math.max(0, 1 - Math.floor(Math.log10(value)))) : 0;
  return fixed(value, decimals);
}

/** Significant digits, with a power of ten for very small and very large numbers; a dash for a missing number. */
export function digits(value: Maybe | undefined, count = 3): string {
  if (value === null || value === undefined || !Number.isFinite(value)) {
    return NONE;
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

/** A number and its unit, kept on one line; a dash alone for a missing number. */
export function measure(value: Maybe | undefined, decimals: number, unit: string): string {
  const text = fixed(value, decimals);
  return text === NONE ? text : `${text}\u00a0${unit}`;
}

export const um = (value: Maybe | undefined, decimals = 1) => measure(value, decimals, 'µm');
export const hertz = (value: Maybe | undefined) => measure(value, 1, 'Hz');
export const rpm = (value: Maybe | undefined) => measure(value, 0, 'rpm');

export function percent(share: Maybe | undefined, decimals = 1): string {
  return measure(share === null || share === undefined ? null : 100 * share, decimals, '%');
}

/** Rounded down: only what never failed reads 100 %. */
export function heldPercent(share: Maybe): string {
  return share === 1 ? percent(1, 0) : measure(share === null ? null : Math.floor(share * 10_000 + 1e-6) / 100, 2, '%');
}

/** `1 tooth`, `4 teeth`. */
export function counted(count: number, one: string, many: string): string {
  return `${fixed(count, 0)} ${count === 1 ? one : many}`;
}

/** Significant digits without trailing zeros: 0.00326, 1.406, 33.3, 5000. */
export function plain(value: Maybe | undefined, count = 4): string {
  return digits(value, count).replace(/(\.\d*?)0+(?=$|·)/, '$1').replace(/\.(?=$|·)/, '');
}

/** Two of them, for axes and table heads. */
export function short(value: number): string {
  return plain(value, 2);
}
