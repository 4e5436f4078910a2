// SPDX-License-Identifier: Apache-2.0
import { element } from '../dom';
import { onSchemeChange, theme } from '../theme';
import { type View, show } from './frame';

/** Shows what a page's data make, or why they make none, and draws it anew when size, scheme or paper change. */
export function start<Page extends { version: string }>(
  parse: (text: string) => Page | string,
  viewOf: (page: Page) => View,
): void {
  const page = parse(element('report-data').textContent ?? '');
  if (typeof page === 'string') {
    element('report').innerHTML = `<p class="none" id="no-data">${page}</p>`;
    return;
  }
  const view = viewOf(page);
  let printing = false;
  const draw = () => view.draw(theme(printing));
  const print = (now: boolean) => {
    printing = now;
    document.documentElement.classList.toggle('printing', now);
    draw();
  };
  show(element('report'), view, page.version);
  view.bind?.(draw);
  onSchemeChange(draw);
  window.addEventListener('resize', draw);
  window.addEventListener('beforeprint', () => print(true));
  window.addEventListener('afterprint', () => print(false));
  draw();
}
