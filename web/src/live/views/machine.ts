// SPDX-License-Identifier: Apache-2.0
// The machine file: every setting with its meaning, the whole text, and what the checks say of it.
import { buttons } from '../../frame/html';
import { onChoice } from '../../frame/dom';
import type { Machine } from '../api/types';
import type { Context, MakeView } from '../shell/context';
import { h, panel } from '../shell/h';
import { findingList, problem } from '../shell/problem';
import { t } from '../texts/texts';
import { keyRows } from './keys';
import { localTime } from './times';

interface Body {
  root: HTMLElement;
  close: () => void;
}

function sectionsOf(context: Context, machine: Machine): Body {
  const made = machine.sections.map((section, i) => {
    const rows = keyRows(context, section.keys);
    const details = h('details', { class: 'section', open: i === 0, 'data-section': section.name }, h('summary', {}, h('span', { class: 'section-title' }, section.title), h('code', {}, section.name === '' ? '' : `[${section.name}]`)), rows.root);
    return { details, close: rows.close };
  });
  return { root: h('div', { class: 'sections' }, ...made.map((m) => m.details)), close: () => made.forEach((m) => m.close()) };
}

const TYPING_MS = 300;

function textOf({ staged }: Context, machine: Machine): Body {
  const area = h('textarea', { id: 'whole-text', spellcheck: 'false', autocomplete: 'off', wrap: 'off', rows: 30, 'aria-label': t('whole_text') });
  area.value = staged.text ?? machine.text;
  let timer = 0;
  area.addEventListener('input', () => {
    window.clearTimeout(timer);
    timer = window.setTimeout(() => staged.setText(area.value, machine.text), TYPING_MS);
  });
  const end = staged.onChange(() => {
    if (staged.text === undefined && document.activeElement !== area) {
      area.value = machine.text;
    }
  });
  return {
    root: h('div', {}, h('p', { class: 'hint' }, t('text_hint')), area),
    close: () => {
      window.clearTimeout(timer);
      end();
    },
  };
}

function about({ file, sha256, reload }: Machine): HTMLElement {
  const read = reload ? `${localTime(reload.utc)} · ${reload.outcome}${reload.words === '' ? '' : `: ${reload.words}`}` : '';
  return h('dl', { class: 'facts-list' }, h('dt', {}, t('file')), h('dd', {}, h('code', {}, file)), h('dt', {}, 'SHA-256'), h('dd', {}, h('code', {}, sha256)), ...(read === '' ? [] : [h('dt', {}, t('last_read')), h('dd', {}, read)]));
}

export const machineView: MakeView = (context) => {
  const root = h('div', { class: 'panels-of machine-view' }, h('p', { class: 'none' }, t('loading')));
  let body: Body | undefined;
  let whole = context.staged.text !== undefined;
  let shown: Machine | undefined;
  let closed = false;

  const build = (machine: Machine) => {
    shown = machine;
    const place = h('div', {});
    const fill = () => {
      body?.close();
      body = whole ? textOf(context, machine) : sectionsOf(context, machine);
      place.replaceChildren(body.root);
    };
    const choice = h('div', {});
    choice.innerHTML = buttons('machine-as', t('machine'), [['sections', t('sections')], ['text', t('whole_text')]], whole ? 'text' : 'sections');
    root.replaceChildren(panel(t('machine'), 'file-panel', choice, place), h('div', { class: 'column narrow' }, panel(t('findings'), 'findings-panel', findingList(machine.findings ?? [])), panel(t('file'), 'about-panel', about(machine))));
    fill();
    onChoice('machine-as', (value) => {
      whole = value === 'text';
      fill();
    });
  };
  const load = () => {
    (context.machine ? Promise.resolve(context.machine) : context.loadMachine())
      .then((machine) => {
        // Not in the page yet when it comes from memory: the choice is found by its id.
        if (!closed) build(machine);
      })
      .catch((error: unknown) => root.replaceChildren(problem(error, load)));
  };
  load();
  return {
    root,
    update: (_, figures) => {
      // Read anew by the layer, or applied by somebody else.
      if (figures && shown && context.machine === undefined && !root.contains(document.activeElement)) {
        shown = undefined;
        load();
      }
    },
    close: () => {
      closed = true;
      body?.close();
    },
  };
};
