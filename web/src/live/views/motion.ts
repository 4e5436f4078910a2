// SPDX-License-Identifier: Apache-2.0
// The axes as estimated from the encoders, with their bounds, and how the control cycle keeps time.
import { fixed, plain } from '../../frame/numbers';
import { curveColour, theme as themeNow } from '../../frame/theme';
import { ink } from '../../plot/key';
import type { AxisNow } from '../api/types';
import { Strip } from '../paint/strip';
import type { SampleColumn } from '../state/live';
import type { Context, MakeView } from '../shell/context';
import { h, panel, setText } from '../shell/h';
import { figure, units } from '../state/units';
import { t } from '../texts/texts';
import { encodersPart } from './encoders';
import { type Part, together } from './part';

interface Column {
  head: string;
  text: (axis: AxisNow, rotary: boolean) => string;
}

/** Rotary axes stay in degrees. */
function columns(): Column[] {
  const { length, feed, acceleration, small } = units();
  const of = (unit: typeof length, name: string, value: (a: AxisNow) => number | null, degrees: string): Column => ({
    head: `${name}, ${unit.name}`,
    text: (axis, rotary) => (rotary ? `${fixed(value(axis), 3)} ${degrees}` : figure(unit, value(axis))),
  });
  // A bound may be far below the last decimal of what it bounds.
  const bound = (unit: typeof length, value: (a: AxisNow) => number | null, degrees: string): Column => ({
    head: `${t('bound')}, ${unit.name}`,
    text: (axis, rotary) => {
      const now = value(axis);
      return now === null ? '–' : rotary ? `${plain(now, 2)} ${degrees}` : plain(unit.of(now), 2);
    },
  });
  return [
    of(length, t('position'), (a) => a.position_mm, '°'),
    of(small, t('following_error'), (a) => a.following_um, 'm°'),
    of(feed, t('velocity'), (a) => a.velocity_mm_min, t('deg_min')),
    bound(feed, (a) => a.velocity_bound_mm_min, t('deg_min')),
    of(acceleration, t('acceleration'), (a) => a.acceleration_mm_s2, t('deg_s2')),
    bound(acceleration, (a) => a.acceleration_bound_mm_s2, t('deg_s2')),
  ];
}

function axesPart({ live }: Context): Part {
  const shown = columns();
  const body = h('tbody', {});
  const head = h('tr', {}, h('th', { scope: 'col' }, t('axis')), ...shown.map((c) => h('th', { scope: 'col', class: 'n' }, c.head)));
  const table = h('table', { class: 'data live', id: 'axes' }, h('thead', {}, head), body);
  const update = () => {
    const axes = live.frame?.axes ?? [];
    const rotary = new Set(live.hello?.machine.axes.filter((a) => a.rotary).map((a) => a.name));
    if (body.rows.length !== axes.length) {
      body.replaceChildren(...axes.map((a) => h('tr', {}, h('th', { scope: 'row' }, a.name), ...shown.map((c) => h('td', { class: 'n', 'data-label': c.head }, h('span', {}))))));
    }
    axes.forEach((axis, i) => shown.forEach((c, k) => setText(body.rows[i]?.cells[k + 1]?.firstElementChild as HTMLElement, c.text(axis, rotary.has(axis.name)))));
  };
  return { root: panel(t('axes'), 'axes', h('p', { class: 'hint' }, t('axes_hint')), table), update: (_, figures) => figures && update() };
}

function loopPart({ live }: Context): Part {
  const names = ['port', 'cycle_time', 'cycles', 'overruns'] as const;
  const values = Object.fromEntries(names.map((n) => [n, h('dd', { id: `loop-${n}` }, '–')])) as Record<(typeof names)[number], HTMLElement>;
  return {
    root: panel(t('loop'), 'loop', h('dl', { class: 'facts-list' }, ...names.flatMap((n) => [h('dt', {}, t(n)), values[n]]))),
    update: (_, figures) => {
      const { status, hello } = live;
      if (figures && status) {
        setText(values.port, status.port ?? '–');
        setText(values.cycle_time, hello ? `${fixed(1000 * hello.cycle_s, 2)} ms` : '–');
        setText(values.cycles, fixed(status.cycles, 0));
        setText(values.overruns, fixed(status.overruns, 0));
        values.overruns.classList.toggle('over', status.overruns > 0);
      }
    },
  };
}

const FOLLOWING: readonly SampleColumn[] = ['following_0', 'following_1', 'following_2'];
const SECONDS = 10;

function followingPart({ live }: Context): Part {
  const { small } = units();
  const strip: Strip = new Strip(
    live,
    { name: 'following-strip', label: t('following_error'), seconds: SECONDS, unit: small, curves: FOLLOWING.map((column, i) => ({ column, colour: (theme) => curveColour(theme, 2 * i) })) },
    () => strip.draw(themeNow()),
  );
  const key = h('p', { class: 'strip-key axes-key' });
  let named = '';
  const nameAxes = () => {
    const axes = (live.hello?.machine.axes ?? []).slice(0, FOLLOWING.length).map((a) => a.name);
    if (named !== axes.join()) {
      named = axes.join();
      key.replaceChildren(...axes.map((name, i) => h('span', {}, h('i', { 'data-ink': curveColour(themeNow(), 2 * i) }), name)));
      ink(key);
    }
  };
  return {
    root: panel(t('following_error'), 'following', h('p', { class: 'under' }, `${small.name} · ${t('last_seconds', { seconds: SECONDS })}`), strip.canvas.element, key),
    update: (theme) => {
      nameAxes();
      strip.draw(theme);
    },
    redraw: (theme) => strip.draw(theme),
    close: () => strip.canvas.close(),
  };
}

export const motionView: MakeView = (context) => together('motion-view', [axesPart(context), followingPart(context), loopPart(context), encodersPart(context)]);
