// SPDX-License-Identifier: Apache-2.0
// The stability lobes with the cut as it is now.
import { type Level, classRaster, radiusLevels } from '../../../chatter/raster';
import { fixed, measure, plain } from '../../../frame/numbers';
import { type Theme, theme as themeNow } from '../../../frame/theme';
import type { ColourScale } from '../../../plot/key';
import type { Plot } from '../../../plot/drawn';
import { type Layer, rules } from '../../../plot/layers';
import type { Lobes, LobesAnswer } from '../../api/types';
import type { Context } from '../../shell/context';
import { h, panel } from '../../shell/h';
import { problem } from '../../shell/problem';
import { units } from '../../state/units';
import { t } from '../../texts/texts';
import type { Part } from '../part';
import { Plotted } from '../plotted';

/** A speed that has moved less than this share of the map is not drawn anew. */
const MOVED = 0.005;
const REDRAW_MS = 1000;
/** While the map is being computed. */
const AGAIN_MS = 700;

function scaleOf(levels: readonly Level[]): ColourScale {
  const edge = (value: number) => (Number.isFinite(value) ? plain(Math.exp(value), 3) : '');
  return { title: t('lobes_scale'), cells: levels.map((l, i) => ({ colour: l.colour, upTo: edge(l.to), marked: l.from === 0 && i > 0 })) };
}

export function lobesPlot({ map, border, depth_mm = null }: Lobes, rpm: number, theme: Theme): Plot {
  const { of, name } = units().length;
  const levels = radiusLevels(map.log_radius, true, theme.scheme);
  const depths = map.depth_mm.map(of);
  const limit = border.depth_mm.map((d) => (d === null ? null : of(d)));
  const ends = (values: readonly number[]): [number, number] => [values[0] ?? 0, values.at(-1) ?? 1];
  const [x, y] = [ends(map.speed_rpm), ends(depths)];
  const layers: Layer[] = [
    { kind: 'raster', canvas: classRaster({ x: map.speed_rpm, y: depths, value: map.log_radius }, levels, { x: border.speed_rpm, y: limit }), x, y },
    { kind: 'line', name: t('border'), x: border.speed_rpm, y: limit, colour: theme.text, width: 2.2 },
  ];
  if (Number.isFinite(rpm) && rpm >= x[0] && rpm <= x[1]) {
    layers.push({ ...rules('x', [rpm], theme.text, true) });
    const label = measure(rpm, 0, t('rpm'));
    const side = rpm > (x[0] + x[1]) / 2 ? 'left' : 'right';
    layers.push({ kind: 'dots', name: t('working_point'), dots: [{ x: rpm, y: depth_mm === null ? y[0] : of(depth_mm), label, side }], colour: theme.run.without, size: 14, bold: true });
  }
  return {
    title: t('lobes'),
    x: { name: t('spindle_speed'), min: x[0], max: x[1] },
    y: { name: t('depth', { unit: name }), min: y[0], max: y[1] },
    plane: true,
    scale: scaleOf(levels),
    layers,
  };
}

export function lobesPart({ api, live }: Context): Part {
  const drawn = new Plotted('lobes', 'high');
  const body = h('div', {}, h('p', { class: 'none' }, t('loading')));
  let lobes: Lobes | undefined;
  let at = NaN;
  let when = 0;
  let again = 0;
  let closed = false;
  const load = () => {
    api
      .get<LobesAnswer>('chatter/lobes')
      .then((answer) => {
        if (closed) {
          return undefined;
        }
        if (!answer.lobes) {
          body.replaceChildren(h('p', { class: 'none', id: 'lobes-computing' }, t('computing', { percent: fixed(100 * answer.progress, 0) })));
          again = window.setTimeout(load, AGAIN_MS);
          return undefined;
        }
        const made = answer.lobes;
        lobes = made;
        body.replaceChildren(drawn.root);
        at = live.samples.newest('rpm');
        return drawn.set((theme) => lobesPlot(made, at, theme));
      })
      .catch((error: unknown) => body.replaceChildren(h('p', { class: 'none' }, t('lobes_none')), problem(error, load)));
  };
  const root = panel(t('lobes'), 'lobes-panel', h('p', { class: 'hint' }, t('lobes_hint')), body);
  let asked = false;
  return {
    root,
    update: (_, figures) => {
      root.hidden = live.hello?.lobes !== true;
      if (!asked && !root.hidden) {
        asked = true;
        load();
      }
      const rpm = live.samples.newest('rpm');
      const range = lobes ? (lobes.map.speed_rpm.at(-1) ?? 1) - (lobes.map.speed_rpm[0] ?? 0) : Infinity;
      if (figures && lobes && performance.now() - when > REDRAW_MS && !(Math.abs(rpm - at) < MOVED * range)) {
        at = rpm;
        when = performance.now();
        void drawn.redraw(themeNow());
      }
    },
    redraw: (theme) => void drawn.redraw(theme),
    close: () => {
      closed = true;
      window.clearTimeout(again);
      drawn.close();
    },
  };
}
