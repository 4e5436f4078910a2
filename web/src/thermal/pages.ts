// SPDX-License-Identifier: Apache-2.0
import type { View } from '../frame/view';
import { batchView } from './batch';
import type { Page } from './data';
import { fitView } from './fit';
import { forecastView } from './forecast';
import { planView } from './plan';
import { replayView } from './replay';

/** By kind. */
export const thermalPages: { [K in Page['kind']]: (page: Extract<Page, { kind: K }>) => View } = {
  forecast: forecastView,
  plan: planView,
  fit: fitView,
  replay: replayView,
  batch: batchView,
};
