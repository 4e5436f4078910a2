// SPDX-License-Identifier: Apache-2.0
import type { RecordRow } from '../../api/types';
import { type TextKey, t } from '../../texts/texts';

/** Whether a record is whole, still being written, or was left by a run that was killed. */
export function recordState({ fault, closed, writing }: Pick<RecordRow, 'fault' | 'closed' | 'writing'>): string {
  const key: TextKey = fault ? 'record_fault' : closed ? 'record_closed' : writing ? 'record_open' : 'record_unclosed';
  return t(key);
}
