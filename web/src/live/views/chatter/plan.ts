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

/** `heard`: the step that the layer has chosen by ear, in percent. It knows the cut better than the plan, and one panel must not name two speeds. */
function shown(plan: Plan, heard: number | null): HTMLElement {
  const differs = heard !== null && Math.abs(heard - (100 * plan.speed_rpm) / plan.programmed_rpm) > 1e-6;
  if (differs) {
    const words = t('plan_constant', { percent: plain(heard, 4), rpm: fixed((heard / 100) * plan.programmed_rpm, 0) });
    return h('div', {}, h('p', { class: 'state-line', id: 'plan-words' }, words), h('p', { class: 'hint' }, t('plan_for', { rpm: fixed(plan.programmed_rpm, 0), depth: depthText(plan.depth_mm) })));
  }
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
        const heard = live.frame?.chatter?.better_spindle_percent ?? null;
        put(JSON.stringify([plan, plan ? heard : answer]), () => (plan ? shown(plan, heard) : h('p', { class: 'none' }, waiting(answer))));
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
