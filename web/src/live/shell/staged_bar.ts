// SPDX-License-Identifier: Apache-2.0
// Staged changes: how many there are, what they come to, and the button that applies them.
import { ApiError } from '../api/client';
import type { Checked } from '../api/types';
import { t } from '../texts/texts';
import { type Context, gate, layerActs } from './context';
import { type Dialog, openDialog } from './dialogs';
import { button, h, setText } from './h';
import { findingList, problem, problemText, refusalList } from './problem';

const kindOf = (line: string) => (/^(---|\+\+\+|@@)/.test(line) ? 'head' : line.startsWith('+') ? 'plus' : line.startsWith('-') ? 'minus' : '');

/** A unified diff, its lines coloured. */
export function diffBlock(diff: string): HTMLElement {
  const lines = diff.replace(/\n$/, '').split('\n');
  return h('pre', { class: 'diff', tabindex: 0, 'aria-label': t('difference') }, ...lines.map((line) => h('span', { class: kindOf(line) }, `${line}\n`)));
}

function checkedParts(checked: Checked): HTMLElement[] {
  const parts: HTMLElement[] = [diffBlock(checked.diff)];
  const refused = refusalList(checked.refusals);
  if (refused) {
    parts.push(refused);
  }
  if (!checked.fits_running && checked.refusals.length === 0) {
    parts.push(h('p', { class: 'fault' }, t('fits_not', { why: checked.why_not ?? '' })));
  }
  parts.push(h('h3', {}, t('findings')), findingList(checked.findings));
  return parts;
}

class Review {
  private readonly body = h('div', { class: 'review-body' }, h('p', {}, t('loading')));
  private readonly dialog: Dialog;

  constructor(private readonly context: Context) {
    this.dialog = openDialog(t('review_title'), 'review', this.body);
  }

  async check(note = ''): Promise<void> {
    const { context, body } = this;
    try {
      const checked = await context.api.post<Checked>('machine/check', context.staged.request());
      const good = checked.refusals.length === 0 && checked.fits_running;
      const apply = button(t('apply'), () => void this.apply(checked, apply), { class: 'strong', id: 'apply' });
      const actions = gate(context.session, 'engineer', h('div', { class: 'actions' }, button(t('cancel'), this.dialog.close), apply));
      // Leaving is for everybody.
      actions.querySelectorAll('button').forEach((b) => (b.disabled = b === apply && (b.disabled || !good)));
      body.replaceChildren(...(note === '' ? [] : [h('p', { class: 'fault', role: 'alert' }, note)]), ...checkedParts(checked), actions);
    } catch (error) {
      body.replaceChildren(problem(error, () => void this.check()));
    }
  }

  private async apply(checked: Checked, pressed: HTMLButtonElement): Promise<void> {
    const { context } = this;
    pressed.disabled = true;
    try {
      await context.api.post('machine/apply', { ...context.staged.request(), sha256_before: checked.sha256_before, ...(layerActs(context.live) ? { confirm: true } : {}) });
      context.machine = undefined;
      context.staged.clear();
      this.dialog.close();
      context.say(t('applied'));
    } catch (error) {
      if (error instanceof ApiError && error.code === 'changed_meanwhile') {
        await this.check(t('changed_meanwhile'));
        return;
      }
      pressed.disabled = false;
      const refused = error instanceof ApiError ? refusalList(error.refusals) : null;
      this.body.prepend(h('div', { class: 'fault', role: 'alert' }, problemText(error), refused));
    }
  }
}

export function stagedBar(context: Context): HTMLElement {
  const count = h('p', { 'aria-live': 'polite' });
  const review = button(t('review'), () => void new Review(context).check(), { class: 'strong', id: 'review' });
  const bar = h('div', { class: 'staged', id: 'staged', hidden: true }, count, button(t('discard'), () => context.staged.clear(), { id: 'discard' }), review);
  const show = () => {
    const { count: staged } = context.staged;
    bar.hidden = staged === 0;
    setText(count, staged === 1 ? t('staged_one') : t('staged_many', { count: staged }));
  };
  // A bar that was replaced, by one in another language, listens no longer.
  const end = context.staged.onChange(() => (bar.isConnected ? show() : end()));
  show();
  return bar;
}
