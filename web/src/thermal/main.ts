// SPDX-License-Identifier: Apache-2.0
import '../style.css';
import '../bench/bench.css';
import '../chatter/chatter.css';
import { type View, show } from '../chatter/frame';
import { element } from '../dom';
import { onSchemeChange, theme } from '../theme';
import { type Page, parsePage } from './data';
import { hysteresisView } from './hysteresis';
import { batchView, forecastView, planView } from './views';

function viewOf(page: Page): View {
  switch (page.kind) {
    case 'forecast':
      return forecastView(page);
    case 'plan':
      return planView(page);
    case 'hysteresis':
      return hysteresisView(page);
    case 'batch':
      return batchView(page);
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
  onSchemeChange(draw);
  window.addEventListener('resize', draw);
  window.addEventListener('beforeprint', () => print(true));
  window.addEventListener('afterprint', () => print(false));
  draw();
}
