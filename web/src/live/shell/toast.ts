// SPDX-License-Identifier: Apache-2.0
import { h } from './h';

const SHOWN_MS = 6000;

/** Short messages at the foot of the page, read out by screen readers. */
export class Toast {
  private readonly calm = h('div', { role: 'status', 'aria-live': 'polite' });
  private readonly urgent = h('div', { role: 'alert', 'aria-live': 'assertive' });
  readonly root = h('div', { class: 'toasts' }, this.calm, this.urgent);

  say(text: string, urgent = false): void {
    // What is outside an open dialog is behind it, and no screen reader reads it out.
    const dialog = document.querySelector('dialog[open]');
    (dialog ?? document.body).append(this.root);
    dialog?.addEventListener('close', () => document.body.append(this.root), { once: true });
    const where = urgent ? this.urgent : this.calm;
    const message = h('p', { class: urgent ? 'toast urgent' : 'toast' }, text);
    where.replaceChildren(message);
    window.setTimeout(() => message.remove(), SHOWN_MS);
  }
}
