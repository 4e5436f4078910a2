// SPDX-License-Identifier: Apache-2.0
import { ApiError } from '../api/client';
import type { Finding, Refusal } from '../api/types';
import { t } from '../texts/texts';
import { button, h } from './h';

/** What went wrong, in a sentence. */
export function problemText(error: unknown): string {
  if (error instanceof ApiError) {
    return [error.message, error.toDo].filter((part) => part !== '').join(' ');
  }
  return t(error instanceof DOMException && error.name === 'TimeoutError' ? 'no_answer' : 'no_connection');
}

/** In the place of what could not be loaded. */
export function problem(error: unknown, again?: () => void): HTMLElement {
  return h('div', { class: 'problem' }, h('p', {}, problemText(error)), again && button(t('retry'), again));
}

export function refusalList(refusals: readonly Refusal[]): HTMLElement | null {
  if (refusals.length === 0) {
    return null;
  }
  const items = refusals.map((r) => h('li', {}, h('b', {}, r.line === undefined ? '' : `${t('line', { line: r.line })}: `), `${r.what} `, r.to_do !== undefined && h('span', { class: 'to-do' }, r.to_do)));
  return h('div', { class: 'refusals' }, h('h3', {}, t('refusals')), h('ul', {}, ...items));
}

export function findingList(findings: readonly Finding[]): HTMLElement {
  if (findings.length === 0) {
    return h('p', { class: 'none' }, t('findings_none'));
  }
  const items = findings.map((f) => h('li', { class: `finding ${f.severity.replace(/\W/g, '')}` }, h('b', {}, f.severity), ` ${f.what} `, h('span', { class: 'to-do' }, f.to_do)));
  return h('ul', { class: 'findings' }, ...items);
}
