// SPDX-License-Identifier: Apache-2.0
// Limits and strategy of the contour correction, and what each override step would give now.
import { fixed } from '../../frame/numbers';
import { theme as themeNow } from '../../frame/theme';
import { Strip } from '../paint/strip';
import type { Context, MakeView } from '../shell/context';
import { h, panel, setText } from '../shell/h';
import { problem } from '../shell/problem';
import { small, units } from '../state/units';
import { t } from '../texts/texts';
import { type Bar, bar } from './bars';
import { keyRows } from './keys';
import { errorStrip } from './now/error';
import { type Part, together } from './part';

const SECTIONS = ['contour', 'path_offset'];
const SECONDS = 10;
/** A bar as long as this many limits. */
const BAR_LIMITS = 2;

function limitsPart(context: Context): Part {
  const body = h('div', {}, h('p', { class: 'none' }, t('loading')));
  let end = () => {};
  const load = () => {
    (context.machine ? Promise.resolve(context.machine) : context.loadMachine())
      .then(({ sections }) => {
        const rows = keyRows(context, sections.filter((s) => SECTIONS.includes(s.name)).flatMap((s) => s.keys));
        end();
        end = rows.close;
        body.replaceChildren(rows.root);
      })
      .catch((error: unknown) => body.replaceChildren(problem(error, load)));
  };
  load();
  return { root: panel(t('limits'), 'limits', h('p', { class: 'hint' }, t('limits_hint')), body), close: () => end() };
}

interface StepRow {
  root: HTMLElement;
  bar: Bar;
  verdict: HTMLElement;
}

function stepRow(percent: number): StepRow {
  const made = bar(`${fixed(percent, 0)} %`, 'step');
  const verdict = h('span', { class: 'step-verdict' });
  made.root.append(verdict);
  return { root: h('li', { class: 'step-row' }, made.root), bar: made, verdict };
}

function stepsPart({ live }: Context): Part {
  const list = h('ul', { class: 'step-rows', id: 'steps' });
  const none = h('p', { class: 'none', id: 'steps-none' }, t('steps_none'));
  const rows = new Map<number, StepRow>();
  const show = () => {
    const steps = [...(live.frame?.steps ?? [])].sort((a, b) => b.percent - a.percent);
    none.hidden = steps.length > 0;
    list.hidden = steps.length === 0;
    if (steps.length !== rows.size || steps.some((s) => !rows.has(s.percent))) {
      rows.clear();
      steps.forEach((s) => rows.set(s.percent, stepRow(s.percent)));
      list.replaceChildren(...[...rows.values()].map((r) => r.root));
    }
    const limit = live.status?.contour_limit_um ?? 0;
    const inForce = steps.reduce<number | undefined>((best, s) => (best === undefined || Math.abs(s.percent - (live.status?.feed_percent ?? 0)) < Math.abs(best - (live.status?.feed_percent ?? 0)) ? s.percent : best), undefined);
    for (const { percent, error_um } of steps) {
      const row = rows.get(percent);
      const over = error_um !== null && Math.abs(error_um) > limit;
      row?.bar.set(error_um === null ? null : Math.abs(error_um) / (BAR_LIMITS * limit || 1), small(error_um));
      row?.bar.mark(1 / BAR_LIMITS);
      row?.root.classList.toggle('over', over);
      row?.root.classList.toggle('in-force', percent === inForce);
      if (row) {
        const words = error_um === null ? [] : [t(over ? 'step_exceeds' : 'step_holds')];
        setText(row.verdict, [...words, ...(percent === inForce ? [t('step_now')] : [])].join(' · '));
      }
    }
  };
  return {
    root: panel(t('steps'), 'step-panel', h('p', { class: 'hint' }, t('steps_hint')), none, list),
    update: (_, figures) => figures && show(),
  };
}

function coursesPart(context: Context): Part {
  const error = errorStrip(context, 'contour-strip');
  const percent = { name: '%', decimals: 0, of: (v: number) => v, back: (v: number) => v };
  const feed: Strip = new Strip(
    context.live,
    {
      name: 'feed-strip',
      label: t('feed_history'),
      seconds: SECONDS,
      unit: percent,
      atLeast: 110,
      curves: [
        { column: 'panel', colour: (theme) => theme.faint, width: 1 },
        { column: 'asked', colour: (theme) => theme.run.without, width: 1.2 },
        { column: 'effective', colour: (theme) => theme.run.with, width: 2 },
      ],
    },
    () => feed.draw(themeNow()),
  );
  const strips = [error, feed];
  const key = h('p', { class: 'strip-key' }, h('span', { class: 'k-actual' }, t('actual')), h('span', { class: 'k-asked' }, t('asked')), h('span', { class: 'k-panel' }, t('panel')));
  return {
    root: panel(
      t('contour_error'),
      'courses',
      h('p', { class: 'under' }, `${t('contour_error')}, ${units().small.name} · ${t('last_seconds', { seconds: SECONDS })}`),
      error.canvas.element,
      h('p', { class: 'under' }, `${t('feed_history')}, %`),
      feed.canvas.element,
      key,
    ),
    update: (theme) => strips.forEach((s) => s.draw(theme)),
    redraw: (theme) => strips.forEach((s) => s.draw(theme)),
    close: () => strips.forEach((s) => s.canvas.close()),
  };
}

export const contourView: MakeView = (context) => together('contour-view', [coursesPart(context), stepsPart(context), limitsPart(context)]);
