// SPDX-License-Identifier: Apache-2.0
// Past runs: the list with its search, or one of them.
import { escapeHtml } from '../../../frame/html';
import { fixed } from '../../../frame/numbers';
import { type Cell, numeric, onSort, table } from '../../../frame/table';
import type { DamagedRecord, RecordRow } from '../../api/types';
import type { Context, LiveView, MakeView } from '../../shell/context';
import { field, h, panel } from '../../shell/h';
import { problem } from '../../shell/problem';
import { addressOf } from '../../shell/route';
import { t } from '../../texts/texts';
import { recordDetail } from './detail';
import { recordState } from './state';
import { localTime, span } from '../times';

const TYPING_MS = 250;

export function bytesText(bytes: number): string {
  const size = bytes >= 1e9 ? ([1e9, 'GB'] as const) : bytes >= 1e6 ? ([1e6, 'MB'] as const) : ([1e3, 'kB'] as const);
  return `${fixed(bytes / size[0], 1)}\u00a0${size[1]}`;
}

const size = (bytes: number): Cell => ({ html: escapeHtml(bytesText(bytes)), sort: bytes });
/** Sorted behind all others. */
const UNKNOWN: Cell = { html: '–', sort: null };

function row(r: RecordRow | DamagedRecord): Cell[] {
  if ('damaged' in r) {
    const why = t('record_damaged', { why: r.damaged });
    return [{ html: escapeHtml(r.name), sort: r.name }, UNKNOWN, UNKNOWN, UNKNOWN, UNKNOWN, size(r.bytes), { html: escapeHtml(why), look: 'missed' }];
  }
  return [
    { html: `<a href="${escapeHtml(addressOf('record', r.name))}">${escapeHtml(r.name)}</a>`, sort: r.name },
    { html: escapeHtml(localTime(r.start_utc)), sort: r.start_utc },
    r.machine,
    r.program,
    { html: escapeHtml(span(r.seconds)), sort: r.seconds },
    size(r.bytes),
    { html: escapeHtml(recordState(r)), look: r.fault ? 'missed' : '' },
  ];
}

function listTable(records: readonly (RecordRow | DamagedRecord)[]): HTMLElement {
  const place = h('div', { class: 'record-list' });
  if (records.length === 0) {
    place.append(h('p', { class: 'none' }, `${t('records_none')} ${t('records_none_hint')}`));
    return place;
  }
  place.innerHTML = table({
    id: 'records',
    columns: [{ head: t('name') }, { head: t('start') }, { head: t('machine') }, { head: t('program') }, numeric(t('duration')), numeric(t('size')), { head: t('state') }],
    rows: records.map(row),
    sortable: true,
  });
  return place;
}

function recordList({ api }: Context): LiveView {
  const search = h('input', { id: 'search', type: 'search', placeholder: t('search_hint'), autocomplete: 'off' });
  const body = h('div', { id: 'record-body' }, h('p', { class: 'none' }, t('loading')));
  let asked = 0;
  const load = () => {
    const mine = ++asked;
    const what = search.value.trim();
    api
      .get<{ records: (RecordRow | DamagedRecord)[] }>(what === '' ? 'records' : `records?search=${encodeURIComponent(what)}`)
      .then(({ records }) => mine === asked && body.replaceChildren(listTable(records)))
      .catch((error: unknown) => mine === asked && body.replaceChildren(problem(error, load)));
  };
  let timer = 0;
  search.addEventListener('input', () => {
    window.clearTimeout(timer);
    timer = window.setTimeout(load, TYPING_MS);
  });
  load();
  const root = h('div', { class: 'panels-of record-view' }, panel(t('record'), 'records-panel', h('div', { class: 'fields' }, field(t('search'), search)), body));
  onSort(root);
  return { root, close: () => window.clearTimeout(timer) };
}

export const recordView: MakeView = (context, name) => (name === '' ? recordList(context) : recordDetail(context, name));
