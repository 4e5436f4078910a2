// SPDX-License-Identifier: Apache-2.0
import type { View } from '../frame/view';
import { batchView } from './batch';
import type { Page } from './data';
import { fitView } from './fit';
import { forecastView } from './forecast';
import { planView } from './plan';
import { replayView } from './replay';

export function viewOf(page: Page): View {
  switch (page.kind) {
    case 'forecast':
      return forecastView(page);
    case 'plan':
      return planView(page);
    case 'fit':
      return fitView(page);
    case 'replay':
      return replayView(page);
    case 'batch':
      return batchView(page);
  }
}
