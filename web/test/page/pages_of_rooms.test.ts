// SPDX-License-Identifier: Apache-2.0
import { testEach } from './every_page';

testEach({
  lobes: 1, modulated: 1, growth: 2, simulate: 6, detect: 3, 'chatter-plan': 1, tap: 5,
  forecast: 2, 'thermal-fit': 4, replay: 3, 'thermal-plan': 3, bench: 14, estimate: 3,
});
