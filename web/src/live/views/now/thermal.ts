// SPDX-License-Identifier: Apache-2.0
import type { Thermal, ThermalAxis } from '../../api/types';
import type { Context } from '../../shell/context';
import { h, panel, setText } from '../../shell/h';
import { figure, small, units } from '../../state/units';
import { t } from '../../texts/texts';
import { niceAbove } from '../../../plot/axes';
import { type Part, every } from '../part';
import { span } from '../times';

const ASK_MS = 10_000;

export function nextWords(next: Thermal['next']): string {
  if (!next) {
    return t('next_none');
  }
  const { axis, offset_um, in_s } = next;
  const value = small(offset_um);
  return in_s === null || in_s <= 0 ? t('next_now', { axis, value }) : t('next_in', { axis, value, time: span(in_s) });
}

export function nextLine(): { root: HTMLElement; set: (next: Thermal['next']) => void } {
  const root = h('p', { class: 'next', id: 'next-correction' });
  return { root, set: (next) => root.replaceChildren(h('b', {}, t('next_correction')), ` ${nextWords(next)}`) };
}

interface Row {
  root: HTMLElement;
  set: (axis: ThermalAxis, reach_um: number) => void;
}

/** Displacement with its band about the axis's zero, and a mark where the offset would cancel it. */
function row(name: string): Row {
  const band = h('i', { class: 'band' });
  const at = h('i', { class: 'at' });
  const offset = h('i', { class: 'offset' });
  const value = h('span', { class: 'value' }, '–');
  const done = h('span', { class: 'value done' });
  const root = h('div', { class: 'thermal-row' }, h('b', {}, name), h('span', { class: 'bullet', 'aria-hidden': 'true' }, h('i', { class: 'zero' }), band, at, offset), h('div', { class: 'figures' }, value, done));
  return {
    root,
    set: ({ displacement_um, sd_um, offset_um }, reach_um) => {
      const place = (um: number) => 50 + (50 * Math.min(Math.max(um / reach_um, -1), 1));
      const middle = displacement_um ?? 0;
      const half = 2 * (sd_um ?? 0);
      band.style.left = `${place(middle - half)}%`;
      band.style.width = `${place(middle + half) - place(middle - half)}%`;
      at.style.left = `${place(middle)}%`;
      offset.style.left = `${place(-(offset_um ?? 0))}%`;
      setText(value, displacement_um === null || sd_um === null ? small(displacement_um) : `${figure(units().small, displacement_um)} ± ${small(half)}`);
      setText(done, `${t('offset')} ${small(offset_um)}`);
    },
  };
}

/** The next correction, asked for again and again. */
function nextPart({ live, api }: Context): Part {
  const next = nextLine();
  const close = every(ASK_MS, () => {
    if (live.hello?.thermal !== false) {
      api
        .get<{ thermal: Thermal }>('thermal')
        .then(({ thermal }) => next.set(thermal.next))
        .catch(() => next.root.replaceChildren());
    }
  });
  return { root: next.root, close };
}

/** `next` is the line with the next correction; without one it is asked for here. */
export function thermalPart(context: Context, title = t('thermal'), next: Part = nextPart(context)): Part {
  const { live } = context;
  const off = h('p', { class: 'thermal-off', id: 'thermal-off', role: 'alert', hidden: true });
  const rows = h('div', { class: 'thermal-rows' }, h('p', { class: 'none' }, t('waiting')));
  const made = new Map<string, Row>();
  const show = (axes: readonly ThermalAxis[]) => {
    const names = axes.map((a) => a.name).join();
    if (names !== [...made.keys()].join()) {
      made.clear();
      axes.forEach((a) => made.set(a.name, row(a.name)));
      rows.replaceChildren(...[...made.values()].map((r) => r.root));
    }
    const reach = niceAbove(Math.max(1, ...axes.map((a) => Math.max(Math.abs(a.displacement_um ?? 0) + 2 * (a.sd_um ?? 0), Math.abs(a.offset_um ?? 0)))));
    axes.forEach((a) => made.get(a.name)?.set(a, reach));
  };
  return {
    root: panel(title, 'thermal', off, rows, next.root),
    update: (_, figures) => {
      if (!figures || !live.frame) {
        return;
      }
      off.hidden = live.frame.thermal?.switched_off !== true;
      setText(off, off.hidden ? '' : t('thermal_off'));
      if (live.frame.thermal) {
        show(live.frame.thermal.axes);
      } else {
        made.clear();
        rows.replaceChildren(h('p', { class: 'none' }, t('thermal_none')));
      }
    },
    close: () => next.close?.(),
  };
}
