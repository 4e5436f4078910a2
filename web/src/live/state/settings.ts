// SPDX-License-Identifier: Apache-2.0
// What each viewer chooses for this browser.

export const LANGUAGES = ['en', 'de', 'zh', 'ru'] as const;
export const LOOKS = ['auto', 'light', 'dark', 'contrast'] as const;
export const UNITS = ['mm', 'inch'] as const;

export type Language = (typeof LANGUAGES)[number];
export type LookChoice = (typeof LOOKS)[number];
export type Units = (typeof UNITS)[number];

export interface Settings {
  language: Language;
  look: LookChoice;
  units: Units;
}

const KEY = 'steadyrest-settings';

function among<T extends string>(options: readonly T[], value: unknown, otherwise: T): T {
  return options.find((o) => o === value) ?? otherwise;
}

/** From stored text; anything unknown falls back to `languages` of the browser and the defaults. */
export function parseSettings(stored: string | null, languages: readonly string[]): Settings {
  let kept: Record<string, unknown> = {};
  try {
    kept = Object(JSON.parse(stored ?? '{}')) as Record<string, unknown>;
  } catch {
    // Written by something else: as if there were none.
  }
  const spoken = languages.map((l) => l.slice(0, 2).toLowerCase()).find((l) => (LANGUAGES as readonly string[]).includes(l));
  return {
    language: among(LANGUAGES, kept['language'], among(LANGUAGES, spoken, 'en')),
    look: among(LOOKS, kept['look'], 'auto'),
    units: among(UNITS, kept['units'], 'mm'),
  };
}

/** A browser may forbid storage; the choice then lasts until the page is closed. */
export function loadSettings(): Settings {
  let stored: string | null = null;
  try {
    stored = window.localStorage.getItem(KEY);
  } catch {
    // Forbidden.
  }
  return parseSettings(stored, navigator.languages);
}

export function saveSettings(settings: Settings): void {
  try {
    window.localStorage.setItem(KEY, JSON.stringify(settings));
  } catch {
    // Forbidden.
  }
}
