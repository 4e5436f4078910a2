// SPDX-License-Identifier: Apache-2.0

export function element(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) {
    throw new Error(`element ${id} is missing`);
  }
  return found;
}

/** Fills an element that may be absent. */
export function put(id: string, html: string): void {
  const where = document.getElementById(id);
  if (where) {
    where.innerHTML = html;
  }
}

/** Calls back with the pressed button's value; a group that is not on the page has no buttons. */
export function onChoice(id: string, callback: (value: string) => void): void {
  const buttons = [...(document.getElementById(id)?.querySelectorAll('button') ?? [])];
  for (const button of buttons) {
    button.addEventListener('click', () => {
      buttons.forEach((b) => b.setAttribute('aria-pressed', String(b === button)));
      callback(button.dataset['value'] ?? '');
    });
  }
}
