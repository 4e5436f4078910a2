// SPDX-License-Identifier: Apache-2.0

export function escapeHtml(text: string): string {
  return text.replace(/[&<>"']/g, (c) => `&#${c.charCodeAt(0)};`);
}

/** A row of buttons of which one is pressed. */
export function buttons(id: string, title: string, options: readonly (readonly [string, string])[], chosen: string): string {
  const list = options
    .map(([value, text]) => `<button type="button" data-value="${escapeHtml(value)}" aria-pressed="${value === chosen}">${escapeHtml(text)}</button>`)
    .join('');
  return `<div class="choice" role="group" aria-label="${title}" id="${id}">${list}</div>`;
}

/** `controls` goes beside the title. */
export function section(title: string, body: string, hint = '', controls = ''): string {
  const head = controls === '' ? `<h2>${title}</h2>` : `<div class="bar-head"><h2>${title}</h2><div class="controls">${controls}</div></div>`;
  return `<section>${head}${hint === '' ? '' : `<p class="hint">${hint}</p>`}${body}</section>`;
}
