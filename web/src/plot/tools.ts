// SPDX-License-Identifier: Apache-2.0
// The buttons of every plot.
import { columnsOfPlot, csvOf } from './csv';
import { picture } from './picture';
import { drawnIn } from './drawn';
import { showWhole, zoomBy } from './zoom';

const FACTOR = 2;

/** What the buttons say. */
export interface ToolWords {
  tools: string;
  zoomIn: string;
  zoomOut: string;
  fit: string;
  showWhole: string;
  savePicture: string;
  saveValues: string;
}
export const ENGLISH: ToolWords = {
  tools: 'Plot tools',
  zoomIn: 'Zoom in',
  zoomOut: 'Zoom out',
  fit: 'Fit',
  showWhole: 'Show the whole plot',
  savePicture: 'Save as a picture',
  saveValues: 'Save the values',
};

const button = (tool: string, text: string, title: string) => `<button type="button" data-tool="${tool}" title="${title}">${text}</button>`;

export function toolButtons(words: ToolWords): string {
  return `<span class="tools" role="group" aria-label="${words.tools}">${[
    button('in', '+', words.zoomIn),
    button('out', '−', words.zoomOut),
    button('whole', words.fit, words.showWhole),
    button('png', 'PNG', words.savePicture),
    button('csv', 'CSV', words.saveValues),
  ].join('')}</span>`;
}

function save(name: string, url: string): void {
  const link = document.createElement('a');
  link.href = url;
  link.download = name;
  link.click();
}

function saveText(name: string, text: string): void {
  const url = URL.createObjectURL(new Blob([text], { type: 'text/csv;charset=utf-8' }));
  save(name, url);
  window.setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

/** `rib-pocket.mpf`, `course-error` → `rib-pocket-mpf-course-error`. */
function fileName(id: string): string {
  return `${document.querySelector('h1')?.textContent ?? 'steadyrest'}-${id}`.replace(/[^\w]+/g, '-').replace(/^-|-$/g, '');
}

function use(tool: string, where: HTMLElement): void {
  const now = drawnIn(where);
  if (!now) {
    return;
  }
  const { chart, plot, theme } = now;
  switch (tool) {
    case 'in':
      return zoomBy(where, FACTOR);
    case 'out':
      return zoomBy(where, 1 / FACTOR);
    case 'whole':
      return showWhole(where);
    case 'png':
      // Not `toBlob`, which waits until the browser is idle: the file must be saved within the click.
      return save(`${fileName(where.id)}.png`, picture(chart, plot, theme).toDataURL());
    case 'csv':
      return saveText(`${fileName(where.id)}.csv`, csvOf(plot.columns?.() ?? columnsOfPlot(plot)));
  }
}

export function bindTools(where: HTMLElement): void {
  where.closest('figure')?.querySelectorAll<HTMLElement>('[data-tool]').forEach((b) => b.addEventListener('click', () => use(b.dataset['tool'] ?? '', where)));
}
