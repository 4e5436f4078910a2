// SPDX-License-Identifier: Apache-2.0
// What each step of the feed override would give now: held from here on, and taken for one decision.
import { fixed } from '../../frame/numbers';
import type { StepNow } from '../api/types';
import type { Context } from '../shell/context';
import { h, panel, setText } from '../shell/h';
import { small } from '../state/units';
import { type TextKey, t } from '../texts/texts';
import { type Bar, bar } from './bars';
import type { Part } from './part';

/** A bar as long as this many limits. */
const BAR_LIMITS = 2;
/** A table of more steps is shown in even strides. */
const MOST_ROWS = 24;

interface StepRow {
  root: HTMLElement;
  bar: Bar;
  change: HTMLElement;
  verdict: HTMLElement;
}

function stepRow(percent: number): StepRow {
  const made = bar(`${fixed(percent, percent % 1 === 0 ? 0 : 1)} %`, 'step');
  const change = h('span', { class: 'step-change' });
  const verdict = h('span', { class: 'step-verdict' });
  made.root.append(change, verdict);
  return { root: h('li', { class: 'step-row' }, made.root), bar: made, change, verdict };
}

const apart = (step: StepNow, percent: number) => Math.abs(step.percent - percent);

/** Of a long table every n-th, the last, and the one in force; from the fastest down. */
export function shownSteps(steps: readonly StepNow[], inForce: number): StepNow[] {
  const stride = Math.ceil(steps.length / MOST_ROWS);
  return steps.filter((s, i) => (steps.length - 1 - i) % stride === 0 || s.percent === inForce).reverse();
}

/** The table's step nearest to what is in force. */
export function stepInForce(steps: readonly StepNow[], percent: number): number | undefined {
  return steps.reduce<StepNow | undefined>((best, s) => (best === undefined || apart(s, percent) < apart(best, percent) ? s : best), undefined)?.percent;
}

export function stepsPart({ live }: Context): Part {
  const list = h('ul', { class: 'step-rows', id: 'steps' });
  const none = h('p', { class: 'none', id: 'steps-none' }, t('steps_none'));
  const rows = new Map<number, StepRow>();
  const show = () => {
    const all = [...(live.frame?.steps ?? [])].sort((a, b) => a.percent - b.percent);
    const inForce = stepInForce(all, live.status?.feed_percent ?? 0);
    const steps = shownSteps(all, inForce ?? 0);
    none.hidden = steps.length > 0;
    list.hidden = steps.length === 0;
    setText(none, t(live.status?.cutting === true && live.frame?.path_known === false ? 'steps_unknown' : 'steps_none'));
    if (steps.length !== rows.size || steps.some((s) => !rows.has(s.percent))) {
      rows.clear();
      steps.forEach((s) => rows.set(s.percent, stepRow(s.percent)));
      list.replaceChildren(...[...rows.values()].map((r) => r.root));
    }
    const limit = live.status?.contour_limit_um ?? 0;
    for (const { percent, error_um, change_um } of steps) {
      const row = rows.get(percent);
      const over = error_um !== null && Math.abs(error_um) > limit;
      row?.bar.set(error_um === null ? null : Math.abs(error_um) / (BAR_LIMITS * limit || 1), error_um === null ? '–' : small(Math.abs(error_um)));
      row?.bar.mark(1 / BAR_LIMITS);
      row?.root.classList.toggle('over', over);
      row?.root.classList.toggle('in-force', percent === inForce);
      if (row) {
        const words: TextKey[] = error_um === null ? [] : [over ? 'step_exceeds' : 'step_holds'];
        setText(row.change, change_um === null ? '–' : small(Math.abs(change_um)));
        setText(row.verdict, [...words, ...(percent === inForce ? (['step_now'] as const) : [])].map((w) => t(w)).join(' · '));
      }
    }
  };
  const heads = h('div', { class: 'bar-row step step-heads', 'aria-hidden': 'true' }, h('span', { class: 'label' }, t('step')), h('span', {}), h('span', { class: 'value' }, t('step_held')), h('span', { class: 'step-change' }, t('step_change')), h('span', { class: 'step-verdict' }));
  return {
    root: panel(t('steps'), 'step-panel', h('p', { class: 'hint' }, t('steps_hint')), none, h('div', { class: 'step-row' }, heads), list),
    update: (_, figures) => {
      if (figures) {
        show();
        heads.hidden = list.hidden;
      }
    },
  };
}
