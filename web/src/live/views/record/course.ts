// SPDX-License-Identifier: Apache-2.0
// The course of a past run: one quantity over time, with a slider, and the export of what is shown.
import type { Theme } from '../../../frame/theme';
import { axisFor } from '../../../plot/axes';
import type { Plot } from '../../../plot/drawn';
import { RECORD_PATIENCE_MS } from '../../api/client';
import type { RecordData } from '../../api/types';
import type { Context } from '../../shell/context';
import { button, field, h, panel, select, setText } from '../../shell/h';
import { problem } from '../../shell/problem';
import { fixed } from '../../../frame/numbers';
import { type Unit, units } from '../../state/units';
import { t } from '../../texts/texts';
import type { Part } from '../part';
import { Plotted } from '../plotted';
import { span } from '../times';

const POINTS = 1200;
const WINDOWS_S = [600, 60, 10, 1];
const COLUMNS = ['following_um', 'feed_percent', 'path_speed_mm_min', 'spindle_rpm'] as const;
type ColumnName = (typeof COLUMNS)[number];

function about(column: ColumnName): { name: string; unit: Unit } {
  const as = (name: string): Unit => ({ name, decimals: 0, of: (v) => v, back: (v) => v });
  switch (column) {
    case 'following_um':
      return { name: t('following_error'), unit: units().small };
    case 'feed_percent':
      return { name: t('feed_history'), unit: as('%') };
    case 'path_speed_mm_min':
      return { name: t('path_speed'), unit: units().feed };
    case 'spindle_rpm':
      return { name: t('spindle'), unit: as(t('rpm')) };
  }
}

export function coursePlot(data: RecordData, column: ColumnName, from_s: number, to_s: number, theme: Theme): Plot {
  const { name, unit } = about(column);
  const of = (values: readonly (number | null)[] = []) => values.map((v) => (v === null ? null : unit.of(v)));
  const { min, max } = data.columns[column] ?? { min: [], max: [] };
  const [low, high] = [of(min), of(max)];
  return {
    title: `${name}, ${unit.name}`,
    x: { name: t('time_s'), min: from_s, max: to_s },
    y: axisFor(`${name}, ${unit.name}`, [...low, ...high], true),
    layers: [
      { kind: 'band', name: t('min_to_max'), x: data.t_s, low, high, colour: theme.run.with, opacity: 0.35 },
      { kind: 'line', x: data.t_s, y: high, colour: theme.run.with, width: 1.2 },
      { kind: 'line', x: data.t_s, y: low, colour: theme.run.with, width: 1.2 },
    ],
  };
}

interface Range {
  from: number;
  to: number;
}

/** Where the run is looked at: the slider, its buttons, and the length of the window. */
class Slider {
  private end = 0;
  private window = Infinity;
  private from = 0;
  private readonly slide = h('input', { type: 'range', id: 'time-slider', min: 0, max: 1000, value: 0, 'aria-label': t('from') });
  private readonly shown = h('output', { id: 'time-shown', for: 'time-slider' });
  readonly root: HTMLElement;

  constructor(private readonly changed: (range: Range) => void) {
    const windows = select([['Infinity', t('window_all')], ...WINDOWS_S.map((s): [string, string] => [String(s), span(s)])], 'Infinity', (value) => {
      this.window = Number(value);
      this.go(this.from);
    });
    windows.id = 'time-window';
    this.slide.addEventListener('input', () => this.go((Number(this.slide.value) / 1000) * this.room()));
    const step = (by: number) => this.go(this.from + by * this.window * 0.5);
    const along = h('div', { class: 'along' }, button('◀', () => step(-1), { 'aria-label': t('earlier'), id: 'earlier' }), this.slide, button('▶', () => step(1), { 'aria-label': t('later'), id: 'later' }));
    this.root = h('div', { class: 'slider', hidden: true }, field(t('window'), windows), this.shown, along);
  }

  range(): Range {
    return { from: this.from, to: Math.min(this.from + this.window, this.end) };
  }

  /** Of a run of this length, the whole. */
  start(end: number): void {
    this.end = end;
    this.root.hidden = false;
    this.show();
  }

  private room(): number {
    return Math.max(this.end - this.window, 0);
  }

  private go(to: number): void {
    this.from = Math.min(Math.max(Number.isFinite(to) ? to : 0, 0), this.room());
    this.show();
    this.changed(this.range());
  }

  private show(): void {
    const whole = this.window >= this.end;
    this.slide.disabled = whole;
    this.root.querySelectorAll<HTMLButtonElement>('button').forEach((b) => (b.disabled = whole));
    this.slide.value = String(this.room() === 0 ? 0 : (1000 * this.from) / this.room());
    const range = this.range();
    setText(this.shown, `${fixed(range.from, 1)} … ${t('seconds', { value: fixed(range.to, 1) })}`);
    this.slide.setAttribute('aria-valuetext', this.shown.textContent ?? '');
  }
}

const SLIDING_MS = 120;

/** `exports` are shown below it; the slider once the run's length is known. */
export function recordCourse({ api }: Context, name: string, exports: HTMLElement): Part {
  const base = `records/${encodeURIComponent(name)}`;
  const drawn = new Plotted('course', 'high');
  const body = h('div', {}, h('p', { class: 'none' }, t('loading')));
  let column: ColumnName = COLUMNS[0];
  let asked = 0;
  let timer = 0;
  let length: number | undefined;
  const load = async () => {
    const mine = ++asked;
    const [shown, range] = [column, length === undefined ? undefined : slider.range()];
    const part = range ? `from_s=${range.from}&to_s=${range.to}&` : '';
    try {
      const data = await api.get<RecordData>(`${base}/data?${part}points=${POINTS}&columns=${shown}`, RECORD_PATIENCE_MS);
      if (mine !== asked) {
        return;
      }
      if (length === undefined) {
        length = data.t_s.at(-1) ?? 0;
        slider.start(length);
      }
      const { from, to } = range ?? slider.range();
      body.replaceChildren(drawn.root);
      await drawn.set((theme) => coursePlot(data, shown, from, to, theme));
    } catch (error) {
      if (mine === asked) {
        body.replaceChildren(problem(error, () => void load()));
      }
    }
  };
  const slider = new Slider(() => {
    window.clearTimeout(timer);
    timer = window.setTimeout(() => void load(), SLIDING_MS);
  });
  const quantity = select(COLUMNS.map((c) => [c, `${about(c).name}, ${about(c).unit.name}`]), column, (value) => {
    column = value as ColumnName;
    void load();
  });
  quantity.id = 'quantity';
  void load();
  return {
    root: panel(t('course'), 'course-panel', h('div', { class: 'fields' }, field(t('quantity'), quantity)), body, slider.root, exports),
    redraw: (theme) => void drawn.redraw(theme),
    close: () => {
      window.clearTimeout(timer);
      drawn.close();
    },
  };
}
