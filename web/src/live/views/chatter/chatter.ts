// SPDX-License-Identifier: Apache-2.0
// Where the cut is on the stability lobes, what the layer hears and its course, the plan, and the modulation of the spindle speed.
import { theme as themeNow } from '../../../frame/theme';
import { SpectrumPicture } from '../../paint/spectrum';
import type { Context, MakeView } from '../../shell/context';
import { h, panel, setText } from '../../shell/h';
import { t } from '../../texts/texts';
import { bar } from '../bars';
import { lineWords, signalWords } from './line';
import { lobesPart } from './lobes';
import { modulationPart } from './modulation';
import { planPart } from './plan';
import { waterfallPart } from './waterfall';
import { chatterWords, levelText } from '../now/chatter';
import { type Part, columns } from '../part';

function vibrationPart({ live }: Context): Part {
  const picture: SpectrumPicture = new SpectrumPicture(live, 'chatter-spectrum', () => picture.draw(themeNow()));
  const state = h('p', { class: 'state-line', id: 'chatter-now' }, t('waiting'));
  const line = h('p', { id: 'chatter-line' });
  const signal = h('p', { class: 'under', id: 'chatter-signal' });
  const before = bar(t('level_before'), 'before');
  const now = bar(t('level_now'), 'level');
  const levels = h('div', { class: 'override-group' }, h('h3', {}, t('before_after')), before.root, now.root);
  const show = () => {
    const { chatter } = live.frame ?? {};
    setText(state, chatterWords(live));
    setText(line, chatter ? lineWords(chatter) : '');
    setText(signal, chatter ? signalWords(chatter) : '');
    state.classList.toggle('over', chatter?.chatter === true);
    levels.hidden = chatter?.level == null;
    picture.canvas.element.hidden = live.hello?.listening === false;
    for (const [which, value] of [[before, chatter?.before], [now, chatter?.level]] as const) {
      which.set(value ?? null, value == null ? '–' : levelText(value));
      which.mark(chatter?.threshold ?? null);
    }
  };
  return {
    root: panel(t('vibration'), 'vibration', state, line, signal, levels, picture.canvas.element),
    update: (theme, figures) => {
      picture.draw(theme);
      if (figures && live.frame) {
        show();
      }
    },
    redraw: (theme) => picture.draw(theme),
    close: () => picture.canvas.close(),
  };
}

export const chatterView: MakeView = (context) => columns('chatter-view', [lobesPart(context), waterfallPart(context)], [vibrationPart(context), planPart(context), modulationPart(context)]);
