// SPDX-License-Identifier: Apache-2.0
// What was corrected against heat, and what comes.
import type { Move, Thermal } from '../../api/types';
import { h } from '../../shell/h';
import { figure, small, units } from '../../state/units';
import { t } from '../../texts/texts';
import { span } from '../times';

const MOST = 8;

function table(id: string, title: string, moves: readonly (Move & { when: string })[]): HTMLElement {
  const unit = units().small;
  const head = h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, t('axis')), h('th', { scope: 'col', class: 'n' }, t('corrections_when')), h('th', { scope: 'col', class: 'n' }, `${t('from_to')}, ${unit.name}`)));
  const rows = moves.map((m) => h('tr', {}, h('th', { scope: 'row' }, m.axis), h('td', { class: 'n' }, m.when), h('td', { class: 'n' }, `${figure(unit, m.from_um)} → ${figure(unit, m.to_um)}`)));
  return h('div', { id }, h('h3', {}, title), rows.length === 0 ? h('p', { class: 'none' }, t('corrections_none')) : h('table', { class: 'data few' }, head, h('tbody', {}, ...rows)));
}

/** The newest first, then the next ones. */
export function correctionLists({ history, corrections }: Thermal): HTMLElement {
  if (!corrections) {
    return h('div', {});
  }
  const now = history.t_s.at(-1) ?? 0;
  const come = corrections.to_come.slice(0, MOST).map((m) => ({ ...m, when: t('in_time', { time: span(m.in_s) }) }));
  const done = corrections.done.slice(-MOST).reverse().map((m) => ({ ...m, when: t('before_time', { time: span(Math.max(0, now - m.t_s)) }) }));
  return h('div', {}, h('p', { class: 'hint' }, t('corrections_hint', { step: small(corrections.step_um) })), table('corrections-come', t('corrections_come'), come), table('corrections-done', t('corrections_done'), done));
}
