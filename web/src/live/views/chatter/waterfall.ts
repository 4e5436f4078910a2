// SPDX-License-Identifier: Apache-2.0
// The live waterfall and its legend. Without a vibration signal there is none.
import { loudnessScale } from '../../../chatter/raster';
import { type Theme, theme as themeNow } from '../../../frame/theme';
import { type Key, ink, keyLine, scaleLine } from '../../../plot/key';
import { WaterfallPicture, modeColour, spindleOrders, toothOrders } from '../../paint/waterfall';
import type { Context } from '../../shell/context';
import { h, panel } from '../../shell/h';
import { COLUMNS, COLUMN_S } from '../../state/waterfall';
import { t } from '../../texts/texts';
import type { Part } from '../part';

export function waterfallPart({ live }: Context): Part {
  const picture: WaterfallPicture = new WaterfallPicture(live, () => draw(themeNow(), true));
  const keys = h('p', { class: 'key-line' });
  const colours = h('p', { class: 'scale-line' });
  const root = panel(t('waterfall'), 'waterfall-panel', h('p', { class: 'under' }, `${t('hertz', { value: '' }).trim()} · ${t('last_seconds', { seconds: COLUMNS * COLUMN_S })}`), keys, picture.canvas.element, colours);
  let legend = '';
  const explain = (theme: Theme) => {
    const modes: Key[] = live.hello?.modes_hz.length ? [{ name: t('mode_line'), colour: modeColour(theme), mark: 'line' }] : [];
    const lines: Key[] = [{ name: t('tooth_orders'), colour: toothOrders(theme), mark: 'dashed' }, { name: t('spindle_orders'), colour: spindleOrders(theme), mark: 'dashed' }, { name: t('chatter_hz'), colour: theme.run.without, mark: 'line' }, ...modes];
    const now = `${theme.scheme} ${theme.text} ${picture.low_db} ${modes.length}`;
    if (now !== legend) {
      legend = now;
      keys.innerHTML = keyLine(lines);
      colours.innerHTML = scaleLine({ ...loudnessScale(picture.low_db, theme.scheme), title: t('waterfall_scale') });
      ink(root);
    }
  };
  const draw = (theme: Theme, again = false) => {
    root.hidden = live.waterfall.newest === undefined;
    picture.draw(theme, again);
    explain(theme);
  };
  root.hidden = true;
  return { root, update: (theme) => draw(theme), redraw: (theme) => draw(theme, true), close: () => picture.canvas.close() };
}
