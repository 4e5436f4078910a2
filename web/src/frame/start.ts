// SPDX-License-Identifier: Apache-2.0
import { type ByPage, type Head, parsePage } from './data';
import { element } from './dom';
import { none } from './html';
import { onSort } from './table';
import { onSchemeChange, theme } from './theme';
import { type View, show } from './view';

/** Makes a page from its data; each maker knows its own data's type. */
export type Maker = (page: never) => View;

/** Shows the page's data, or why it cannot, and redraws when window, colour scheme or paper change. */
export function start(makers: ByPage<Maker>): void {
  const parsed = parsePage(element('report-data').textContent ?? '', makers);
  const host = element('report');
  if (typeof parsed === 'string') {
    host.innerHTML = none(parsed, 'no-data');
    return;
  }
  const view = (parsed.value as (page: Head) => View)(parsed.head);
  let printing = false;
  const draw = () => view.draw(theme(printing));
  const print = (now: boolean) => {
    printing = now;
    document.documentElement.classList.toggle('printing', now);
    draw();
  };
  show(host, view, parsed.head);
  onSort(host);
  view.bind?.(draw);
  onSchemeChange(draw);
  let width = window.innerWidth;
  window.addEventListener('resize', () => {
    if (!printing && window.innerWidth !== width) {
      width = window.innerWidth;
      draw();
    }
  });
  window.addEventListener('beforeprint', () => print(true));
  window.addEventListener('afterprint', () => print(false));
  draw();
}
