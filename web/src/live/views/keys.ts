// SPDX-License-Identifier: Apache-2.0
// Settings of the machine file, to be staged.
import type { KeyValue, MachineKey } from '../api/types';
import type { Context } from '../shell/context';
import { h, select, setText } from '../shell/h';
import { t } from '../texts/texts';

export function valueText(value: KeyValue): string {
  if (typeof value === 'boolean') {
    return t(value ? 'yes' : 'no');
  }
  return value === null ? '–' : Array.isArray(value) ? value.join(', ') : String(value);
}

/** The words that a setting may have, where its range names them: `feed_priority | contour_priority`. */
export function wordsOf({ value, range }: MachineKey): string[] {
  if (typeof value !== 'string') {
    return [];
  }
  const words = range.split(/\s*[|,]\s*/).map((w) => w.replace(/^"|"$/g, ''));
  return words.length > 1 && words.includes(value) && words.every((w) => /^[\w-]+$/.test(w)) ? words : [];
}

/** What was typed, as the kind of value that the setting has; undefined if it cannot be. */
export function parsed(text: string, like: KeyValue): KeyValue | undefined {
  const number = (part: string) => (part.trim() === '' ? NaN : Number(part.trim().replace(',', '.')));
  if (typeof like === 'number') {
    const value = number(text);
    return Number.isFinite(value) ? value : undefined;
  }
  if (Array.isArray(like)) {
    const parts = text.split(',').map((p) => p.trim());
    return like.every((v) => typeof v === 'number') ? (parts.every((p) => Number.isFinite(number(p))) ? parts.map(number) : undefined) : parts;
  }
  return text;
}

function control(context: Context, key: MachineKey, changed: () => void): HTMLInputElement | HTMLSelectElement {
  const { staged } = context;
  const now = staged.value(key.key) ?? key.value;
  const stage = (value: KeyValue) => {
    staged.set(key.key, value, key.value);
    changed();
  };
  if (typeof key.value === 'boolean') {
    return select([['true', t('yes')], ['false', t('no')]], String(now), (value) => stage(value === 'true'));
  }
  const words = wordsOf(key);
  if (words.length > 0) {
    return select(words.map((w) => [w, w.replaceAll('_', ' ')]), String(now), stage);
  }
  const input = h('input', { value: Array.isArray(now) ? now.join(', ') : String(now ?? ''), inputmode: typeof key.value === 'number' ? 'decimal' : 'text', autocomplete: 'off', spellcheck: 'false' });
  input.addEventListener('input', () => {
    const value = parsed(input.value, key.value);
    input.setAttribute('aria-invalid', String(value === undefined));
    // What is no value must not leave an earlier one staged.
    stage(value ?? key.value);
  });
  return input;
}

let numbered = 0;

/** One setting: name, value, unit, what is allowed, what it means. */
export function keyRow(context: Context, key: MachineKey): { root: HTMLElement; close: () => void } {
  const { staged } = context;
  const id = `key-${++numbered}`;
  const before = h('span', { class: 'before' });
  const root = h('div', { class: 'key-row', 'data-key': key.key });
  const show = () => {
    const changed = staged.value(key.key) !== undefined;
    root.classList.toggle('changed', changed);
    setText(before, changed ? t('in_force', { value: valueText(key.value) }) : '');
  };
  let input = control(context, key, show);
  const dress = () => {
    input.id = id;
    input.setAttribute('aria-describedby', `${id}-about`);
  };
  dress();
  const unit = key.unit === '' ? null : h('span', { class: 'unit' }, key.unit === 'rev/min' ? t('rpm') : key.unit);
  const value = h('div', { class: 'key-value' }, input, unit, before);
  const about = h('div', { class: 'key-about', id: `${id}-about` }, h('span', {}, key.explanation), key.range === '' ? null : h('span', { class: 'allowed' }, `${t('range')}: ${key.range}`), key.live ? null : h('span', { class: 'restart' }, t('restart_needed')));
  root.append(h('label', { for: id }, h('code', {}, key.key.replace(/^.*\./, ''))), value, about);
  // Discarded or applied: back to what is in force.
  const close = staged.onChange(() => {
    if (staged.value(key.key) === undefined && root.classList.contains('changed')) {
      const fresh = control(context, key, show);
      if (document.activeElement !== input) {
        input.replaceWith(fresh);
        input = fresh;
        dress();
      }
    }
    show();
  });
  show();
  return { root, close };
}

/** Several of them; `close` ends their listening. */
export function keyRows(context: Context, keys: readonly MachineKey[]): { root: HTMLElement; close: () => void } {
  const rows = keys.map((key) => keyRow(context, key));
  return { root: h('div', { class: 'key-rows' }, ...rows.map((r) => r.root)), close: () => rows.forEach((r) => r.close()) };
}
