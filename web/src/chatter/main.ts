// SPDX-License-Identifier: Apache-2.0
import '../style.css';
import '../bench/bench.css';
import './chatter.css';
import { element } from '../dom';
import { onSchemeChange, theme } from '../theme';
import { type Page, parsePage } from './data';
import { detectView } from './detect';
import { type View, show } from './frame';
import { growthView } from './growth';
import { lobesView } from './lobes';
import { planView } from './plan';
import { simulateView } from './simulate';

function viewOf(page: Page): View {
  switch (page.kind) {
    case 'lobes':
      return lobesView(page);
    case 'growth':
      return growthView(page);
    case 'simulate':
      return simulateView(page);
    case 'detect':
      return detectView(page);
    case 'plan':
      return planView(page);
  }
}

const page = parsePage(element('report-data').textContent ?? '');
if (typeof page === 'string') {
  element('report').innerHTML = `<p class="none" id="no-data">${page}</p>`;
} else {
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
