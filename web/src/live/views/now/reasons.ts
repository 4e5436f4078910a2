// SPDX-License-Identifier: Apache-2.0
import type { Status } from '../../api/types';
import type { Context } from '../../shell/context';
import { h, panel } from '../../shell/h';
import { type TextKey, reasonText, t } from '../../texts/texts';
import type { Part } from '../part';

const OF: Readonly<Record<string, TextKey>> = { feed: 'of_feed', spindle: 'of_spindle', offset: 'of_offset', path_offset: 'of_path_offset' };

/** What has nothing to do comes last and is faint. */
const IDLE = new Set(['none']);
/** Somebody should look at these. */
const TROUBLE = /^(input_|heartbeat|unknown_override|port_cannot|contour_feed_floor|chatter_detected|chatter_no_better|thermal_(clamped|sensor|model|reading_outlier))/;

function rows(status: Status): HTMLElement[] {
  const faults = [
    ...(status.port_fault ? [t('port_fault', { words: status.port_fault })] : []),
    ...(status.record_fault ? [t('record_ended', { words: status.record_fault })] : []),
    ...(status.program?.words ? [t('program_fault', { words: status.program.words })] : []),
  ].map((text) => h('li', { class: 'trouble' }, h('span', { class: 'words' }, text)));
  const sorted = [...status.reasons].sort((a, b) => Number(IDLE.has(a.reason)) - Number(IDLE.has(b.reason)));
  const reasons = sorted.map(({ of, reason, sentence }) => {
    const look = IDLE.has(reason) ? 'idle' : TROUBLE.test(reason) ? 'trouble' : '';
    const key = OF[of];
    return h('li', { class: look, 'data-reason': reason }, h('b', {}, key ? t(key) : of), h('span', { class: 'words' }, reasonText(reason, sentence)));
  });
  return [...faults, ...reasons];
}

export function reasonsPart({ live }: Context): Part {
  const list = h('ul', { class: 'reasons', id: 'reasons' }, h('li', { class: 'idle' }, t('waiting')));
  let shown = '';
  return {
    root: panel(t('reasons'), 'why-panel', list),
    update: (_, figures) => {
      const { status } = live;
      if (!figures || !status) {
        return;
      }
      const now = JSON.stringify([status.reasons, status.port_fault, status.record_fault, status.program?.words]);
      if (now !== shown) {
        shown = now;
        list.replaceChildren(...rows(status));
      }
    },
  };
}
