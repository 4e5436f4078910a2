// SPDX-License-Identifier: Apache-2.0
// Horizontal bars whose length follows a figure.
import type { Maybe } from '../../frame/data';
import { h, setText } from '../shell/h';

export interface Bar {
  root: HTMLElement;
  /** `share` of the whole length, and what it says; no text leaves the old one. */
  set: (share: Maybe, text?: string) => void;
  /** A mark across the bar. */
  mark: (share: Maybe) => void;
}

export function bar(label: string, name: string): Bar {
  const fill = h('i', { class: 'fill' });
  const mark = h('i', { class: 'mark', hidden: true });
  const value = h('span', { class: 'value' }, '–');
  const track = h('span', { class: 'track', 'aria-hidden': 'true' }, fill, mark);
  const within = (share: number) => Math.min(Math.max(share, 0), 1);
  return {
    root: h('div', { class: `bar-row ${name}` }, h('span', { class: 'label' }, label), track, value),
    set: (share, text) => {
      fill.style.transform = `scaleX(${share === null || !Number.isFinite(share) ? 0 : within(share)})`;
      if (text !== undefined) {
        setText(value, text);
      }
    },
    mark: (share) => {
      mark.hidden = share === null || !Number.isFinite(share);
      if (!mark.hidden) {
        mark.style.left = `${100 * within(share as number)}%`;
      }
    },
  };
}
