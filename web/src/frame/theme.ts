// SPDX-License-Identifier: Apache-2.0

export type Scheme = 'light' | 'dark';
/** High contrast is dark, with stronger colours. */
export type Look = Scheme | 'contrast';

/** Colours of the plots; those of the page are in style.css. */
export interface Theme {
  scheme: Scheme;
  /** On paper plots are drawn as vectors. */
  printing: boolean;
  text: string;
  faint: string;
  rule: string;
  paper: string;
  rapid: string;
  limit: string;
  run: { without: string; with: string };
  /** A palette for many curves in one plot. */
  other: readonly string[];
}

const THEMES: Record<Look, Omit<Theme, 'printing'>> = {
  light: {
    scheme: 'light',
    text: '#1d2329',
    faint: '#59636e',
    rule: '#d8dde2',
    paper: '#ffffff',
    rapid: '#c3c9cf',
    limit: '#1d2329',
    run: { without: '#b4501e', with: '#1b6aa5' },
    other: ['#1b6aa5', '#59a0cf', '#b4501e', '#2e7d4f', '#8a5fb0', '#a08a1f', '#c0518b', '#4f5b66', '#1d2329'],
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
    other: ['#69b3e7', '#3f7fae', '#f2955c', '#6cc090', '#b797dc', '#d3bd4e', '#e58bba', '#a9b4be', '#e4e8ec'],
  },
  contrast: {
    scheme: 'dark',
    text: '#ffffff',
    faint: '#e6e6e6',
    rule: '#6a6a6a',
    paper: '#000000',
    rapid: '#9a9a9a',
    limit: '#ffffff',
    run: { without: '#ffb347', with: '#5cd6ff' },
    other: ['#5cd6ff', '#8fb8ff', '#ffb347', '#7dff9b', '#dcaaff', '#ffee58', '#ff9ad5', '#d9d9d9', '#ffffff'],
  },
};

let chosen: Look | undefined;

/** Instead of what the system asks for; undefined: as the system asks. */
export function chooseLook(look: Look | undefined): void {
  chosen = look;
}

/** From the palette, again from its start when it runs out. */
export function curveColour({ other, text }: Theme, i: number): string {
  return other[i % other.length] ?? text;
}

const dark = () => window.matchMedia('(prefers-color-scheme: dark)');

/** Paper is white whatever the screen's scheme. */
export function theme(printing = false): Theme {
  return { ...THEMES[printing ? 'light' : (chosen ?? (dark().matches ? 'dark' : 'light'))], printing };
}

export function onSchemeChange(callback: () => void): void {
  dark().addEventListener('change', callback);
}
