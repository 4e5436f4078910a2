// SPDX-License-Identifier: Apache-2.0
// Elements made from parts. Text is always text, so nothing from outside turns into HTML.
import { shown } from '../../frame/shown';

export type Child = Node | string | null | undefined | false;
type Listener = (event: Event) => void;
export type Attributes = Readonly<Record<string, string | number | boolean | Listener | undefined>>;

/** A function listens (`onclick`), true sets an empty attribute, false and undefined none. */
export function h<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') {
      made.addEventListener(name.slice(2), value);
    } else if (value !== undefined && value !== false) {
      made.setAttribute(name, value === true ? '' : String(value));
    }
  }
  // What is edited stays as it is.
  const text = (c: string): string => (tag === 'textarea' ? c : shown(c));
  made.append(...children.filter((c): c is Node | string => c instanceof Node || (typeof c === 'string' && c !== '')).map((c) => (typeof c === 'string' ? text(c) : c)));
  return made;
}

/** Only if it differs: the page sets its figures many times a second. */
export function setText(where: HTMLElement, text: string): void {
  const safe = shown(text);
  if (where.textContent !== safe) {
    where.textContent = safe;
  }
}

/** A panel of a view. */
export function panel(title: string, name: string, ...children: Child[]): HTMLElement {
  const head = h('h2', { id: `panel-${name}` }, title);
  return h('section', { class: `panel ${name}`, 'aria-labelledby': `panel-${name}` }, head, ...children);
}

/** A button with text. */
export function button(text: string, onclick: () => void, attributes: Attributes = {}): HTMLButtonElement {
  return h('button', { type: 'button', onclick, ...attributes }, text);
}

let numbered = 0;

/** A label and its control, tied together. */
export function field(label: string, control: HTMLElement, ...after: Child[]): HTMLElement {
  control.id ||= `field-${++numbered}`;
  return h('div', { class: 'field' }, h('label', { for: control.id }, label), control, ...after);
}

export function select(options: readonly (readonly [string, string])[], chosen: string, onchange: (value: string) => void): HTMLSelectElement {
  const made = h('select', {}, ...options.map(([value, text]) => h('option', { value, selected: value === chosen }, text)));
  made.addEventListener('change', () => onchange(made.value));
  return made;
}
