// SPDX-License-Identifier: Apache-2.0
import type { View } from '../frame/view';
import type { Page } from './data';
import { detectView } from './detect';
import { fitView } from './fit';
import { growthView } from './growth';
import { lobesView } from './lobes';
import { planView } from './plan';
import { simulateView } from './simulate';

export function viewOf(page: Page): View {
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
    case 'fit':
      return fitView(page);
  }
}
