// SPDX-License-Identifier: Apache-2.0
// What the planner decides for the programmed speed and the depth of the cut.
import { fixed, plain } from '../../../frame/numbers';
import type { Plan, PlanAnswer } from '../../api/types';
import type { Context } from '../../shell/context';
import { h, panel } from '../../shell/h';
import { problem } from '../../shell/problem';
import { units } from '../../state/units';
import { t } from '../../texts/texts';
import { type Part, every } from '../part';

const ASK_MS = 2000;

const depthText = (mm: number) => {
  const { of, name } = units().length;
  return `${plain(of(mm), 3)} ${name}`;
};

export function planWords(plan: Plan): string {
  const rpm = fixed(plan.speed_rpm, 0);
  switch (plan.decision) {
    case 'keep':
      return t('plan_keep', { rpm });
    case 'constant':
      return t('plan_constant', { percent: plain(plan.override_percent[0] ?? (100 * plan.speed_rpm) / plan.programmed_rpm, 4), rpm });
    case 'law':
      return t('plan_law', { law: t(`law_${plan.law}`), percent: plain(100 * plan.rva, 3), period: plain(plan.period_s, 3) });
    case 'nothing':
      return t('plan_nothing', { depth: depthText(plan.depth_mm) });
  }
}

function shown(plan: Plan): HTMLElement {
  const { limit_depth_mm: limit, likely_depth_mm: likely } = plan;
  return h(
    'div',
    {},
    h('p', { class: 'state-line', id: 'plan-words' }, planWords(plan)),
    h('p', { class: 'hint' }, t('plan_for', { rpm: fixed(plan.programmed_rpm, 0), depth: depthText(plan.depth_mm) })),
    plan.decision !== 'nothing' && limit !== null && h('p', { class: 'hint' }, t('plan_limit', { depth: depthText(limit) })),
    likely !== null && h('p', { class: 'hint' }, t('plan_likely', { depth: depthText(likely) })),
    ...plan.notes.map((note) => h('p', { class: 'hint' }, note)),
  );
}

function waiting({ programmed_rpm, progress }: PlanAnswer): string {
  return programmed_rpm > 0 ? t('computing', { percent: fixed(100 * progress, 0) }) : t('plan_no_speed');
}

export function planPart({ api, live }: Context): Part {
  const body = h('div', {}, h('p', { class: 'none' }, t('loading')));
  const root = panel(t('plan'), 'plan-panel', body);
  let before = '';
  let stop: (() => void) | undefined;
  const put = (what: string, make: () => HTMLElement) => {
    if (what !== before) {
      before = what;
      body.replaceChildren(make());
    }
  };
  const ask = () => {
    api
      .get<PlanAnswer>('chatter/plan')
      .then((answer) => {
        const { plan } = answer;
        put(JSON.stringify([plan, plan ? 1 : answer]), () => (plan ? shown(plan) : h('p', { class: 'none' }, waiting(answer))));
      })
      .catch((error: unknown) => put(String(error), () => problem(error)));
  };
  return {
    root,
    update: () => {
      root.hidden = live.hello?.lobes !== true;
      if (!root.hidden) {
        stop ??= every(ASK_MS, ask);
      }
    },
    close: () => stop?.(),
  };
}
