// SPDX-License-Identifier: Apache-2.0
// Feed and spindle: what the layer asked for, what was allowed, what the machine does, what the panel says.
import { measure } from '../../../frame/numbers';
import type { Context } from '../../shell/context';
import { h, panel, setText } from '../../shell/h';
import { feed } from '../../state/units';
import { t } from '../../texts/texts';
import { type Bar, bar } from '../bars';
import type { Part } from '../part';

const LEAST_WHOLE_PERCENT = 120;

const percent = (value: number | undefined) => measure(value === undefined || Number.isNaN(value) ? null : value, 0, '%');

export function overridePart({ live }: Context): Part {
  const speed = h('span', { class: 'value', id: 'path-speed', title: t('path_speed') }, '–');
  const rpm = h('span', { class: 'value', id: 'spindle-rpm' }, '–');
  const feeds = { asked: bar(t('asked'), 'asked'), allowed: bar(t('allowed'), 'allowed'), actual: bar(t('actual'), 'actual'), panel: bar(t('panel'), 'switch') };
  const spindle = { allowed: bar(t('allowed'), 'allowed'), actual: bar(t('actual'), 'actual') };
  const root = panel(
    `${t('feed')} · ${t('spindle')}`,
    'override',
    h('div', { class: 'override-group' }, h('div', { class: 'group-head' }, h('h3', {}, t('feed')), speed), ...Object.values(feeds).map((b) => b.root)),
    h('div', { class: 'override-group' }, h('div', { class: 'group-head' }, h('h3', {}, t('spindle')), rpm), ...Object.values(spindle).map((b) => b.root)),
  );
  const set = (which: Bar, value: number, whole: number, figures: boolean) => which.set(value / whole, figures ? percent(value) : undefined);
  return {
    root,
    update: (_, figures) => {
      const { samples, status, hello } = live;
      const whole = Math.max(LEAST_WHOLE_PERCENT, ...(hello?.contour.steps_percent ?? []));
      set(feeds.asked, samples.newest('asked'), whole, figures);
      set(feeds.allowed, samples.newest('allowed'), whole, figures);
      set(feeds.actual, samples.newest('effective'), whole, figures);
      set(feeds.panel, samples.newest('panel'), whole, figures);
      for (const b of [feeds.asked, feeds.allowed, feeds.actual]) {
        b.mark(samples.newest('panel') / whole);
      }
      set(spindle.allowed, status?.spindle_percent ?? NaN, whole, figures);
      set(spindle.actual, status?.spindle_effective_percent ?? NaN, whole, figures);
      for (const b of Object.values(spindle)) {
        b.mark(100 / whole);
      }
      if (figures) {
        setText(speed, feed(samples.newest('speed_mm_min')));
        setText(rpm, measure(samples.newest('rpm'), 0, t('rpm')));
      }
    },
  };
}
