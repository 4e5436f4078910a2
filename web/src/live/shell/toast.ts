// SPDX-License-Identifier: Apache-2.0
import { h } from './h';

const SHOWN_MS = 6000;

/** Short messages at the foot of the page, read out by screen readers. */
export class Toast {
  private readonly calm = h('div', { role: 'status', 'aria-live': 'polite' });
  private readonly urgent = h('div', { role: 'alert', 'aria-live': 'assertive' });
  readonly root = h('div', { class: 'toasts' }, this.calm, this.urgent);

  say(text: string, urgent = false): void {
    const where = urgent ? this.urgent : this.calm;
    const message = h('p', { class: urgent ? 'toast urgent' : 'toast' }, text);
    where.replaceChildren(message);
    window.setTimeout(() => message.remove(), SHOWN_MS);
  }
}
