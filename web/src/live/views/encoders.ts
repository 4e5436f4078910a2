// SPDX-License-Identifier: Apache-2.0
// The encoders as the machine file has them: counts, calibration with its curve, and what the estimates make of it.
import { digits, fixed, plain } from '../../frame/numbers';
import type { Theme } from '../../frame/theme';
import { axisFor } from '../../plot/axes';
import type { Plot } from '../../plot/drawn';
import type { EncoderAxis } from '../api/types';
import type { Context } from '../shell/context';
import { h, panel } from '../shell/h';
import { problem } from '../shell/problem';
import { units } from '../state/units';
import { t } from '../texts/texts';
import type { Part } from './part';
import { Plotted } from './plotted';

/** Rotary axes stay in degrees. */
function tiny(axis: EncoderAxis, um: number | null | undefined, deg: number | null | undefined): string {
  const value = axis.rotary ? deg : um;
  if (value === null || value === undefined) {
    return '–';
  }
  return axis.rotary ? `${plain(value, 4)}\u00a0°` : `${plain(units().small.of(value), 3)}\u00a0${units().small.name}`;
}

function kind({ encoder, estimator }: EncoderAxis): string {
  if (encoder.ideal) {
    return t('encoder_ideal');
  }
  return estimator?.input === 'edges' ? t('encoder_edges', { ns: plain(encoder.clock_ns, 3) }) : t('encoder_counts');
}

function calibrationWords({ calibration }: EncoderAxis): string {
  if (!calibration) {
    return t('calibration_none');
  }
  const lines = calibration.lines === 0 ? t('calibration_phases') : t('calibration_is', { learnt: fixed(calibration.lines_learnt, 0), lines: fixed(calibration.lines, 0) });
  return calibration.applied ? lines : `${lines}; ${t('calibration_unused')}`;
}

function phases(axis: EncoderAxis): string {
  const { phase_error_um = [], phase_error_deg = [] } = axis.calibration ?? {};
  const list = axis.rotary ? phase_error_deg.map((v) => digits(v, 2)) : phase_error_um.map((v) => digits(units().small.of(v), 2));
  return list.length === 0 ? '–' : `${list.join(' / ')}\u00a0${axis.rotary ? '°' : units().small.name}`;
}

const COLUMNS: [Parameters<typeof t>[0], (axis: EncoderAxis) => string][] = [
  ['encoder', kind],
  ['count', (a) => tiny(a, a.encoder.count_um, a.encoder.count_deg)],
  ['line_period', (a) => tiny(a, a.encoder.line_period_um, a.encoder.line_period_deg)],
  ['calibration', calibrationWords],
  ['phase_errors', phases],
  ['line_left', (a) => (!a.estimator ? '–' : a.estimator.bounded ? tiny(a, a.estimator.line_error_um, a.estimator.line_error_deg) : t('no_bounds'))],
  ['latency', (a) => (a.estimator ? t('latency_is', { lag: fixed(a.estimator.lag_ms, 0) }) : '–')],
];

export function calibrationPlot(axis: EncoderAxis, theme: Theme): Plot {
  const curve = axis.calibration?.curve;
  const { small, length } = units();
  const unit = axis.rotary ? '°' : small.name;
  const of = (v: number | null) => (v === null ? null : axis.rotary ? v : small.of(v));
  const x = axis.rotary ? (curve?.at_deg ?? []) : (curve?.at_mm ?? []).map((v) => length.of(v));
  const low = (axis.rotary ? curve?.low_deg : curve?.low_um)?.map(of) ?? [];
  const high = (axis.rotary ? curve?.high_deg : curve?.high_um)?.map(of) ?? [];
  const name = t('calibration_curve', { axis: axis.name, unit });
  return {
    title: name,
    x: { name: t('travel', { unit: axis.rotary ? '°' : length.name }), min: x[0] ?? 0, max: x.at(-1) ?? 1 },
    y: axisFor(name, [...low, ...high], true),
    layers: [{ kind: 'band', name: t('line_errors'), x, low, high, colour: theme.run.with, opacity: 0.5, outlined: true }],
  };
}

/** What is between ` and ` is a command. */
const withCode = (text: string) => text.split('`').map((part, i) => (i % 2 === 1 ? h('code', {}, part) : part));

export function encodersPart(context: Context): Part {
  const place = h('div', { id: 'encoders' }, h('p', { class: 'none' }, t('loading')));
  let plots: Plotted[] = [];
  let reload: number | undefined;
  const show = (axes: readonly EncoderAxis[]) => {
    plots.forEach((p) => p.close());
    const head = h('tr', {}, h('th', { scope: 'col' }, t('axis')), ...COLUMNS.map(([key]) => h('th', { scope: 'col' }, t(key))));
    const rows = axes.map((a) => h('tr', {}, h('th', { scope: 'row' }, a.name), ...COLUMNS.map(([key, of]) => h('td', { 'data-label': t(key) }, h('span', {}, of(a))))));
    const curves = axes.filter((a) => a.calibration?.curve);
    plots = curves.map((a) => new Plotted(`calibration-${a.name}`));
    place.replaceChildren(h('table', { class: 'data live encoders' }, h('thead', {}, head), h('tbody', {}, ...rows)), ...plots.map((p) => p.root));
    curves.forEach((a, i) => void plots[i]?.set((theme) => calibrationPlot(a, theme)));
  };
  const load = () => {
    context.api
      .get<{ motion: { axes: EncoderAxis[] } }>('motion')
      .then(({ motion }) => show(motion.axes))
      .catch((error: unknown) => place.replaceChildren(problem(error, load)));
  };
  load();
  return {
    root: panel(t('encoders'), 'encoders-panel', h('p', { class: 'hint' }, ...withCode(t('encoders_hint'))), place),
    update: () => {
      const now = context.live.status?.reload?.number ?? 0;
      if (reload !== undefined && now !== reload) {
        load();
      }
      reload = now;
    },
    redraw: (theme) => plots.forEach((p) => void p.redraw(theme)),
    close: () => plots.forEach((p) => p.close()),
  };
}
