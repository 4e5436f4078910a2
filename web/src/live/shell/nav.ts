// SPDX-License-Identifier: Apache-2.0
import { LANGUAGES, LOOKS, type Settings, UNITS } from '../state/settings';
import { NAMES, t } from '../texts/texts';
import { type Context, roleName } from './context';
import { openDialog } from './dialogs';
import { button, field, h, select } from './h';
import { VIEW_NAMES, addressOf } from './route';

interface Actions {
  change: (settings: Settings) => void;
  logOut: () => void;
}

/** Language, appearance, units. */
export function settingFields(settings: Settings, change: (settings: Settings) => void): HTMLElement[] {
  const language = select(LANGUAGES.map((l) => [l, NAMES[l]]), settings.language, (value) => change({ ...settings, language: value as Settings['language'] }));
  const look = select(LOOKS.map((l) => [l, t(`look_${l}`)]), settings.look, (value) => change({ ...settings, look: value as Settings['look'] }));
  const units = select(UNITS.map((u) => [u, t(`units_${u}`)]), settings.units, (value) => change({ ...settings, units: value as Settings['units'] }));
  [language.id, look.id, units.id] = ['set-language', 'set-look', 'set-units'];
  return [field(t('language'), language), field(t('look'), look), field(t('units'), units)];
}

function openSettings(context: Context, { change, logOut }: Actions): void {
  const { name, role } = context.session;
  const out = button(t('log_out'), () => {
    dialog.close();
    logOut();
  }, { id: 'log-out' });
  const changed = (settings: Settings) => {
    dialog.close();
    change(settings);
  };
  const dialog = openDialog(
    t('settings'),
    'settings',
    h('div', { class: 'fields' }, ...settingFields(context.settings, changed)),
    h('div', { class: 'actions who' }, h('p', {}, t('logged_in', { name, role: roleName(role) })), out),
  );
}

export function nav(context: Context, actions: Actions): HTMLElement {
  const links = VIEW_NAMES.map((view) => h('a', { href: addressOf(view), 'data-view': view }, t(view)));
  return h('nav', { 'aria-label': t('views') }, ...links, button(t('settings'), () => openSettings(context, actions), { id: 'settings' }));
}
