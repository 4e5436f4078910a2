// SPDX-License-Identifier: Apache-2.0
import { type Head, parsePage } from './data';
import { element } from './dom';
import { onSort } from './table';
import { onSchemeChange, theme } from './theme';
import { type View, show } from './view';

/** Shows what a page's data make, or why they make none, and draws it again when size, scheme or paper change. */
export function start(views: Record<string, (page: never) => View>): void {
  const page = parsePage(element('report-data').textContent ?? '', Object.keys(views));
  const host = element('report');
  if (typeof page === 'string') {
    host.innerHTML = `<p class="none" id="no-data">${page}</p>`;
    return;
  }
  const view = (views[page.schema] as (page: Head) => View)(page);
  let printing = false;
  const draw = () => view.draw(theme(printing));
  const print = (now: boolean) => {
    printing = now;
    document.documentElement.classList.toggle('printing', now);
    draw();
  };
  show(host, view, page);
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
