// SPDX-License-Identifier: Apache-2.0
// The machine file: every setting with its meaning, the whole text, and what the checks say of it.
import { buttons } from '../../frame/html';
import { onChoice } from '../../frame/dom';
import type { Machine } from '../api/types';
import type { Context, MakeView } from '../shell/context';
import { h, panel } from '../shell/h';
import { findingList } from '../shell/problem';
import { t } from '../texts/texts';
import { keyRows } from './keys';
import { machineFile } from './machine_file';
import { localTime } from './times';

interface Body {
  root: HTMLElement;
  close: () => void;
}

function sectionsOf(context: Context, machine: Machine, open: Set<string>): Body {
  const made = machine.sections.map((section) => {
    const rows = keyRows(context, section.keys);
    const details = h('details', { class: 'section', open: open.has(section.name), 'data-section': section.name }, h('summary', {}, h('span', { class: 'section-title' }, section.title), h('code', {}, section.name === '' ? '' : `[${section.name}]`)), rows.root);
    details.addEventListener('toggle', () => (details.open ? open.add(section.name) : open.delete(section.name)));
    return { details, close: rows.close };
  });
  return { root: h('div', { class: 'sections' }, ...made.map((m) => m.details)), close: () => made.forEach((m) => m.close()) };
}

function textOf({ staged }: Context, machine: Machine): Body {
  const area = h('textarea', { id: 'whole-text', spellcheck: 'false', autocomplete: 'off', wrap: 'off', rows: 30, 'aria-label': t('whole_text') });
  area.value = staged.text ?? machine.text;
  area.addEventListener('input', () => staged.setText(area.value, machine.text));
  const end = staged.onChange(() => {
    if (staged.text === undefined && document.activeElement !== area) {
      area.value = machine.text;
    }
  });
  return { root: h('div', {}, h('p', { class: 'hint' }, t('text_hint')), area), close: end };
}

function about({ file, sha256, reload }: Machine): HTMLElement {
  const read = reload ? `${localTime(reload.utc)} · ${reload.outcome}${reload.words === '' ? '' : `: ${reload.words}`}` : '';
  return h('dl', { class: 'facts-list' }, h('dt', {}, t('file')), h('dd', {}, h('code', {}, file)), h('dt', {}, 'SHA-256'), h('dd', {}, h('code', {}, sha256)), ...(read === '' ? [] : [h('dt', {}, t('last_read')), h('dd', {}, read)]));
}

export const machineView: MakeView = (context) => {
  const root = h('div', { class: 'panels-of machine-view' }, h('p', { class: 'none' }, t('loading')));
  let body: Body | undefined;
  let whole = context.staged.text !== undefined;
  let open: Set<string> | undefined;

  const file = machineFile(context, root, (machine) => {
    open ??= new Set(machine.sections.slice(0, 1).map((s) => s.name));
    const sections = open;
    const focused = document.activeElement?.closest<HTMLElement>('[data-section]')?.dataset['section'];
    const place = h('div', {});
    const fill = () => {
      body?.close();
      body = whole ? textOf(context, machine) : sectionsOf(context, machine, sections);
      place.replaceChildren(body.root);
    };
    const choice = h('div', {});
    choice.innerHTML = buttons('machine-as', t('machine'), [['sections', t('sections')], ['text', t('whole_text')]], whole ? 'text' : 'sections');
    root.replaceChildren(panel(t('machine'), 'file-panel', choice, place), h('div', { class: 'column narrow' }, panel(t('findings'), 'findings-panel', findingList(machine.findings ?? [])), panel(t('file'), 'about-panel', about(machine))));
    fill();
    // Found by its id, so it must be in the page.
    onChoice('machine-as', (value) => {
      whole = value === 'text';
      fill();
    });
    if (focused !== undefined) {
      root.querySelector<HTMLElement>(`[data-section="${CSS.escape(focused)}"] summary`)?.focus();
    }
  });
  return {
    root,
    update: file.update,
    close: () => {
      file.close();
      body?.close();
    },
  };
};
