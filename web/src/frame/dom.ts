// SPDX-License-Identifier: Apache-2.0

export function element(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) {
    throw new Error(`element ${id} is missing`);
  }
  return found;
}

/** Fills an element that need not exist. */
export function put(id: string, html: string): void {
  const where = document.getElementById(id);
  if (where) {
    where.innerHTML = html;
  }
}

/** Calls back with the value of the pressed button or the chosen option. The page need not have such a control. */
export function onChoice(id: string, callback: (value: string) => void): void {
  const control = document.getElementById(id);
  if (control instanceof HTMLSelectElement) {
    control.addEventListener('change', () => callback(control.value));
  }
  const buttons = [...(control?.querySelectorAll('button') ?? [])];
  for (const button of buttons) {
    button.addEventListener('click', () => {
      buttons.forEach((b) => b.setAttribute('aria-pressed', String(b === button)));
      callback(button.dataset['value'] ?? '');
    });
  }
}
