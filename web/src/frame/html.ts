// SPDX-License-Identifier: Apache-2.0
import { shown } from './shown';

export function escapeHtml(text: string): string {
  return shown(text).replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
}

/** As the first word of a sentence. */
export function capital(text: string): string {
  return `${text.charAt(0).toUpperCase()}${text.slice(1)}`;
}

/** Says that there is nothing to show; HTML. */
export function none(text: string, id = ''): string {
  return `<p class="none"${id === '' ? '' : ` id="${id}"`}>${text}</p>`;
}

/** A row of buttons, one of them pressed. */
export function buttons(id: string, title: string, options: readonly (readonly [string, string])[], chosen: string): string {
  const list = options
    .map(([value, text]) => `<button type="button" data-value="${escapeHtml(value)}" aria-pressed="${value === chosen}">${escapeHtml(text)}</button>`)
    .join('');
  return `<div class="choice" role="group" aria-label="${escapeHtml(title)}" id="${id}">${list}</div>`;
}

/** The same as a drop-down list, for more options than a row has room for. */
export function choices(id: string, title: string, options: readonly (readonly [string, string])[], chosen: string): string {
  const list = options.map(([value, text]) => `<option value="${escapeHtml(value)}"${value === chosen ? ' selected' : ''}>${escapeHtml(text)}</option>`).join('');
  return `<select id="${id}" aria-label="${escapeHtml(title)}">${list}</select>`;
}

/** All HTML; `controls` sits beside the title. */
export function section(title: string, body: string, hint = '', controls = ''): string {
  const head = controls === '' ? `<h2>${title}</h2>` : `<div class="bar-head"><h2>${title}</h2><div class="controls">${controls}</div></div>`;
  return `<section>${head}${hint === '' ? '' : `<p class="hint">${hint}</p>`}${body}</section>`;
}
