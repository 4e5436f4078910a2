// SPDX-License-Identifier: Apache-2.0
import type { View } from '../frame/view';
import type { Page } from './data';
import { detectView } from './detect';
import { fitView } from './fit';
import { growthView } from './growth';
import { lobesView } from './lobes';
import { planView } from './plan';
import { simulateView } from './simulate';

/** By kind. */
export const chatterPages: { [K in Page['kind']]: (page: Extract<Page, { kind: K }>) => View } = {
  lobes: lobesView,
  growth: growthView,
  simulate: simulateView,
  detect: detectView,
  plan: planView,
  fit: fitView,
};
