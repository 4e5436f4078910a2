// SPDX-License-Identifier: Apache-2.0
import { fixed, twoDigits } from '../../../frame/numbers';
import { theme as themeNow } from '../../../frame/theme';
import type { ChatterNow, Spectrum } from '../../api/types';
import { SpectrumPicture } from '../../paint/spectrum';
import type { Context } from '../../shell/context';
import { h, panel, setText } from '../../shell/h';
import { t } from '../../texts/texts';
import { bar } from '../bars';
import type { Part } from '../part';

export function chatterWords(chatter: ChatterNow | null | undefined, spectrum: Spectrum | undefined): string {
  if (!chatter) {
    return t('chatter_none');
  }
  const hz = chatter.frequency_hz ?? spectrum?.chatter_hz ?? null;
  const state = !chatter.chatter ? t('chatter_quiet') : hz === null ? t('chatter_on') : t('chatter_at', { hz: fixed(hz, 0) });
  return chatter.modulating ? `${state} · ${t('chatter_modulating')}` : state;
}

export function chatterPart({ live }: Context): Part {
  const picture: SpectrumPicture = new SpectrumPicture(live, 'spectrum', () => picture.draw(themeNow()));
  const state = h('p', { class: 'state-line', id: 'chatter-state' }, t('waiting'));
  const level = bar(t('level'), 'level');
  return {
    root: panel(t('chatter'), 'chatter', state, level.root, picture.canvas.element),
    update: (theme, figures) => {
      picture.draw(theme);
      const { chatter } = live.frame ?? {};
      const whole = 2 * (chatter?.threshold ?? 0.5);
      level.set((chatter?.level ?? NaN) / whole, figures && chatter?.level != null ? twoDigits(chatter.level) : undefined);
      level.mark(chatter?.threshold == null ? null : 0.5);
      if (figures && live.frame) {
        setText(state, chatterWords(chatter, live.spectrum));
        state.classList.toggle('over', chatter?.chatter === true);
        level.root.hidden = chatter?.level == null;
      }
    },
    redraw: (theme) => picture.draw(theme),
    close: () => picture.canvas.close(),
  };
}
