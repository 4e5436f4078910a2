// SPDX-License-Identifier: Apache-2.0
import '../style.css';
import './bench.css';
import { element, onChoice } from '../dom';
import { onSchemeChange, theme } from '../theme';
import { type Panel, drawPanel, figurePanels, key, lagPanels, traceKey, tracePanels } from './charts';
import { type Bench, parseBench, scenes } from './data';
import { type Choice, type Judge, type Quantity, renderPage, requirementTable, resultsTable } from './page';

/** One chart for each panel in the host, made on first use. */
function drawPanels(host: HTMLElement, panels: readonly Panel[]): void {
  while (host.children.length < panels.length) {
    const figure = host.appendChild(document.createElement('div'));
    figure.className = 'panel';
  }
  panels.forEach((panel, i) => drawPanel(host.children[i] as HTMLElement, panel, theme()));
}

function show(bench: Bench): void {
  const choice: Choice = { acceleration: false, fine: false, judge: 'typical', jerk_mm_s3: 5000, cycle_hz: 1000 };
  let scene = scenes(bench)[0] ?? '';
  renderPage(element('report'), bench, choice, scene);

  const drawLag = () => {
    const panels = lagPanels(bench, scene, theme());
    const lines = new Map(panels.flatMap((p) => p.lines).filter((l) => l.name !== '').map((l) => [l.name, l]));
    element('what').textContent = bench.scenes.find((s) => s.name === scene)?.what ?? '';
    element('key-lag').innerHTML = key([...lines.values()]);
    drawPanels(element('lag'), panels);
  };
  const drawRequirement = () => {
    if (bench.requirement.length > 0) {
      element('requirement').innerHTML = requirementTable(bench, choice);
    }
  };
  const drawResults = (quantity: Quantity) => {
    element('results-host').innerHTML = resultsTable(bench, quantity);
  };
  const drawAll = () => {
    for (const trace of bench.traces) {
      element(`key-${trace.name}`).innerHTML = key(traceKey(theme()));
      drawPanels(element(trace.name), tracePanels(trace, theme()));
    }
    drawLag();
    drawPanels(element('figures'), figurePanels(bench, theme()));
  };

  onChoice('scene', (value) => {
    scene = value;
    drawLag();
  });
  onChoice('results-of', (value) => drawResults(value as Quantity));
  const change = (id: string, set: (value: string) => void) =>
    onChoice(id, (value) => {
      set(value);
      drawRequirement();
    });
  change('quantity', (v) => (choice.acceleration = v === 'a'));
  change('end', (v) => (choice.fine = v === 'fine'));
  change('judge', (v) => (choice.judge = v as Judge));
  change('jerk', (v) => (choice.jerk_mm_s3 = Number(v)));
  change('cycle', (v) => (choice.cycle_hz = Number(v)));
  onSchemeChange(drawAll);
  window.addEventListener('resize', drawAll);
  drawAll();
  drawRequirement();
  drawResults('velocity');
}

const bench = parseBench(element('report-data').textContent ?? '');
if (typeof bench === 'string') {
  element('report').innerHTML = `<p class="none" id="no-data">${bench}</p>`;
} else {
  show(bench);
}
