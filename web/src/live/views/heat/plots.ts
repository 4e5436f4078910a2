// SPDX-License-Identifier: Apache-2.0
// Heat over time: an axis's displacement with the next hour, and what drove it. One axis of time, 0 is now.
import type { Maybe } from '../../../frame/data';
import type { Theme } from '../../../frame/theme';
import { axisFor } from '../../../plot/axes';
import type { Plot } from '../../../plot/drawn';
import type { Layer } from '../../../plot/layers';
import { rules } from '../../../plot/layers';
import type { Thermal, ThermalHistory } from '../../api/types';
import { units } from '../../state/units';
import { t } from '../../texts/texts';

const BAND_SD = 2;
const HOUR_S = 3600;

const shown = (values: readonly Maybe[]) => values.map((v) => (v === null ? null : units().small.of(v)));
const edge = ({ displacement_um, sd_um }: ThermalHistory, sign: number) => shown(displacement_um.map((d, i) => (d === null ? null : d + sign * BAND_SD * (sd_um[i] ?? 0))));
const left = ({ displacement_um, offset_um }: ThermalHistory) => shown(displacement_um.map((d, i) => (d === null ? null : d + (offset_um[i] ?? 0))));

function timeAxis({ history, outlook }: Thermal) {
  const last = history.t_s.at(-1) ?? 0;
  const first = ((history.t_s[0] ?? last) - last) / HOUR_S;
  return { last, axis: { name: t('time_h'), min: Math.min(first, -0.05), max: outlook ? (outlook.in_s.at(-1) ?? 0) / HOUR_S : 0 } };
}

export function historyPlot(axis: ThermalHistory, thermal: Thermal, theme: Theme): Plot {
  const { last, axis: time } = timeAxis(thermal);
  const x = thermal.history.t_s.map((at) => (at - last) / HOUR_S);
  const [low, high] = [edge(axis, -1), edge(axis, 1)];
  const ahead = thermal.outlook?.axes.find((a) => a.name === axis.name);
  const later = ahead ? (thermal.outlook?.in_s ?? []).map((s) => s / HOUR_S) : [];
  const layers: Layer[] = [
    { kind: 'band', name: t('band'), x: [...x, ...later], low: [...low, ...(ahead ? edge(ahead, -1) : [])], high: [...high, ...(ahead ? edge(ahead, 1) : [])], colour: theme.run.with, opacity: 0.2 },
    { kind: 'line', name: t('forecast'), x, y: shown(axis.displacement_um), colour: theme.run.with, width: 2 },
    { kind: 'line', name: t('offset_done'), x, y: shown(axis.offset_um), colour: theme.run.without, width: 1.6, step: true },
    { kind: 'line', name: t('remaining'), x, y: left(axis), colour: theme.text, width: 1.6 },
  ];
  if (ahead) {
    layers.push(
      { kind: 'line', name: t('outlook_line'), x: later, y: shown(ahead.displacement_um), colour: theme.run.with, width: 2, dashed: true },
      { kind: 'line', name: t('outlook_offset'), x: later, y: shown(ahead.offset_um), colour: theme.run.without, width: 1.6, dashed: true },
      rules('x', [0], theme.faint, true),
    );
  }
  const name = t('history_axis', { axis: axis.name, unit: units().small.name });
  const reach = ahead ? [...edge(ahead, -1), ...edge(ahead, 1), ...shown(ahead.offset_um)] : [];
  return { title: name, x: time, y: axisFor(name, [...low, ...high, ...shown(axis.offset_um), ...reach], true), group: 'thermal', layers };
}

/** Where the machine was in the cut for most of the time. */
function cuts(x: readonly number[], share: readonly Maybe[], from: number): [number, number][] {
  const spans: [number, number][] = [];
  share.forEach((percent, i) => {
    const [begin, end] = [x[i - 1] ?? from, x[i] ?? 0];
    const before = spans.at(-1);
    if ((percent ?? 0) < 50) {
      return;
    }
    if (before && before[1] === begin) {
      before[1] = end;
    } else {
      spans.push([begin, end]);
    }
  });
  return spans;
}

export function cyclogramPlot(thermal: Thermal, theme: Theme): Plot {
  const { last, axis } = timeAxis(thermal);
  const { t_s, speed_rpm, cutting_percent } = thermal.cyclogram ?? { t_s: [], speed_rpm: [], cutting_percent: [] };
  const x = t_s.map((at) => (at - last) / HOUR_S);
  const first = ((thermal.history.t_s[0] ?? last) - last) / HOUR_S;
  // A value is the mean of the time before it: drawn from the start of that time on.
  const starts = x.map((_, i) => x[i - 1] ?? first);
  return {
    title: t('cyclogram'),
    x: axis,
    y: axisFor(t('cyclogram_speed'), speed_rpm, true),
    group: 'thermal',
    layers: [
      { kind: 'spans', name: t('cutting'), spans: cuts(x, cutting_percent, first), colour: theme.run.with, opacity: 0.14 },
      { kind: 'line', name: t('cyclogram_speed'), x: [...starts, x.at(-1) ?? 0], y: [...speed_rpm, speed_rpm.at(-1) ?? null], colour: theme.text, width: 1.6, step: true },
      rules('x', [0], theme.faint, true),
    ],
  };
}
