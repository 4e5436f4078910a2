// SPDX-License-Identifier: Apache-2.0
import '../style.css';
import '../bench/bench.css';
import './chatter.css';
import { type Page, parsePage } from './data';
import { detectView } from './detect';
import type { View } from './frame';
import { growthView } from './growth';
import { lobesView } from './lobes';
import { planView } from './plan';
import { simulateView } from './simulate';
import { start } from './start';

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

start(parsePage, viewOf);
