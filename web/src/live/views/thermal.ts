// SPDX-License-Identifier: Apache-2.0
// Thermal displacement: its history and forecast, the offsets against it, what comes next, measured sizes.
import { digits } from '../../frame/numbers';
import type { Theme } from '../../frame/theme';
import { axisFor } from '../../plot/axes';
import type { Plot } from '../../plot/drawn';
import type { Maybe } from '../../frame/data';
import type { Thermal, ThermalHistory } from '../api/types';
import type { Context, MakeView } from '../shell/context';
import { h, panel } from '../shell/h';
import { problem } from '../shell/problem';
import { figure, small, units } from '../state/units';
import { reasonText, t } from '../texts/texts';
import { measuredPart } from './measured';
import { thermalPart } from './now/thermal';
import { type Part, columns, every } from './part';
import { Plotted } from './plotted';

const ASK_MS = 10_000;
const BAND_SD = 2;

export function historyPlot(axis: ThermalHistory, t_s: readonly number[], theme: Theme): Plot {
  const { of, name } = units().small;
  const last = t_s.at(-1) ?? 0;
  const x = t_s.map((at) => (at - last) / 3600);
  const shown = (values: readonly Maybe[]) => values.map((v) => (v === null ? null : of(v)));
  const edge = (sign: number) => axis.displacement_um.map((d, i) => (d === null ? null : of(d + sign * BAND_SD * (axis.sd_um[i] ?? 0))));
  const [low, high] = [edge(-1), edge(1)];
  const offset = shown(axis.offset_um);
  const left = axis.displacement_um.map((d, i) => (d === null ? null : of(d + (axis.offset_um[i] ?? 0))));
  return {
    title: t('history_axis', { axis: axis.name, unit: name }),
    x: { name: t('time_h'), min: Math.min(x[0] ?? -1, -0.05), max: 0 },
    y: axisFor(t('history_axis', { axis: axis.name, unit: name }), [...low, ...high, ...offset], true),
    group: 'thermal',
    layers: [
      { kind: 'band', name: t('band'), x, low, high, colour: theme.run.with, opacity: 0.2 },
      { kind: 'line', name: t('forecast'), x, y: shown(axis.displacement_um), colour: theme.run.with, width: 2 },
      { kind: 'line', name: t('offset_done'), x, y: offset, colour: theme.run.without, width: 1.6, step: true },
      { kind: 'line', name: t('remaining'), x, y: left, colour: theme.text, width: 1.6 },
    ],
  };
}

function facts({ share_k, passports = [], readings = [] }: Thermal): HTMLElement {
  const unit = units().small.name;
  const rows = passports.flatMap(({ axis, modes }) => modes.map((m) => h('tr', {}, h('th', { scope: 'row' }, axis), h('td', { class: 'n' }, figure(units().small, m.amplitude_um)), h('td', { class: 'n' }, digits(m.time_constant_min, 3)))));
  const head = h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, t('axis')), h('th', { scope: 'col', class: 'n' }, t('amplitude', { unit })), h('th', { scope: 'col', class: 'n' }, t('time_constant'))));
  const said = readings.map((r) => h('li', {}, h('b', {}, `${r.axis} ${small(r.displacement_um)}`), ` ${reasonText(r.reason, r.sentence)}`));
  return h(
    'div',
    {},
    h('dl', { class: 'facts-list' }, h('dt', {}, t('share_k')), h('dd', {}, digits(share_k, 3))),
    rows.length === 0 ? null : h('table', { class: 'data few' }, head, h('tbody', {}, ...rows)),
    said.length === 0 ? null : h('div', {}, h('h3', {}, t('readings')), h('ul', { class: 'said' }, ...said)),
  );
}

/** Asks every 10 s for the plots of all axes and the facts. */
function historyParts(context: Context): [Part, Part] {
  const plots = new Map<string, Plotted>();
  const place = h('div', { class: 'histories' }, h('p', { class: 'none' }, t('loading')));
  const about = h('div', {});
  const show = (thermal: Thermal) => {
    const { axes, t_s } = thermal.history;
    if (axes.map((a) => a.name).join() !== [...plots.keys()].join()) {
      plots.forEach((p) => p.close());
      plots.clear();
      axes.forEach((a) => plots.set(a.name, new Plotted(`thermal-${a.name.replace(/\W/g, '')}`)));
      place.replaceChildren(...[...plots.values()].map((p) => p.root));
    }
    axes.forEach((a) => void plots.get(a.name)?.set((theme) => historyPlot(a, t_s, theme)));
    about.replaceChildren(facts(thermal));
  };
  const load = () => {
    about.parentElement?.toggleAttribute('hidden', context.live.hello?.thermal === false);
    if (context.live.hello?.thermal === false) {
      place.replaceChildren(h('p', { class: 'none' }, t('thermal_none')));
      return;
    }
    context.api
      .get<{ thermal: Thermal }>('thermal')
      .then(({ thermal }) => show(thermal))
      .catch((error: unknown) => plots.size === 0 && place.replaceChildren(problem(error, load)));
  };
  const stop = every(ASK_MS, load);
  return [
    {
      root: panel(t('history'), 'history', place),
      redraw: (theme) => plots.forEach((p) => void p.redraw(theme)),
      close: () => {
        stop();
        plots.forEach((p) => p.close());
      },
    },
    { root: panel(t('passport'), 'thermal-facts', about) },
  ];
}

export const thermalView: MakeView = (context) => {
  const [history, modes] = historyParts(context);
  return columns('thermal-view', [history], [thermalPart(context, t('displacement')), measuredPart(context), modes]);
};
