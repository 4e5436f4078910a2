// SPDX-License-Identifier: Apache-2.0
// How far a vibration grows on its way through a period, and the speed that makes it.
import type { Maybe } from '../frame/data';
import { section } from '../frame/html';
import { fixed, plain } from '../frame/numbers';
import { figures } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { roomy } from '../plot/axes';
import type { Dot, Layer } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { type GrowthPage, lawText } from './data';
import { TYPES, typeName } from './words';

interface Peak {
  start_s: number;
  time_s: number;
  log_growth: number;
}

export function peakOf(page: GrowthPage): Peak {
  const course = page.courses[page.worst];
  const growth = course?.log_growth ?? [];
  const at = growth.reduce<number>((best, v, i) => ((v ?? -Infinity) > (growth[best] ?? -Infinity) ? i : best), 0);
  return { start_s: course?.time_s[0] ?? 0, time_s: course?.time_s[at] ?? 0, log_growth: growth[at] ?? 0 };
}

interface Scale {
  unit: string;
  times: number;
  end: number;
}

function scaleOf(page: GrowthPage): Scale {
  const end = Math.max(page.courses[page.worst]?.time_s.at(-1) ?? 0, page.law_period_s ?? 0);
  const [unit, times] = end < 2 ? ['ms', 1000] : ['s', 1];
  return { unit: unit as string, times: times as number, end: end * (times as number) };
}

const scaled = (values: readonly number[], by: number) => values.map((v) => v * by);

function periods(page: GrowthPage, scale: Scale): number[] {
  const period = (page.law_period_s ?? 0) * scale.times;
  const out: number[] = [];
  for (let t = period; period > 0 && t < scale.end; t += period) {
    out.push(t);
  }
  return out;
}

function growthPlot(page: GrowthPage, theme: Theme): Plot {
  const scale = scaleOf(page);
  const peak = peakOf(page);
  const worst = page.courses[page.worst];
  const seen: Maybe[] = (worst?.log_growth ?? []).filter((v) => v !== null && v > -12);
  const [min, max] = roomy(seen, true);
  const layers: Layer[] = [
    { kind: 'rules', at: periods(page, scale), axis: 'x', colour: theme.rapid, dashed: true },
    { kind: 'rules', at: [0], axis: 'y', colour: theme.faint },
  ];
  page.courses.forEach((c, i) => {
    if (i !== page.worst) {
      layers.push({ kind: 'line', name: 'from other beginnings in the period', x: scaled(c.time_s, scale.times), y: c.log_growth, colour: theme.rapid, width: 1 });
    }
  });
  layers.push({ kind: 'line', name: 'from the worst beginning', x: scaled(worst?.time_s ?? [], scale.times), y: worst?.log_growth ?? [], colour: theme.run.without, width: 2.4 });
  const share = (peak.time_s * scale.times) / scale.end;
  const side: Partial<Dot> = share < 0.15 ? { side: 'right' } : share > 0.85 ? { side: 'left', lift: 16 } : { side: 'top' };
  layers.push({
    kind: 'dots',
    name: 'peak growth',
    colour: theme.run.without,
    size: 11,
    bold: true,
    dots: [{ x: peak.time_s * scale.times, y: peak.log_growth, label: `${plain(page.answer.peak_growth, 3)}-fold, ln ${fixed(peak.log_growth, 2)}`, ...side }],
  });
  return {
    title: 'Growth of a vibration',
    x: { name: `time in ${scale.unit}`, min: 0, max: scale.end },
    y: { name: 'ln of the largest growth', min, max },
    group: 'period',
    layers,
    readout: (t) => {
      const times = worst?.time_s ?? [];
      const i = times.findIndex((v) => v * scale.times >= t);
      const value = worst?.log_growth[i];
      return i < 0 || value == null || t < (times[0] ?? 0) * scale.times ? undefined : `<b>${plain(t)} ${scale.unit}</b><br>ln ${fixed(value, 2)}: ${plain(Math.exp(value), 3)}-fold`;
    },
  };
}

