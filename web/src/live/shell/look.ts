// SPDX-License-Identifier: Apache-2.0
import { type Look, chooseLook } from '../../frame/theme';
import type { LookChoice } from '../state/settings';

function systemLook(): Look {
  if (window.matchMedia('(prefers-contrast: more)').matches) {
    return 'contrast';
  }
  return window.matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
}

/** For the style sheets and for what is drawn. */
export function applyLook(choice: LookChoice): void {
  const look = choice === 'auto' ? systemLook() : choice;
  document.documentElement.dataset['look'] = look;
  chooseLook(look);
}
