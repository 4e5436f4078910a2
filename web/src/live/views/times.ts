// SPDX-License-Identifier: Apache-2.0
import { fixed } from '../../frame/numbers';
import { t } from '../texts/texts';

/** `45 s`, `14 min`, `2.1 h`. */
export function span(seconds: number): string {
  const [key, value] = seconds < 90 ? (['seconds', fixed(seconds, 0)] as const) : seconds < 5400 ? (['minutes', fixed(seconds / 60, 0)] as const) : (['hours', fixed(seconds / 3600, 1)] as const);
  return t(key, { value }).replaceAll(' ', '\u00a0');
}

/** By the viewer's clock, in the one order that nobody misreads: `2026-01-02 08:04`. */
export function localTime(utc: string): string {
  const at = new Date(utc);
  const two = (value: number) => String(value).padStart(2, '0');
  return Number.isNaN(at.getTime()) ? utc : `${at.getFullYear()}-${two(at.getMonth() + 1)}-${two(at.getDate())} ${two(at.getHours())}:${two(at.getMinutes())}`;
}
