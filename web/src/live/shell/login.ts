// SPDX-License-Identifier: Apache-2.0
import type { SessionAnswer } from '../api/types';
import type { Settings } from '../state/settings';
import { t } from '../texts/texts';
import { field, h } from './h';
import { settingFields } from './nav';
import { problemText } from './problem';

interface LogIn {
  answer: SessionAnswer;
  /** Shown above the form. */
  why: string;
  settings: Settings;
  logIn: (by: { name: string; password: string } | { key: string }) => Promise<void>;
  change: (settings: Settings) => void;
}

type Credentials = Parameters<LogIn['logIn']>[0];

function form(name: string, fields: HTMLElement[], credentials: () => Credentials, logIn: LogIn['logIn'], fault: HTMLElement): HTMLFormElement {
  const submit = h('button', { type: 'submit', class: 'strong' }, t('log_in'));
  const made = h('form', { class: `fields ${name}`, id: name }, ...fields, submit);
  made.addEventListener('submit', (event) => {
    event.preventDefault();
    submit.disabled = true;
    fault.replaceChildren();
    logIn(credentials())
      .catch((error: unknown) => fault.replaceChildren(problemText(error)))
      .finally(() => (submit.disabled = false));
  });
  return made;
}

export function logInPage({ answer, why, settings, logIn, change }: LogIn): HTMLElement {
  const fault = h('p', { class: 'fault', role: 'alert' }, why);
  const forms: HTMLElement[] = [];
  if (answer.accounts) {
    const name = h('input', { name: 'name', autocomplete: 'username', required: true, autocapitalize: 'none' });
    const password = h('input', { name: 'password', type: 'password', autocomplete: 'current-password', required: true });
    forms.push(form('by-password', [field(t('name'), name), field(t('password'), password)], () => ({ name: name.value, password: password.value }), logIn, fault));
  }
  if (answer.key_login) {
    const key = h('input', { name: 'key', type: 'password', autocomplete: 'off', required: true });
    forms.push(form('by-key', [h('p', { class: 'hint' }, t('key_hint')), field(t('key'), key)], () => ({ key: key.value.trim() }), logIn, fault));
  }
  return h(
    'main',
    { class: 'log-in', id: 'view' },
    h('div', { class: 'log-in-head' }, h('h1', {}, 'Steadyrest'), h('p', {}, t('log_in_hint'))),
    fault,
    ...forms,
    h('div', { class: 'fields small' }, ...settingFields(settings, change)),
  );
}
