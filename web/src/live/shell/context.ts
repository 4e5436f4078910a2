// SPDX-License-Identifier: Apache-2.0
// What every view is given, and what it gives back.
import type { Theme } from '../../frame/theme';
import type { Api } from '../api/client';
import type { Machine, Role, Session } from '../api/types';
import type { Live } from '../state/live';
import { may } from '../state/role';
import type { Settings } from '../state/settings';
import type { Staged } from '../state/staged';
import { t } from '../texts/texts';
import { h } from './h';

export interface Context {
  api: Api;
  live: Live;
  session: Session;
  settings: Settings;
  staged: Staged;
  /** The machine file as last read from the server. */
  machine: Machine | undefined;
  /** Reads it again. */
  loadMachine: () => Promise<Machine>;
  /** A sentence for a moment at the foot of the page, read out by screen readers. */
  say: (text: string, urgent?: boolean) => void;
}

export interface LiveView {
  root: HTMLElement;
  /** At most 30 times a second while data come in; `figures` a few times a second, as text can be read no faster. */
  update?: (theme: Theme, figures: boolean) => void;
  /** Everything, after a change of size or look. */
  redraw?: (theme: Theme) => void;
  close?: () => void;
}

export type MakeView = (context: Context, argument: string) => LiveView;

export const roleName = (role: Role) => t(`role_${role}`);

/** Why the session may not use a control; empty if it may. */
export function whyNot({ role }: Session, needed: Role): string {
  return may(role, needed) ? '' : t('role_needed', { needed: roleName(needed), role: roleName(role) });
}

/** What moves the machine at once is then asked for twice: the server takes it only with `confirm`. */
export function layerActs({ status }: Live): boolean {
  return status?.mode === 'act' || status?.mode_wanted === 'act';
}

let numbered = 0;

/** Disables the controls within if the role is too low, and says why beneath them. */
export function gate(session: Session, needed: Role, within: HTMLElement): HTMLElement {
  const why = whyNot(session, needed);
  if (why === '') {
    return within;
  }
  const id = `why-${++numbered}`;
  within.querySelectorAll<HTMLButtonElement>('button, input, select, textarea').forEach((control) => {
    control.disabled = true;
    control.setAttribute('aria-describedby', id);
  });
  within.append(h('p', { class: 'why', id }, why));
  return within;
}
