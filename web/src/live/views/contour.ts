// SPDX-License-Identifier: Apache-2.0
// Limits and strategy of the contour correction, its courses, and what each override step would give now.
import { theme as themeNow } from '../../frame/theme';
import { Strip } from '../paint/strip';
import type { Context, MakeView } from '../shell/context';
import { h, panel } from '../shell/h';
import { units } from '../state/units';
import { t } from '../texts/texts';
import { keyRows } from './keys';
import { machineFile } from './machine_file';
import { errorStrip } from './now/error';
import { type Part, together } from './part';
import { stepsPart } from './steps';

const SECTIONS = ['contour', 'path_offset'];
const SECONDS = 10;

function limitsPart(context: Context): Part {
  const body = h('div', {}, h('p', { class: 'none' }, t('loading')));
  let end = () => {};
  const file = machineFile(context, body, ({ sections }) => {
    const rows = keyRows(context, sections.filter((s) => SECTIONS.includes(s.name)).flatMap((s) => s.keys));
    end();
    end = rows.close;
    body.replaceChildren(rows.root);
  });
  return {
    root: panel(t('limits'), 'limits', h('p', { class: 'hint' }, t('limits_hint')), body),
    update: file.update,
    close: () => {
      file.close();
      end();
    },
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