function speedPlot(page: GrowthPage, theme: Theme): Plot {
  const scale = scaleOf(page);
  const [min, max] = roomy(page.speed.speed_rpm);
  return {
    title: 'Spindle speed',
    x: { name: `time in ${scale.unit}`, min: 0, max: scale.end },
    y: { name: 'spindle speed in rev/min', min, max },
    group: 'period',
    layers: [
      { kind: 'rules', at: periods(page, scale), axis: 'x', colour: theme.rapid, dashed: true },
      { kind: 'line', name: 'spindle speed', x: scaled(page.speed.time_s, scale.times), y: page.speed.speed_rpm, colour: theme.run.with, width: 2 },
    ],
  };
}

function verdict(page: GrowthPage): string {
  const a = page.answer;
  const peak = peakOf(page);
  const [unit, times] = page.law_period_s !== null && page.law_period_s >= 2 ? ['s', 1] : ['ms', 1000];
  const after = `${plain((peak.time_s - peak.start_s) * times, 3)} ${unit} after it begins`;
  const grows =
    peak.log_growth <= 0
      ? 'No vibration grows on its way'
      : a.stable
        ? `On its way a vibration grows ${plain(a.peak_growth, 3)}-fold at worst, ${after}, and dies in the end`
        : `Within what is shown a vibration grows ${plain(a.peak_growth, 3)}-fold at worst, ${after}, and it grows on`;
  const period = a.law === 'constant' ? 'tooth pass' : 'period of the law';
  return `The cut is ${a.stable ? 'stable' : `unstable${a.type === 'none' ? '' : ` (${typeName(a.type)})`}`}: a ${period} multiplies a vibration by ${plain(a.spectral_radius)} in the long run. ${grows}.`;
}

export function growthView(page: GrowthPage): View {
  const a = page.answer;
  const constant = a.law === 'constant';
  const rows = [
    { label: `spectral radius of a ${constant ? 'tooth pass' : 'period'}`, value: plain(a.spectral_radius, 6) },
    { label: 'its logarithm', value: plain(a.log_radius, 6) },
    { label: 'worst growth on the way', value: plain(a.peak_growth, 4) },
    ...(a.frequency_hz === null ? [] : [{ label: 'strongest frequency', value: `${fixed(a.frequency_hz, 1)} Hz` }]),
    { label: 'a tooth pass lasts', value: `${plain(page.pass_s * 1000, 4)} ms` },
    ...(page.law_period_s === null ? [] : [{ label: 'a period of the law lasts', value: `${plain(page.law_period_s * 1000, 4)} ms` }]),
  ];
  return {
    product: 'Steadyrest chatter radius',
    title: page.process,
    facts: `<b>${fixed(a.speed_rpm, 0)} rev/min</b> · <b>${plain(a.depth_mm)} mm</b> deep · <b>${lawText(a)}</b>`,
    verdict: verdict(page),
    body:
      section(constant ? 'Growth from pass to pass' : 'Growth over the period', host('growth', 'high') + host('speed')) +
      section('Figures', figures(rows)),
    explanation: [
      ['Spectral radius', 'What a tooth pass, or a whole period of the law, multiplies a vibration by in the long run. Below 1 it dies in the end, however much it has grown on its way.'],
      TYPES,
      ['Growth', 'As a natural logarithm: 0 is as large as at the beginning, 2.3 ten times, 4.6 a hundred times. The largest later displacement over the largest within one pass before the beginning, of all vibrations the worst. A cut that is stable in the long run may still leave its marks while a vibration passes through its peak.'],
      ...(constant ? [] : ([['Worst beginning', 'Under a law it matters at which moment of the period a vibration begins; the heavy curve is the worst of the beginnings that are drawn.']] as const)),
    ],
    draw: (theme) => {
      plot('growth', growthPlot(page, theme), theme);
      plot('speed', speedPlot(page, theme), theme);
    },
  };
}
