// SPDX-License-Identifier: Apache-2.0
import type { Language } from '../state/settings';
import { de } from './de';
import { en } from './en';
import { REASONS_DE } from './reasons_de';
import { REASONS_RU } from './reasons_ru';
import { REASONS_ZH } from './reasons_zh';
import { ru } from './ru';
import { zh } from './zh';

export type TextKey = keyof typeof en;
/** A language that lacks a text does not compile. */
export type Texts = Record<TextKey, string>;

export const ALL: Record<Language, Texts> = { en, de, zh, ru };
/** The name of each language in itself. */
export const NAMES: Record<Language, string> = { en: 'English', de: 'Deutsch', zh: '中文', ru: 'Русский' };

const REASONS: Record<Language, Readonly<Record<string, string>>> = { en: {}, de: REASONS_DE, zh: REASONS_ZH, ru: REASONS_RU };

let language: Language = 'en';

export function chooseLanguage(now: Language): void {
  language = now;
  document.documentElement.lang = now === 'zh' ? 'zh-Hans' : now;
}

/** A text in the chosen language; names in braces are replaced. */
export function t(key: TextKey, values: Readonly<Record<string, string | number>> = {}): string {
  return ALL[language][key].replace(/\{(\w+)\}/g, (whole, name: string) => String(values[name] ?? whole));
}

/** A reason's sentence; `sentence` of the server where this language has none. */
export function reasonText(name: string, sentence: string): string {
  const own = REASONS[language];
  return Object.hasOwn(own, name) ? (own[name] as string) : sentence;
}
