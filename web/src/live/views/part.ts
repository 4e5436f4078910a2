// SPDX-License-Identifier: Apache-2.0
// Views are made of parts.
import type { Theme } from '../../frame/theme';
import type { LiveView } from '../shell/context';
import { h } from '../shell/h';

export type Part = LiveView;

/** One view of several parts. */
export function together(name: string, parts: readonly Part[]): LiveView {
  return {
    root: h('div', { class: `panels-of ${name}` }, ...parts.map((p) => p.root)),
    update: (theme: Theme, figures: boolean) => parts.forEach((p) => p.update?.(theme, figures)),
    redraw: (theme: Theme) => parts.forEach((p) => p.redraw?.(theme)),
    close: () => parts.forEach((p) => p.close?.()),
  };
}

/** A name and its figure; `big` is read from across the shop. */
export function readout(label: string, name: string, big = false): { root: HTMLElement; value: HTMLElement } {
  const value = h('span', { class: 'value', id: name }, '–');
  return { root: h('div', { class: big ? 'readout big' : 'readout' }, h('span', { class: 'label' }, label), value), value };
}

/** Asks again every so often until it is closed; returns what ends it. */
export function every(milliseconds: number, ask: () => void): () => void {
  ask();
  const timer = window.setInterval(ask, milliseconds);
  return () => window.clearInterval(timer);
}
