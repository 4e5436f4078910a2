// SPDX-License-Identifier: Apache-2.0
import { t } from '../texts/texts';
import { button, h } from './h';

let numbered = 0;

/** While a dialog is open nothing beside it can be pressed, so each has its own button that hands back. */
let handBack: (() => void) | undefined;

export function everyDialogHandsBack(by: (() => void) | undefined): void {
  handBack = by;
}

export interface Dialog {
  root: HTMLDialogElement;
  close: () => void;
}

function beside(root: HTMLElement, { target, clientX, clientY }: MouseEvent): boolean {
  const { left, right, top, bottom } = root.getBoundingClientRect();
  return target === root && (clientX < left || clientX > right || clientY < top || clientY > bottom);
}

/** Opens a dialog over the page. Escape, its × and a press beside it close it. */
export function openDialog(title: string, name: string, ...content: (Node | null)[]): Dialog {
  const id = `dialog-${++numbered}`;
  const root = h('dialog', { class: name, 'aria-labelledby': id });
  const close = () => root.close();
  root.append(h('div', { class: 'dialog-head' }, h('h2', { id }, title), handBack && button(t('hand_back'), handBack, { class: 'hand-back', title: t('hand_back_what') }), button('×', close, { class: 'close', 'aria-label': t('close') })), ...content.filter((c) => c !== null));
  root.addEventListener('close', () => root.remove());
  // Its own padding is the dialog too, and so is the end of a drag that began inside.
  let pressed = false;
  root.addEventListener('pointerdown', (event) => (pressed = beside(root, event)));
  root.addEventListener('click', (event) => pressed && beside(root, event) && close());
  document.body.append(root);
  root.showModal();
  return { root, close };
}

/** Asks before something that matters; `yes` is what the button says. */
export function confirmed(title: string, what: string, yes: string): Promise<boolean> {
  return new Promise((resolve) => {
    let answer = false;
    const no = button(t('cancel'), () => dialog.close(), { autofocus: true });
    const go = button(yes, () => {
      answer = true;
      dialog.close();
    }, { class: 'strong' });
    const dialog = openDialog(title, 'confirm', h('p', {}, what), h('div', { class: 'actions' }, no, go));
    dialog.root.addEventListener('close', () => resolve(answer));
  });
}
