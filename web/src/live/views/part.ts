// SPDX-License-Identifier: Apache-2.0
// Views are made of parts.
import type { Theme } from '../../frame/theme';
import type { LiveView } from '../shell/context';
import { h } from '../shell/h';

export type Part = LiveView;

function one(root: HTMLElement, parts: readonly Part[]): LiveView {
  return {
    root,
    update: (theme: Theme, figures: boolean) => parts.forEach((p) => p.update?.(theme, figures)),
    redraw: (theme: Theme) => parts.forEach((p) => p.redraw?.(theme)),
    close: () => parts.forEach((p) => p.close?.()),
  };
}

/** One view of several parts. */
export function together(name: string, parts: readonly Part[]): LiveView {
  return one(h('div', { class: `panels-of ${name}` }, ...parts.map((p) => p.root)), parts);
}

/** The same in two columns, a wide one and a narrow one beside it. */
export function columns(name: string, wide: readonly Part[], narrow: readonly Part[]): LiveView {
  const column = (which: string, parts: readonly Part[]) => h('div', { class: `column ${which}` }, ...parts.map((p) => p.root));
  return one(h('div', { class: `panels-of ${name}` }, column('wide', wide), column('narrow', narrow)), [...wide, ...narrow]);
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
