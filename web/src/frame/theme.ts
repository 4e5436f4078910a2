// SPDX-License-Identifier: Apache-2.0
import { COLOURS, type Look, SCHEME, type Scheme } from './looks';

export type { Look, Scheme };

/** Colours of the plots; from those of the pages (looks.ts), and a palette. */
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

const OTHER: Record<Look, readonly string[]> = {
  light: ['#1b6aa5', '#59a0cf', '#b4501e', '#2e7d4f', '#8a5fb0', '#a08a1f', '#c0518b', '#4f5b66', '#1d2329'],
  dark: ['#69b3e7', '#3f7fae', '#f2955c', '#6cc090', '#b797dc', '#d3bd4e', '#e58bba', '#a9b4be', '#e4e8ec'],
  contrast: ['#5cd6ff', '#8fb8ff', '#ffb347', '#7dff9b', '#dcaaff', '#ffee58', '#ff9ad5', '#d9d9d9', '#ffffff'],
};

function themeOf(look: Look): Omit<Theme, 'printing'> {
  const { text, faint, rule, paper, rapid, without, with: layer } = COLOURS[look];
  return { scheme: SCHEME[look], text, faint, rule, paper, rapid, limit: text, run: { without, with: layer }, other: OTHER[look] };
}

const THEMES: Record<Look, Omit<Theme, 'printing'>> = { light: themeOf('light'), dark: themeOf('dark'), contrast: themeOf('contrast') };

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
