// SPDX-License-Identifier: Apache-2.0
import { fixed } from '../../../frame/numbers';
import { type Theme, theme as themeNow } from '../../../frame/theme';
import { ink, scaleLine } from '../../../plot/key';
import type { Status } from '../../api/types';
import { PathPicture } from '../../paint/path';
import type { Context } from '../../shell/context';
import { h, panel, setText } from '../../shell/h';
import { length, units } from '../../state/units';
import { t } from '../../texts/texts';
import type { Part } from '../part';

const AXES_SHOWN = 6;

/** What the machine does. */
export const motionWords = ({ motion, cutting }: Status): string => t(cutting ? 'cutting' : motion === 'rapid' ? 'rapid' : 'not_cutting');

export function pathPart({ live }: Context): Part {
  const picture: PathPicture = new PathPicture(live, t('tool_path'), () => picture.draw(themeNow()));
  const legend = h('div', { class: 'scale-line' });
  const key = h('p', { class: 'path-key' }, h('span', { class: 'done' }, t('path_done')), h('span', { class: 'rapid' }, t('rapid')), h('span', { class: 'coming' }, t('path_ahead')), h('span', { class: 'tool' }, t('tool')));
  const positions = h('div', { class: 'positions', id: 'positions' });
  const place = h('p', { class: 'place', id: 'place' });
  let legendOf = '';

  const drawLegend = (theme: Theme) => {
    const { of, decimals, name } = units().small;
    const classes = picture.classes(theme);
    const now = `${theme.paper} ${live.hello?.contour.limit_um}`;
    if (now === legendOf) {
      return;
    }
    legendOf = now;
    const cells = classes.map((c) => ({ colour: c.colour, upTo: fixed(of(c.to_um), Math.min(decimals, 2)), marked: c.over && !classes[classes.indexOf(c) - 1]?.over }));
    legend.innerHTML = scaleLine({ title: t('scale_error', { unit: name }), cells });
    ink(legend);
  };

  const figures = () => {
    const axes = (live.frame?.axes ?? []).slice(0, AXES_SHOWN);
    if (positions.childElementCount !== axes.length) {
      positions.replaceChildren(...axes.map((a) => h('div', { class: 'position' }, h('b', {}, a.name), h('span', { class: 'value' }))));
    }
    const rotary = new Set(live.hello?.machine.axes.filter((a) => a.rotary).map((a) => a.name));
    axes.forEach((axis, i) => {
      const value = positions.children[i]?.lastElementChild as HTMLElement;
      setText(value, rotary.has(axis.name) ? `${fixed(axis.position_mm, 3)}°` : length(axis.position_mm));
    });
    const { status } = live;
    const words = status ? [motionWords(status), `${t('program_line')} ${status.program_line}`] : [];
    if (live.frame && !live.frame.ahead) {
      words.push(t('no_path'));
    }
    setText(place, words.join(' · '));
  };

  return {
    root: panel(t('tool_path'), 'path', place, picture.canvas.element, key, legend, positions),
    update: (theme, slow) => {
      picture.draw(theme);
      if (slow) {
        drawLegend(theme);
        figures();
      }
    },
    redraw: (theme) => {
      picture.draw(theme);
      drawLegend(theme);
    },
    close: () => picture.canvas.close(),
  };
}
