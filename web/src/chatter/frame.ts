// SPDX-License-Identifier: Apache-2.0
// What all pages of the chatter verbs have in common.
import { trimmed } from '../bench/format';
import { element } from '../dom';
import { escapeHtml } from '../page';
import type { Theme } from '../theme';
import type { Maybe } from './data';
import { type Plot, drawPlot } from './plot';

/** A page: its text with hosts in it, and what draws into them. */
export interface View {
  product: string;
  title: string;
  /** HTML. */
  facts: string;
  verdict: string;
  body: string;
  draw: (theme: Theme) => void;
  bind?: (redraw: () => void) => void;
}

export function host(id: string, kind = ''): string {
  return `<div class="plot ${kind}" id="${id}"></div>`;
}

export function section(title: string, body: string, hint = ''): string {
  return `<section><h2>${title}</h2>${hint === '' ? '' : `<p class="hint">${hint}</p>`}${body}</section>`;
}

export function plot(id: string, what: Plot, theme: Theme): void {
  drawPlot(element(id), what, theme);
}

export interface Key {
  name: string;
  colour: string;
  kind?: 'line' | 'dashed' | 'area' | 'dot' | 'hoop';
}

export function keyLine(keys: readonly Key[]): string {
  const item = (k: Key) => `<span class="key"><i class="${k.kind ?? 'line'}" style="--ink:${k.colour}"></i>${escapeHtml(k.name)}</span>`;
  return keys.map(item).join('');
}

export interface Row {
  label: string;
  value: string;
}

export function figures(rows: readonly Row[]): string {
  const row = (r: Row) => `<tr><th scope="row">${r.label}</th><td class="n">${r.value}</td></tr>`;
  return `<table id="figures"><tbody>${rows.map(row).join('')}</tbody></table>`;
}

/** The digits that count: 0.00326, 1.406, 33.3, 5000. */
export function plain(value: Maybe | undefined, count = 4): string {
  return trimmed(value, count);
}

export function show(where: HTMLElement, view: View, version: string): void {
  document.title = `${view.title} – ${view.product}`;
  where.innerHTML = `
  <header><p class="product">${view.product}</p><h1>${escapeHtml(view.title)}</h1><p class="facts">${view.facts}</p></header>
  <section><p id="verdict">${view.verdict}</p></section>
  ${view.body}
  <footer>Steadyrest ${escapeHtml(version)}</footer>`;
}
