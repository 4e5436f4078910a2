// SPDX-License-Identifier: Apache-2.0
// One past run: what it was, what happened, its course, export and replay.
import { fixed } from '../../../frame/numbers';
import { RECORD_PATIENCE_MS } from '../../api/client';
import type { RecordDetail } from '../../api/types';
import { type Context, type LiveView, gate } from '../../shell/context';
import { button, h, panel, setText } from '../../shell/h';
import { problem, problemText } from '../../shell/problem';
import { addressOf } from '../../shell/route';
import { t } from '../../texts/texts';
import { recordCourse } from './course';
import { exportLinks } from './export';
import { recordState } from './state';
import { type Part, columns } from '../part';
import { localTime } from '../times';

function valueOf(value: unknown): string {
  if (typeof value === 'number') {
    return Number.isInteger(value) ? fixed(value, 0) : fixed(value, 3);
  }
  if (typeof value === 'boolean') {
    return t(value ? 'yes' : 'no');
  }
  return value === null || value === undefined ? '–' : String(value);
}

/** `reasons.contour_limit` for what is inside something else. */
function flat(of: Readonly<Record<string, unknown>>, before = ''): [string, unknown][] {
  return Object.entries(of).flatMap(([name, value]): [string, unknown][] => {
    const whole = before === '' ? name : `${before}.${name}`;
    return value !== null && typeof value === 'object' ? flat(value as Record<string, unknown>, whole) : [[whole, value]];
  });
}

/** A unit at a name's end is set apart: `over_limit_s` → over limit, s. */
export function nameText(name: string): string {
  const [, stem = name, unit] = /^(.*?)_(s|us|um|mm|percent|rpm|hz)$/.exec(name) ?? [];
  const names: Record<string, string> = { us: 'µs', um: t('um'), mm: t('mm'), percent: '%', hz: 'Hz', rpm: t('rpm') };
  return `${stem.replaceAll('_', ' ').replaceAll('.', ' · ')}${unit === undefined ? '' : `, ${names[unit] ?? unit}`}`;
}

const LONGEST = 200;

/** An instant is told by the viewer's clock, as in the list of records. */
function row([name, value]: [string, unknown]): HTMLElement[] {
  const [at] = typeof value === 'string' ? (/^(.*)_utc$/.exec(name)?.slice(1) ?? []) : [];
  return [h('dt', {}, nameText(at ?? name)), h('dd', {}, at === undefined ? valueOf(value) : localTime(String(value)))];
}

function list(of: Readonly<Record<string, unknown>>): HTMLElement {
  const rows = flat(of).filter(([, value]) => String(value).length <= LONGEST);
  return h('dl', { class: 'facts-list' }, ...rows.flatMap(row));
}

function eventTable(events: RecordDetail['events']): HTMLElement {
  if (events.length === 0) {
    return h('p', { class: 'none' }, t('events_none'));
  }
  const rows = events.map((e) => h('tr', {}, h('th', { scope: 'row', class: 'n' }, fixed(e.t_s, 2)), h('td', {}, e.kind), h('td', { class: 'event-text' }, e.text)));
  const head = h('tr', {}, h('th', { scope: 'col', class: 'n' }, t('at_s')), h('th', { scope: 'col' }, t('kind')), h('th', { scope: 'col' }, t('what')));
  return h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': t('events') }, h('table', { class: 'data few', id: 'events' }, h('thead', {}, head), h('tbody', {}, ...rows)));
}

interface Replayed {
  cycles: number;
  first_difference: number | null;
}

function replayPart({ api, session }: Context, name: string): Part {
  const said = h('p', { class: 'said', role: 'status', id: 'replayed' });
  const go = button(t('replay'), () => {
    go.disabled = true;
    setText(said, t('loading'));
    api
      .post<Replayed>(`records/${encodeURIComponent(name)}/replay`, {}, RECORD_PATIENCE_MS)
      .then(({ cycles, first_difference }) => setText(said, first_difference === null ? t('replay_same', { cycles: fixed(cycles, 0) }) : t('replay_differs', { cycles: fixed(cycles, 0), first: fixed(first_difference, 0) })))
      .catch((error: unknown) => setText(said, problemText(error)))
      .finally(() => (go.disabled = false));
  }, { id: 'replay' });
  return { root: panel(t('replay'), 'replay-panel', h('p', { class: 'hint' }, t('replay_hint')), gate(session, 'engineer', h('div', { class: 'actions' }, go)), said) };
}

export function recordDetail(context: Context, name: string): LiveView {
  const run = h('div', {}, h('p', { class: 'none' }, t('loading')));
  const events = h('div', {});
  const totals = h('div', {});
  const exports = exportLinks(name);
  const course = recordCourse(context, name, exports.root);
  // Only of a record that can be read.
  const replay = replayPart(context, name);
  replay.root.hidden = true;
  const load = () => {
    context.api
      .get<{ record: RecordDetail }>(`records/${encodeURIComponent(name)}`, RECORD_PATIENCE_MS)
      .then(({ record }) => {
        const { closed, writing } = record.totals;
        const state = closed === false ? { state: recordState({ fault: false, closed, writing: writing === true }) } : {};
        run.replaceChildren(list({ ...record.run, ...state }));
        exports.offer(record.formats ?? ['sqlite']);
        events.replaceChildren(eventTable(record.events ?? []));
        totals.replaceChildren(list(record.totals ?? {}));
        replay.root.hidden = false;
      })
      .catch((error: unknown) => run.replaceChildren(problem(error, load)));
  };
  load();
  const view = columns(
    'record-detail',
    [course, { root: panel(t('events'), 'events-panel', events) }],
    [{ root: panel(t('run'), 'run-panel', run) }, { root: panel(t('totals'), 'totals-panel', totals) }, replay],
  );
  view.root.prepend(h('div', { class: 'back-line' }, h('a', { class: 'button', href: addressOf('record') }, `← ${t('all_records')}`), h('h2', { class: 'record-name' }, name)));
  return view;
}
