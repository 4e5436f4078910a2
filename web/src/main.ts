// SPDX-License-Identifier: Apache-2.0
import { chatterPages } from './chatter/pages';
import { cutView } from './cut/view';
import { element } from './frame/dom';
import { start } from './frame/start';
import 'virtual:looks.css';
import './frame/style.css';
import './frame/table.css';
import './plot/plot.css';
import './frame/print.css';
import { benchView } from './motion/bench';
import { estimateView } from './motion/estimate';
import { drawnIn } from './plot/drawn';
import { thermalPages } from './thermal/pages';

/** By the schema of their data. */
start({
  'steadyrest-report/1': cutView,
  'steadyrest-chatter/1': chatterPages,
  'steadyrest-thermal/1': thermalPages,
  'steadyrest-motion/1': { estimate: estimateView },
  'steadyrest-motion-bench/1': benchView,
});

// A handle on each plot for the page's tests and for a browser's console.
Object.assign(window, { steadyrestPlot: (id: string) => drawnIn(element(id)) });
