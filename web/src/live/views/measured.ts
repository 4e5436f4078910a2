// SPDX-License-Identifier: Apache-2.0
// Entry of a measured size: it re-zeroes the thermal model.
import type { Verdict } from '../api/types';
import { type Context, gate, layerActs } from '../shell/context';
import { confirmed } from '../shell/dialogs';
import { field, h, panel, select, setText } from '../shell/h';
import { problemText } from '../shell/problem';
import { small, units } from '../state/units';
import { reasonText, t } from '../texts/texts';
import type { Part } from './part';

const number = (text: string) => Number(text.trim().replace(',', '.').replace('−', '-') || NaN);

function verdictWords({ taken, reason, sentence }: Verdict): string {
  if (reason !== undefined) {
    return reasonText(reason, sentence ?? reason);
  }
  return t(taken === false ? 'reading_rejected' : 'reading_taken');
}

function form(context: Context, axes: readonly string[], entered: () => void): HTMLElement {
  const unit = units().small;
  const value = h('input', { id: 'measured-value', inputmode: 'decimal', autocomplete: 'off', required: true });
  const sd = h('input', { id: 'measured-sd', inputmode: 'decimal', autocomplete: 'off', value: unit.of(1).toFixed(unit.decimals) });
  let axis = axes[0] ?? 'Z';
  const which = select(axes.map((a) => [a, a]), axis, (chosen) => (axis = chosen));
  which.id = 'measured-axis';
  const fault = h('p', { class: 'fault', role: 'alert' });
  const verdict = h('p', { class: 'said', role: 'status', id: 'verdict-of-reading' });
  const enter = h('button', { type: 'submit', class: 'strong' }, t('enter'));
  const made = h('form', { class: 'fields', id: 'measured' }, field(t('axis'), which), field(t('measured_value', { unit: unit.name }), value), field(t('measured_sd', { unit: unit.name }), sd), enter);
  // It is about the size before.
  made.addEventListener('input', () => setText(verdict, ''));
  const send = async (size: { axis: string; displacement_um: number; sd_um: number }) => {
    const acts = layerActs(context.live);
    const what = () => t('measured_what', { machine: context.live.hello?.machine.name ?? '', axis: size.axis, value: small(size.displacement_um) });
    if (acts && !(await confirmed(t('measured_ask'), what(), t('measured_yes')))) {
      return;
    }
    // Pressed twice, it would count twice.
    enter.disabled = true;
    try {
      const answer = await context.api.post<{ verdict: Verdict }>('thermal/measured', acts ? { ...size, confirm: true } : size);
      setText(verdict, verdictWords(answer.verdict));
      value.value = '';
      entered();
    } catch (error) {
      setText(fault, problemText(error));
    } finally {
      enter.disabled = false;
    }
  };
  made.addEventListener('submit', (event) => {
    event.preventDefault();
    const [displacement_um, sd_um] = [unit.back(number(value.value)), unit.back(number(sd.value))];
    const why = !Number.isFinite(displacement_um) ? t('bad_number') : sd_um > 0 ? '' : t('bad_sd');
    setText(fault, why);
    setText(verdict, '');
    if (why === '') {
      void send({ axis, displacement_um, sd_um });
    }
  });
  return gate(context.session, 'operator', h('div', {}, made, fault, verdict));
}

/** `entered` is called when the layer has judged a size; `readings` are those before. */
export function measuredPart(context: Context, entered: () => void, readings: HTMLElement): Part {
  const { live } = context;
  const body = h('div', {});
  let shown = '';
  return {
    root: panel(t('measured'), 'measured-panel', h('p', { class: 'hint' }, t('measured_hint')), body, readings),
    update: () => {
      body.parentElement?.toggleAttribute('hidden', live.hello?.measures !== true);
      const axes = live.frame?.thermal?.axes.map((a) => a.name) ?? [];
      if (axes.join() !== shown) {
        shown = axes.join();
        body.replaceChildren(form(context, axes, entered));
      }
    },
  };
}
