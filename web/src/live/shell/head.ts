// SPDX-License-Identifier: Apache-2.0
// The head of every view: machine, mode, who is in control, the connection, and the button that hands everything back.
import type { Mode, Status } from '../api/types';
import { t } from '../texts/texts';
import { type Context, gate, whyNot } from './context';
import { confirmed, everyDialogHandsBack } from './dialogs';
import { button, h, setText } from './h';
import { problemText } from './problem';

export type Connection = { state: 'connecting' | 'live' } | { state: 'down'; since: Date };

const MODES: readonly Mode[] = ['observe', 'advise', 'act'];
const SAME_PERCENT = 0.05;
const SAME_UM = 0.01;

/** The layer is in control where it acts and what it writes differs from what the machine would do without it. */
export function layerInControl(status: Status): boolean {
  const differs = (a: number, b: number) => Math.abs(a - b) > SAME_PERCENT;
  const offset = [...status.offset_um, ...status.path_offset_um].some((v) => Math.abs(v) > SAME_UM);
  return status.mode === 'act' && (differs(status.feed_percent, status.feed_panel_percent ?? 100) || differs(status.spindle_percent, 100) || offset);
}

/** Less is no gap that anybody sees. */
const LEAST_MISSING_S = 0.1;

export class Head {
  readonly root: HTMLElement;
  readonly modes: HTMLElement;
  private readonly name = h('h1', { class: 'machine-name' }, '…');
  private readonly badge = h('span', { class: 'badge', id: 'mode-badge' }, '–');
  private readonly say = h('span', { class: 'say', id: 'say' });
  private readonly link = h('span', { class: 'link', id: 'connection' });
  private readonly missing = h('button', { type: 'button', class: 'missing', id: 'missing', hidden: true });
  private readonly modeButtons: Record<Mode, HTMLButtonElement>;

  constructor(private readonly context: Context) {
    everyDialogHandsBack(() => void this.handBack());
    const back = button(t('hand_back'), () => void this.handBack(), { class: 'hand-back', id: 'hand-back', title: t('hand_back_what') });
    this.missing.addEventListener('click', () => this.context.say(this.missing.title));
    this.root = h(
      'header',
      { class: 'bar' },
      h('div', { class: 'identity' }, h('p', { class: 'product' }, 'Steadyrest'), this.name),
      h('div', { class: 'state' }, this.badge, this.say, h('span', { class: 'links' }, this.link, this.missing)),
      back,
    );
    this.modeButtons = Object.fromEntries(MODES.map((mode) => [mode, button(t(`mode_${mode}`), () => void this.ask(mode), { 'aria-pressed': 'false', 'data-mode': mode })])) as Record<Mode, HTMLButtonElement>;
    const group = h('div', { class: 'choice', role: 'group', 'aria-label': t('mode') }, ...MODES.map((m) => this.modeButtons[m]));
    this.modes = gate(context.session, 'operator', h('div', { class: 'modes', title: whyNot(context.session, 'operator') }, group));
  }

  /** After each hello. */
  machine(): void {
    setText(this.name, this.context.live.hello?.machine.name ?? '…');
  }

  update(connection: Connection): void {
    const { status } = this.context.live;
    this.updateLink(connection);
    document.documentElement.dataset['connection'] = connection.state;
    if (!status) {
      return;
    }
    const coming = status.mode_wanted !== status.mode;
    setText(this.badge, t(`mode_${status.mode}`));
    this.badge.dataset['mode'] = status.mode;
    const layer = layerInControl(status);
    if (connection.state === 'down') {
      setText(this.say, t('say_unknown'));
      this.say.dataset['who'] = 'unknown';
      return;
    }
    setText(this.say, coming ? t('mode_coming', { mode: t(`mode_${status.mode_wanted}`) }) : t(layer ? 'say_layer' : 'say_operator'));
    this.say.dataset['who'] = layer ? 'layer' : 'operator';
    for (const mode of MODES) {
      this.modeButtons[mode].setAttribute('aria-pressed', String(mode === status.mode_wanted));
    }
  }

  private updateLink(connection: Connection): void {
    this.link.dataset['state'] = connection.state;
    setText(this.link, connection.state === 'down' ? t('reconnecting', { time: connection.since.toLocaleTimeString(document.documentElement.lang, { hourCycle: 'h23' }) }) : t(connection.state));
    const { seconds, frames, cycles } = this.context.live.missing;
    this.missing.hidden = seconds < LEAST_MISSING_S;
    if (!this.missing.hidden) {
      const values = { seconds: seconds.toFixed(1), frames, cycles };
      setText(this.missing, t('missing', values));
      this.missing.title = t('missing_what', values);
    }
  }

  private async handBack(): Promise<void> {
    try {
      await this.context.api.post('hand-back');
      this.context.say(t('handed_back'));
    } catch (error) {
      this.context.say(t('hand_back_failed', { what: problemText(error) }), true);
    }
  }

  private async ask(mode: Mode): Promise<void> {
    const machine = this.context.live.hello?.machine.name ?? '';
    if (mode === 'act' && !(await confirmed(t('act_ask'), t('act_what', { machine }), t('act_yes')))) {
      return;
    }
    try {
      await this.context.api.post('mode', mode === 'act' ? { mode, confirm: true } : { mode });
    } catch (error) {
      this.context.say(t('failed', { what: problemText(error) }), true);
    }
  }
}
