// SPDX-License-Identifier: Apache-2.0
import '../style.css';
import '../bench/bench.css';
import '../chatter/chatter.css';
import type { View } from '../chatter/frame';
import { start } from '../chatter/start';
import { type Page, parsePage } from './data';
import { fitView } from './fit';
import { replayView } from './replay';
import { batchView, forecastView, planView } from './views';

function viewOf(page: Page): View {
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

start(parsePage, viewOf);
