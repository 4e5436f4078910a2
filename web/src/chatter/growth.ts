// SPDX-License-Identifier: Apache-2.0
// How far a vibration grows on its way through a period, and the spindle speed behind it.
import type { Maybe } from '../frame/data';
import { section } from '../frame/html';
import { fixed, hertz, plain, rpm } from '../frame/numbers';
import { type Figure, figures } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { Term, View } from '../frame/view';
import { axisFor } from '../plot/axes';
import { type Dot, type Layer, rules } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { reading } from '../plot/reading';
import { spindlePlot } from '../plot/speed';
import { scaled } from '../plot/values';
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

const timeAxis = (scale: Scale) => ({ name: `time in ${scale.unit}`, min: 0, max: scale.end });

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
  const layers: Layer[] = [
    rules('x', periods(page, scale), theme.rapid, true),
    rules('y', [0], theme.faint),
  ];
  page.courses.forEach((c, i) => {
    if (i !== page.worst) {
      layers.push({ kind: 'line', name: 'from other starts within the period', x: scaled(c.time_s, scale.times), y: c.log_growth, colour: theme.rapid, width: 1 });
    }
  });
  layers.push({ kind: 'line', name: 'from the worst start', x: scaled(worst?.time_s ?? [], scale.times), y: worst?.log_growth ?? [], colour: theme.run.without, width: 2.4 });
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
    x: timeAxis(scale),
    y: axisFor('ln of the largest growth', seen, true),
    group: 'period',
    layers,
    readout: (t) => {
      const times = worst?.time_s ?? [];
      const i = times.findIndex((v) => v * scale.times >= t);
      const value = worst?.log_growth[i];
      return i < 0 || value == null || t < (times[0] ?? 0) * scale.times ? undefined : reading(`${plain(t)} ${scale.unit}`, [`ln ${fixed(value, 2)}: ${plain(Math.exp(value), 3)}-fold`]);
    },
  };
}

function speedPlot(page: GrowthPage, theme: Theme): Plot {
  const scale = scaleOf(page);
  const beneath = [rules('x', periods(page, scale), theme.rapid, true)];
  return spindlePlot({ x: timeAxis(scale), group: 'period', t: scaled(page.speed.time_s, scale.times), rpm: page.speed.speed_rpm, colour: theme.run.with, beneath });
}

function verdict(page: GrowthPage): string {
  const a = page.answer;
  const peak = peakOf(page);
  const [unit, times] = page.law_period_s !== null && page.law_period_s >= 2 ? ['s', 1] : ['ms', 1000];
  const after = `${plain((peak.time_s - peak.start_s) * times, 3)} ${unit} after it starts`;
  const grows =
    peak.log_growth <= 0
      ? 'No vibration grows on the way'
      : a.stable
        ? `On the way a vibration grows up to ${plain(a.peak_growth, 3)}-fold, ${after}, before it dies`
        : `Within the time shown, a vibration grows up to ${plain(a.peak_growth, 3)}-fold, ${after}, and keeps growing`;
  const period = a.law === 'constant' ? 'tooth pass' : 'period of the law';
  return `The cut is ${a.stable ? 'stable' : `unstable${a.type === 'none' ? '' : ` (${typeName(a.type)})`}`}: in the long run, each ${period} multiplies a vibration by ${plain(a.spectral_radius)}. ${grows}.`;
}

function rowsOf(page: GrowthPage): Figure[] {
  const a = page.answer;
  return [
    { label: `Spectral radius per ${a.law === 'constant' ? 'tooth pass' : 'period'}`, value: plain(a.spectral_radius, 6) },
    { label: 'Its natural logarithm', value: plain(a.log_radius, 6) },
    { label: 'Peak growth', value: plain(a.peak_growth, 4) },
    ...(a.frequency_hz === null ? [] : [{ label: 'Dominant frequency', value: hertz(a.frequency_hz) }]),
    { label: 'Tooth pass', value: `${plain(page.pass_s * 1000, 4)} ms` },
    ...(page.law_period_s === null ? [] : [{ label: 'Period of the law', value: `${plain(page.law_period_s * 1000, 4)} ms` }]),
  ];
}

const WORST_START: Term = ['Worst start', 'Under a law, growth depends on when within the period the vibration starts. The heavy curve is the worst of the starts drawn.'];

export function growthView(page: GrowthPage): View {
  const a = page.answer;
  const constant = a.law === 'constant';
  return {
    product: 'Steadyrest chatter radius',
    title: page.process,
    facts: `<b>${rpm(a.speed_rpm)}</b> · <b>${plain(a.depth_mm)} mm</b> deep · <b>${lawText(a)}</b>`,
    verdict: verdict(page),
    body: section(constant ? 'Growth from pass to pass' : 'Growth over the period', host('growth', 'high') + host('speed')) + section('Figures', figures(rowsOf(page))),
    explanation: [
      ['Spectral radius', 'What a tooth pass, or a whole period of the law, multiplies a vibration by in the long run. Below 1 the vibration dies in the end, however much it grows on the way.'],
      TYPES,
      ['Growth', 'As a natural logarithm: 0 is no growth, 2.3 is ten times, 4.6 a hundred times. It is the largest displacement at that moment over the largest in the one pass before the start, for the worst of all vibrations. A cut that is stable in the long run can still mark the part while a vibration passes its peak.'],
      ...(constant ? [] : [WORST_START]),
    ],
    draw: (theme) => {
      plot('growth', growthPlot(page, theme), theme);
      plot('speed', speedPlot(page, theme), theme);
    },
  };
}
