// SPDX-License-Identifier: Apache-2.0
import { benchView } from './bench/view';
import { viewOf as chatterView } from './chatter/view';
import { cutView } from './cut/view';
import { element } from './frame/dom';
import { start } from './frame/start';
import './frame/style.css';
import './frame/table.css';
import './plot/plot.css';
import './frame/print.css';
import { estimateView } from './motion/estimate';
import { drawnIn } from './plot/drawn';
import { viewOf as thermalView } from './thermal/view';

/** By the schema of their data. */
start({
  'steadyrest-report/1': cutView,
  'steadyrest-chatter/1': chatterView,
  'steadyrest-thermal/1': thermalView,
  'steadyrest-motion/1': estimateView,
  'steadyrest-motion-bench/1': benchView,
});

// For whoever looks at a plot from outside: the page's tests, a browser's console.
Object.assign(window, { steadyrestPlot: (id: string) => drawnIn(element(id)) });
