// SPDX-License-Identifier: Apache-2.0
import { fixed, percent, plain } from '../../../frame/numbers';
import { theme as themeNow } from '../../../frame/theme';
import type { ChatterNow } from '../../api/types';
import { SpectrumPicture } from '../../paint/spectrum';
import type { Context } from '../../shell/context';
import { h, panel, setText } from '../../shell/h';
import type { Live } from '../../state/live';
import { t } from '../../texts/texts';
import { bar } from '../bars';
import type { Part } from '../part';

function heardWords({ chatter, frequency_hz }: ChatterNow, chatter_hz: number | null): string {
  const hz = frequency_hz ?? chatter_hz;
  return !chatter ? t('chatter_quiet') : hz === null ? t('chatter_on') : t('chatter_at', { hz: fixed(hz, 0) });
}

/** What the layer does about it, or would do. */
function stepWords({ better_spindle_percent: better, modulating }: ChatterNow, acts: boolean): string {
  if (better != null) {
    return t(acts ? 'chatter_step' : 'chatter_better', { percent: plain(better, 4) });
  }
  return modulating ? t('chatter_modulating') : '';
}

export function chatterWords({ hello, frame, spectrum }: Pick<Live, 'hello' | 'frame' | 'spectrum'>): string {
  const { chatter } = frame ?? {};
  if (!chatter) {
    return t('chatter_none');
  }
  const cuts = frame?.status.cutting !== false;
  const heard = hello?.listening === false ? t('chatter_deaf') : cuts ? heardWords(chatter, spectrum?.chatter_hz ?? null) : t('not_cutting');
  return [heard, stepWords(chatter, frame?.status.mode === 'act')].filter((words) => words !== '').join(' · ');
}

export const levelText = (level: number) => percent(level, 0);

export function chatterPart({ live }: Context): Part {
  const picture: SpectrumPicture = new SpectrumPicture(live, 'spectrum', () => picture.draw(themeNow()));
  const state = h('p', { class: 'state-line', id: 'chatter-state' }, t('waiting'));
  const level = bar(t('level'), 'level');
  return {
    root: panel(t('chatter'), 'chatter', state, level.root, picture.canvas.element),
    update: (theme, figures) => {
      picture.draw(theme);
      const { chatter } = live.frame ?? {};
      level.set(chatter?.level ?? NaN, figures && chatter?.level != null ? levelText(chatter.level) : undefined);
      level.mark(chatter?.threshold ?? null);
      if (figures && live.frame) {
        setText(state, chatterWords(live));
        state.classList.toggle('over', chatter?.chatter === true);
        level.root.hidden = chatter?.level == null;
        picture.canvas.element.hidden = live.hello?.listening === false;
      }
    },
    redraw: (theme) => picture.draw(theme),
    close: () => picture.canvas.close(),
  };
}
