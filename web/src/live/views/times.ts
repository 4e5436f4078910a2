// SPDX-License-Identifier: Apache-2.0
import { fixed } from '../../frame/numbers';
import { t } from '../texts/texts';

/** `45 s`, `14 min`, `2.1 h`. */
export function span(seconds: number): string {
  if (seconds < 90) {
    return t('seconds', { value: fixed(seconds, 0) });
  }
  return seconds < 5400 ? t('minutes', { value: fixed(seconds / 60, 0) }) : t('hours', { value: fixed(seconds / 3600, 1) });
}

/** As the viewer's clock shows it. */
export function localTime(utc: string): string {
  const at = new Date(utc);
  return Number.isNaN(at.getTime()) ? utc : at.toLocaleString(document.documentElement.lang || undefined, { dateStyle: 'medium', timeStyle: 'short' });
}
