// SPDX-License-Identifier: Apache-2.0
// The one frame of all pages: head, verdict, body, how to read it, how it was made.
import type { Head, Made } from './data';
import { capital, escapeHtml, section } from './html';
import { table } from './table';
import type { Theme } from './theme';

/** A term on the page and what it means; HTML. */
export type Term = readonly [string, string];

/** A page: its text with places for plots, and what draws into them. */
export interface View {
  product: string;
  title: string;
  /** HTML, like `verdict` and `body`. */
  facts: string;
  verdict: string;
  body: string;
  explanation: readonly Term[];
  draw: (theme: Theme) => void;
  bind?: (redraw: () => void) => void;
}

/** No use on paper. */
const PLOTS =
  '<dt class="on-screen">Plots</dt><dd class="on-screen">Zoom with Ctrl + wheel or + and −; Shift + wheel zooms the height. Drag to pan; “Fit” shows the whole plot again. PNG saves the picture as shown, CSV the values behind it.</dd>';

function explanation(terms: readonly Term[]): string {
  return `<section class="explanation"><h2>How to read this</h2><dl>${terms.map(([term, text]) => `<dt>${term}</dt><dd>${text}</dd>`).join('')}${PLOTS}</dl></section>`;
}

/** What the verb had to say, one sentence a line; empty if nothing. HTML. */
export function said(id: string, sentences: readonly string[]): string {
  const whole = (text: string) => `${capital(text)}${/[.!?]$/.test(text) ? '' : '.'}`;
  return sentences.length === 0 ? '' : `<ul class="notes" id="${id}">${sentences.map((s) => `<li>${escapeHtml(whole(s))}</li>`).join('')}</ul>`;
}

function provenance(made: Made | undefined): string {
  if (!made) {
    return '';
  }
  const date = made.date === null ? 'left out, so that the same command gives the same bytes' : `<time datetime="${escapeHtml(made.date)}">${escapeHtml(made.date)}</time>`;
  const inputs = made.inputs.map((i) => [i.file, { html: i.sha256 === null ? 'a stream, which cannot be read again' : `<code>${escapeHtml(i.sha256)}</code>`, look: 'hash' }]);
  const list = inputs.length === 0 ? '' : table({ id: 'inputs', columns: [{ head: 'Input' }, { head: 'SHA-256' }], rows: inputs });
  return section(
    'How this was made',
    `<dl class="made"><dt>Date</dt><dd id="made-date">${date}</dd><dt>Command</dt><dd><code id="made-command">${escapeHtml(made.command)}</code></dd></dl>${list}`,
  );
}

export function show(where: HTMLElement, view: View, head: Head): void {
  document.title = `${view.title} – ${view.product}`;
  where.innerHTML = `
  <header><p class="product">${view.product}</p><h1>${escapeHtml(view.title)}</h1><p class="facts">${view.facts}</p></header>
  <section><p id="verdict">${view.verdict}</p></section>
  ${view.body}
  ${explanation(view.explanation)}
  ${provenance(head.made)}
  <footer>Steadyrest ${escapeHtml(head.version)}</footer>`;
}
