// SPDX-License-Identifier: Apache-2.0
// Displacement over temperature, one curve for each regime of one spindle speed (the paper's figure 1).
import type { Maybe } from '../frame/data';
import { fixed, plain } from '../frame/numbers';
import type { Theme } from '../frame/theme';
import { roomy, span } from '../plot/axes';
import type { Layer } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { nameOf } from './course';
import type { FitPage, FittedAxis, Over, Regime } from './data';

/** From slow to fast; the spindle that stands is grey. */
const RAMP = ['#3b6fb5', '#2f9c95', '#6aa32d', '#d19a1c', '#c9541f', '#9c2c6d'];

export function speeds(regimes: readonly Regime[]): number[] {
  return [...new Set(regimes.map((r) => r.speed_rpm))].sort((a, b) => a - b);
}

function colourOf(speed: number, all: readonly number[], theme: Theme): string {
  const turning = all.filter((s) => s > 0);
  const at = turning.indexOf(speed);
  return at < 0 ? theme.faint : (RAMP[Math.round((at * (RAMP.length - 1)) / Math.max(turning.length - 1, 1))] as string);
}

const speedName = (speed: number) => (speed > 0 ? `${fixed(speed, 0)} rev/min` : 'standing');

/** What one temperature tells, in one line. */
export function told(over: Over): string {
  return (
    `Correlation <b>${fixed(over.correlation, 2)}</b>; the best straight line leaves <b>${fixed(over.residual_rms_um, 1)} µm</b> RMS; ` +
    `within half a kelvin about ${fixed(over.spread_at_c, 1)} °C the displacements lie <b>${fixed(over.spread_um, 1)} µm</b> apart.`
  );
}

interface Near {
  regime: Regime;
  i: number;
  far: number;
}

export function hysteresisPlot(page: FitPage, axis: FittedAxis, sensor: number, theme: Theme): Plot {
  const over = axis.over[sensor] as Over;
  const name = page.sensors[sensor] ?? '';
  const all = speeds(page.regimes);
  const x = page.regimes.map((r): readonly Maybe[] => r.temperature_c[sensor] ?? []);
  const [left, right] = roomy(x.flat());
  const [min, max] = roomy(axis.displacement_um.flat());
  const ends = span(x.flat());
  const line = (c: number) => over.mean_um + over.slope_um_k * (c - over.mean_c);
  const curve = (r: Regime, k: number): Layer => ({
    kind: 'line',
    name: speedName(r.speed_rpm),
    x: x[k] ?? [],
    y: axis.displacement_um[k] ?? [],
    colour: colourOf(r.speed_rpm, all, theme),
    width: r.speed_rpm > 0 ? 2 : 1.2,
    dashed: r.speed_rpm === 0,
  });
  // By speed, so that the key is too.
  const curves = page.regimes.map((r, k) => ({ r, k })).sort((p, q) => p.r.speed_rpm - q.r.speed_rpm || p.k - q.k).map(({ r, k }) => curve(r, k));
  const begins = page.regimes.flatMap((r, k): Layer[] => {
    const [c, um] = [x[k]?.[0], axis.displacement_um[k]?.[0]];
    const there = c !== undefined && c !== null && um !== undefined && um !== null && r.speed_rpm > 0;
    return there ? [{ kind: 'dots', name: 'begins here', dots: [{ x: c, y: um }], colour: colourOf(r.speed_rpm, all, theme), size: 7, hollow: true }] : [];
  });
  const top = over.spread_from_um + over.spread_um;
  const nearest = (c: number, um: number): Near | undefined => {
    let best: Near | undefined;
    page.regimes.forEach((regime, k) =>
      x[k]?.forEach((at, i) => {
        const y = axis.displacement_um[k]?.[i];
        if (at !== null && y !== null && y !== undefined) {
          const far = ((at - c) / (right - left)) ** 2 + ((y - um) / (max - min)) ** 2;
          best = best === undefined || far < best.far ? { regime, i, far } : best;
        }
      }),
    );
    return best;
  };
  return {
    title: `${nameOf(axis)} over ${name}`,
    x: { name: `temperature ${name} in °C`, min: left, max: right },
    y: { name: `displacement ${nameOf(axis)} in µm`, min, max },
    plane: true,
    layers: [
      { kind: 'line', name: 'the best straight line', x: ends, y: ends.map(line), colour: theme.text, width: 1 },
      ...curves,
      ...begins,
      { kind: 'line', x: [over.spread_at_c, over.spread_at_c], y: [over.spread_from_um, top], colour: theme.text, width: 2, halo: true },
      {
        kind: 'dots',
        dots: [
          { x: over.spread_at_c, y: over.spread_from_um },
          { x: over.spread_at_c, y: top, label: `${fixed(over.spread_um, 1)} µm`, side: over.spread_at_c > 0.5 * (left + right) ? 'left' : 'right' },
        ],
        colour: theme.text,
        size: 6,
        bold: true,
      },
    ],
    readout: (c, um) => {
      const at = nearest(c, um);
      if (at === undefined || at.far > 0.01) {
        return undefined;
      }
      const k = page.regimes.indexOf(at.regime);
      return `<b>${speedName(at.regime.speed_rpm)}</b> after ${plain((at.regime.t_h[at.i] ?? 0) - at.regime.start_h, 2)} h<br>${fixed(x[k]?.[at.i], 1)} °C, ${fixed(axis.displacement_um[k]?.[at.i], 1)} µm`;
    },
  };
}
