// SPDX-License-Identifier: Apache-2.0
// The modulator's panel: law, bounds and frequency, as an operator thinks of them; set at once, or put into the file.
import { plain } from '../../../frame/numbers';
import type { KeyValue, Law, Modulation } from '../../api/types';
import { type Context, gate, layerActs } from '../../shell/context';
import { confirmed } from '../../shell/dialogs';
import { button, field, h, panel, select, setText } from '../../shell/h';
import { problemText } from '../../shell/problem';
import { may } from '../../state/role';
import { t } from '../../texts/texts';
import { typingIn } from '../machine_file';
import type { Part } from '../part';

export const LAWS: readonly Law[] = ['constant', 'square', 'pulse', 'triangle', 'sine', 'random', 'stop'];

export interface Bounds {
  lower_percent: number;
  upper_percent: number;
  frequency_hz: number;
}

/** RVA is the amplitude as a share of the mean: bounds = mean·(1 ± RVA). */
export function boundsOf({ amplitude_ratio, mean_ratio, period_s }: Modulation): Bounds {
  return { lower_percent: 100 * mean_ratio * (1 - amplitude_ratio), upper_percent: 100 * mean_ratio * (1 + amplitude_ratio), frequency_hz: 1 / period_s };
}

export function modulationOf(law: Law, { lower_percent, upper_percent, frequency_hz }: Bounds): Modulation {
  const sum = upper_percent + lower_percent;
  return { law, amplitude_ratio: (upper_percent - lower_percent) / sum, mean_ratio: sum / 200, period_s: 1 / frequency_hz };
}

/** As the machine file has it: a change is staged like any other of its values. */
export function keysOf({ law, amplitude_ratio, period_s, mean_ratio }: Modulation): Record<string, KeyValue> {
  const figure = (value: number) => Number(value.toPrecision(6));
  return {
    'chatter.law': law,
    'chatter.amplitude_percent': figure(100 * amplitude_ratio),
    'chatter.period_s': figure(period_s),
    'chatter.mean_percent': figure(100 * mean_ratio),
  };
}

/** Why these bounds make no modulation; empty if they do. */
export function boundsFault({ lower_percent, upper_percent, frequency_hz }: Bounds): string {
  if (!(lower_percent > 0) || !(upper_percent >= lower_percent)) {
    return t('bad_bounds');
  }
  return frequency_hz > 0 ? '' : t('bad_frequency');
}

/** What nobody has touched stays exact: a field shows four figures. */
const number = (input: HTMLInputElement, shown: number) => (input.value === input.defaultValue ? shown : Number(input.value.trim().replace(',', '.') || NaN));
const input = (name: string, value: number) => h('input', { id: name, value: plain(value, 4).replace('−', '-'), inputmode: 'decimal', autocomplete: 'off' });

const isWords = (m: Modulation) => t('modulation_is', { mean: plain(100 * m.mean_ratio, 4), amplitude: plain(100 * m.amplitude_ratio, 3), period: plain(m.period_s, 3) });

/** At once, for this run. A layer that acts moves the spindle with it, so that takes a second word. */
async function setNow({ api, live, say }: Context, m: Modulation): Promise<string> {
  const acts = layerActs(live);
  const what = () => t('modulation_what', { machine: live.hello?.machine.name ?? '', modulation: `${t(`law_${m.law}`)}. ${isWords(m)}` });
  if (acts && !(await confirmed(t('modulation_ask'), what(), t('modulation_yes')))) {
    return '';
  }
  try {
    await api.post('modulation', acts ? { ...m, confirm: true } : m);
    say(t('modulation_set'));
    return '';
  } catch (error) {
    return problemText(error);
  }
}

/** Staged beside the file's other changes: what differs from the file, whatever is in force. */
async function putIntoFile(context: Context, m: Modulation): Promise<string> {
  try {
    const { sections } = context.machine ?? (await context.loadMachine());
    const keys = sections.flatMap((s) => s.keys);
    for (const [key, value] of Object.entries(keysOf(m))) {
      context.staged.set(key, value, keys.find((k) => k.key === key)?.value ?? null);
    }
    return '';
  } catch (error) {
    return problemText(error);
  }
}

function form(context: Context, now: Modulation): HTMLElement {
  const at = boundsOf(now);
  let { law } = now;
  const [lower, upper, hz] = [input('lower', at.lower_percent), input('upper', at.upper_percent), input('frequency', at.frequency_hz)];
  const laws = select(LAWS.map((l) => [l, t(`law_${l}`)]), law, (value) => (law = value as Law));
  laws.id = 'law';
  const words = h('p', { class: 'hint', id: 'modulation-is' });
  const fault = h('p', { class: 'fault', role: 'alert' });
  const bounds = (): Bounds => ({ lower_percent: number(lower, at.lower_percent), upper_percent: number(upper, at.upper_percent), frequency_hz: number(hz, at.frequency_hz) });
  const tell = () => {
    const why = boundsFault(bounds());
    setText(fault, why);
    if (why === '') {
      setText(words, isWords(modulationOf(law, bounds())));
    }
  };
  const use = (by: (context: Context, m: Modulation) => Promise<string>) => {
    tell();
    if (boundsFault(bounds()) === '') {
      void by(context, modulationOf(law, bounds())).then((why) => setText(fault, why));
    }
  };
  [lower, upper, hz].forEach((i) => i.addEventListener('input', tell));
  const file = h('div', {}, button(t('into_file'), () => use(putIntoFile), { id: 'modulation-into-file' }));
  // One reason is enough.
  const gated = may(context.session.role, 'operator') ? gate(context.session, 'engineer', file) : file;
  const made = h('form', { class: 'fields', id: 'modulation' }, field(t('law'), laws), field(t('lower_bound'), lower), field(t('upper_bound'), upper), field(t('modulation_hz'), hz), h('button', { type: 'submit', class: 'strong', id: 'set-modulation' }, t('set_now')), gated);
  made.addEventListener('submit', (event) => {
    event.preventDefault();
    use(setNow);
  });
  tell();
  return gate(context.session, 'operator', h('div', {}, made, words, fault));
}

export function modulationPart(context: Context): Part {
  const { live } = context;
  const body = h('div', {}, h('p', { class: 'none' }, t('waiting')));
  let shown: string | undefined;
  const show = (modulation: Modulation | null) => {
    shown = JSON.stringify(modulation);
    const focused = body.contains(document.activeElement) ? document.activeElement?.id : undefined;
    const none = live.hello?.chooses_speed === true ? t('modulation_chosen') : t('modulation_none');
    body.replaceChildren(modulation ? form(context, modulation) : h('p', { class: 'none', id: 'modulation-none' }, none));
    if (focused) {
      document.getElementById(focused)?.focus();
    }
  };
  return {
    root: panel(t('modulation'), 'modulation-panel', h('p', { class: 'hint' }, t('modulation_hint')), body),
    update: () => {
      const { hello } = live;
      if (hello && JSON.stringify(hello.modulation) !== shown && !typingIn(body)) {
        show(hello.modulation);
      }
    },
  };
}
