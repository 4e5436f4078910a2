// SPDX-License-Identifier: Apache-2.0
// Thermal displacement: its history and the next hour, what drove it, the corrections against it, measured sizes.
import { digits } from '../../frame/numbers';
import type { Thermal } from '../api/types';
import type { Context, MakeView } from '../shell/context';
import { h, panel, setText } from '../shell/h';
import { problem } from '../shell/problem';
import { figure, small, units } from '../state/units';
import { reasonText, t } from '../texts/texts';
import { correctionLists } from './heat/corrections';
import { cyclogramPlot, historyPlot } from './heat/plots';
import { measuredPart } from './measured';
import { nextLine, thermalPart } from './now/thermal';
import { type Part, columns, every } from './part';
import { Plotted } from './plotted';
import { span } from './times';

const ASK_MS = 10_000;

function facts({ share_k, passports = [] }: Thermal): HTMLElement {
  const unit = units().small.name;
  const rows = passports.flatMap(({ axis, modes }) => modes.map((m) => h('tr', {}, h('th', { scope: 'row' }, axis), h('td', { class: 'n' }, figure(units().small, m.amplitude_um)), h('td', { class: 'n' }, digits(m.time_constant_min, 3)))));
  const head = h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, t('axis')), h('th', { scope: 'col', class: 'n' }, t('amplitude', { unit })), h('th', { scope: 'col', class: 'n' }, t('time_constant'))));
  return h(
    'div',
    {},
    h('dl', { class: 'facts-list' }, h('dt', {}, t('share_k')), h('dd', {}, digits(share_k, 3))),
    rows.length === 0 ? null : h('table', { class: 'data few' }, head, h('tbody', {}, ...rows)),
  );
}

const MOST_READINGS = 8;

/** The newest first, each with what became of it. */
function readingList({ history, readings = [] }: Thermal): HTMLElement | null {
  const now = history.t_s.at(-1) ?? 0;
  const said = readings.slice(-MOST_READINGS).reverse().map((r) => h('li', {}, h('b', {}, `${r.axis} ${small(r.displacement_um)}`), ` ${t('before_time', { time: span(Math.max(0, now - r.t_s)) })}: ${reasonText(r.reason, r.sentence)}`));
  return said.length === 0 ? null : h('div', {}, h('h3', {}, t('readings')), h('ul', { class: 'said' }, ...said));
}

const outlookWords = (of_last_s: number) => (of_last_s > 0 ? t('outlook_hint', { time: span(of_last_s) }) : t('outlook_hint_now'));

/** Asks every 10 s, and when a measured size was entered, for everything but the displacement now. */
function historyParts(context: Context): { wide: Part[]; narrow: Part[] } {
  const next = nextLine();
  const plots = new Map<string, Plotted>();
  const cyclogram = new Plotted('thermal-cyclogram');
  const place = h('div', { class: 'histories' }, h('p', { class: 'none' }, t('loading')));
  const outlook = h('p', { class: 'hint', id: 'outlook-of' });
  const driven = h('div', { class: 'histories' });
  const moves = h('div', { id: 'corrections' });
  const about = h('div', {});
  const driving = panel(t('cyclogram'), 'cyclogram', h('p', { class: 'hint' }, t('cyclogram_hint')), driven);
  const correction = panel(t('corrections'), 'corrections-panel', moves);
  const modes = panel(t('passport'), 'thermal-facts', about);
  const readings = h('div', { id: 'readings' });
  const show = (thermal: Thermal) => {
    const { axes } = thermal.history;
    setText(outlook, thermal.outlook ? outlookWords(thermal.outlook.of_last_s) : '');
    if (axes.map((a) => a.name).join() !== [...plots.keys()].join()) {
      plots.forEach((p) => p.close());
      plots.clear();
      axes.forEach((a) => plots.set(a.name, new Plotted(`thermal-${a.name.replace(/\W/g, '')}`)));
      place.replaceChildren(...[...plots.values()].map((p) => p.root));
    }
    axes.forEach((a) => void plots.get(a.name)?.set((theme) => historyPlot(a, thermal, theme)));
    if (thermal.cyclogram && thermal.cyclogram.t_s.length > 0) {
      driven.firstChild ?? driven.append(cyclogram.root);
      void cyclogram.set((theme) => cyclogramPlot(thermal, theme));
    }
    next.set(thermal.next);
    moves.replaceChildren(correctionLists(thermal));
    about.replaceChildren(facts(thermal));
    readings.replaceChildren(...[readingList(thermal)].filter((list) => list !== null));
  };
  let stop: (() => void) | undefined;
  const load = () => {
    const none = context.live.hello?.thermal === false;
    driving.hidden = modes.hidden = correction.hidden = none;
    if (none) {
      place.replaceChildren(h('p', { class: 'none' }, t('thermal_none')));
      return;
    }
    context.api
      .get<{ thermal: Thermal }>('thermal')
      .then(({ thermal }) => show(thermal))
      .catch((error: unknown) => plots.size === 0 && place.replaceChildren(problem(error, load)));
  };
  const historyPart: Part = {
    root: panel(t('history'), 'history', outlook, place),
    update: () => {
      if (context.live.hello) {
        stop ??= every(ASK_MS, load);
      }
    },
    redraw: (theme) => plots.forEach((p) => void p.redraw(theme)),
    close: () => {
      stop?.();
      plots.forEach((p) => p.close());
    },
  };
  const cyclogramPart: Part = {
    root: driving,
    redraw: (theme) => void cyclogram.redraw(theme),
    close: () => cyclogram.close(),
  };
  return {
    wide: [historyPart, cyclogramPart],
    narrow: [thermalPart(context, t('displacement'), next), { root: correction }, measuredPart(context, load, readings), { root: modes }],
  };
}

export const thermalView: MakeView = (context) => {
  const { wide, narrow } = historyParts(context);
  return columns('thermal-view', wide, narrow);
};
