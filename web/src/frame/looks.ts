// SPDX-License-Identifier: Apache-2.0
// The one source of colours, typefaces and spaces, of the reports and the live page: style sheets have them as `var(--name)` (looks_css.ts), plots as
// Theme (theme.ts).

export type Scheme = 'light' | 'dark';
/** High contrast is dark, with stronger colours. */
export type Look = Scheme | 'contrast';

export interface Colours {
  text: string;
  faint: string;
  rule: string;
  paper: string;
  wash: string;
  without: string;
  with: string;
  over: string;
  rapid: string;
  met: string;
  'met-wash': string;
  'forbidden-wash': string;
  'missed-wash': string;
  'over-wash': string;
  act: string;
  'on-act': string;
  'hand-back': string;
  'on-hand-back': string;
}

export const COLOURS: Record<Look, Colours> = {
  light: {
    text: '#1d2329',
    faint: '#59636e',
    rule: '#d8dde2',
    paper: '#ffffff',
    wash: '#f4f6f8',
    without: '#b4501e',
    with: '#1b6aa5',
    over: '#a31f2b',
    rapid: '#c3c9cf',
    met: '#2e7d4f',
    'met-wash': '#d5ecdc',
    'forbidden-wash': '#e3e6ea',
    'missed-wash': '#f8d7cb',
    'over-wash': '#fbe3e4',
    act: '#1b6aa5',
    'on-act': '#ffffff',
    'hand-back': '#b3202c',
    'on-hand-back': '#ffffff',
  },
  dark: {
    text: '#e4e8ec',
    faint: '#9aa5b1',
    rule: '#333b44',
    paper: '#14181d',
    wash: '#1c2229',
    without: '#f2955c',
    with: '#69b3e7',
    over: '#ff8a8a',
    rapid: '#4a535d',
    met: '#6cc090',
    'met-wash': '#1e4430',
    'forbidden-wash': '#2b323a',
    'missed-wash': '#5c2f1e',
    'over-wash': '#4a1f24',
    act: '#69b3e7',
    'on-act': '#14181d',
    'hand-back': '#c4303c',
    'on-hand-back': '#ffffff',
  },
  contrast: {
    text: '#ffffff',
    faint: '#e6e6e6',
    rule: '#8a8a8a',
    paper: '#000000',
    wash: '#1c1c1c',
    without: '#ffb347',
    with: '#5cd6ff',
    over: '#ff8a8a',
    rapid: '#9a9a9a',
    met: '#7dff9b',
    'met-wash': '#003d14',
    'forbidden-wash': '#333333',
    'missed-wash': '#5c1a00',
    'over-wash': '#4d0000',
    act: '#5cd6ff',
    'on-act': '#000000',
    'hand-back': '#ff5252',
    'on-hand-back': '#000000',
  },
};

export const SCHEME: Record<Look, Scheme> = { light: 'light', dark: 'dark', contrast: 'dark' };

export const FONT = 'system-ui, "Segoe UI", "Noto Sans", "DejaVu Sans", sans-serif';

/** The same in every look. */
export const SHARED = {
  font: FONT,
  mono: 'ui-monospace, "DejaVu Sans Mono", monospace',
  /** Between boxes, and inside one. */
  gap: '14px',
  inside: '14px 18px',
};
