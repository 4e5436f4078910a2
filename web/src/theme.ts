// SPDX-License-Identifier: Apache-2.0
import type { Scheme } from './scale';

/** Colours of the charts; the page's own stand in style.css. */
export interface Theme {
  scheme: Scheme;
  text: string;
  faint: string;
  rule: string;
  paper: string;
  rapid: string;
  limit: string;
  run: { without: string; with: string };
}

const THEMES: Record<Scheme, Theme> = {
  light: {
    scheme: 'light',
    text: '#1d2329',
    faint: '#59636e',
    rule: '#d8dde2',
    paper: '#ffffff',
    rapid: '#c3c9cf',
    limit: '#1d2329',
    run: { without: '#b4501e', with: '#1b6aa5' },
  },
  dark: {
    scheme: 'dark',
    text: '#e4e8ec',
    faint: '#9aa5b1',
    rule: '#333b44',
    paper: '#14181d',
    rapid: '#4a535d',
    limit: '#e4e8ec',
    run: { without: '#f2955c', with: '#69b3e7' },
  },
};

const dark = () => window.matchMedia('(prefers-color-scheme: dark)');

/** Paper is white whatever the screen is. */
export function theme(printing = false): Theme {
  return THEMES[!printing && dark().matches ? 'dark' : 'light'];
}

export function onSchemeChange(callback: () => void): void {
  dark().addEventListener('change', callback);
}
