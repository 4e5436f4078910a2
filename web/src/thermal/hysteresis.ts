// SPDX-License-Identifier: Apache-2.0
// Displacement over temperature, one curve for each run at one spindle speed (the paper's figure 1).
import type { Maybe } from '../frame/data';
import { fixed, measure, plain, rpm, um } from '../frame/numbers';
import type { Theme } from '../frame/theme';
import { type Axis, axisFor, span } from '../plot/axes';
import type { Layer } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { reading } from '../plot/reading';
import { known } from '../plot/values';
import { nameOf } from './course';
import type { FitPage, FittedAxis, Over, Regime } from './data';

/** From slow to fast; a stopped spindle is grey. */
const RAMP = ['#3b6fb5', '#2f9c95', '#6aa32d', '#d19a1c', '#c9541f', '#9c2c6d'];

export function speeds(regimes: readonly Regime[]): number[] {
  return [...new Set(regimes.map((r) => r.speed_rpm))].sort((a, b) => a - b);
}

function colourOf(speed: number, all: readonly number[], theme: Theme): string {
  const turning = all.filter((s) => s > 0);
  const at = turning.indexOf(speed);
  return at < 0 ? theme.faint : (RAMP[Math.round((at * (RAMP.length - 1)) / Math.max(turning.length - 1, 1))] as string);
}

const speedName = (speed: number) => (speed > 0 ? rpm(speed) : 'stopped');

/** How much one temperature tells, in one line. */
export function told(over: Over): string {
  return (
    `Correlation <b>${fixed(over.correlation, 2)}</b>; the best straight line leaves <b>${um(over.residual_rms_um)}</b> RMS; ` +
    `within half a kelvin around ${measure(over.spread_at_c, 1, '°C')}, displacements differ by up to <b>${um(over.spread_um)}</b>.`
  );
}

interface Near {
  run: number;
  at: number;
  /** Squared, in shares of the plot. */
  far: number;
}

/** The sample nearest to a point of the plot. */
function nearest(page: FitPage, axis: FittedAxis, sensor: number, at: { x: number; y: number }, box: { x: Axis; y: Axis }): Near | undefined {
  const share = ({ min = 0, max = 1 }: Axis, by: number) => by / (max - min);
  let best: Near | undefined;
  page.regimes.forEach((regime, run) =>
    regime.temperature_c[sensor]?.forEach((c, i) => {
      const y = axis.displacement_um[run]?.[i];
      if (known(c) && known(y)) {
        const far = share(box.x, c - at.x) ** 2 + share(box.y, y - at.y) ** 2;
        best = best === undefined || far < best.far ? { run, at: i, far } : best;
      }
    }),
  );
  return best;
}

/** A tenth of the plot. */
const NEAR = 0.1 ** 2;

/** The largest difference of displacement at one temperature, as an upright bar. */
function spreadBar(over: Over, middle_c: number, theme: Theme): Layer[] {
  const [c, from, to] = [over.spread_at_c, over.spread_from_um, over.spread_from_um + over.spread_um];
  return [
    { kind: 'line', x: [c, c], y: [from, to], colour: theme.text, width: 2, halo: true },
    { kind: 'dots', dots: [{ x: c, y: from }, { x: c, y: to, label: um(over.spread_um), side: c > middle_c ? 'left' : 'right' }], colour: theme.text, size: 6, bold: true },
  ];
}

/** A curve for each run, and a ring where the spindle starts. */
function runs(page: FitPage, axis: FittedAxis, sensor: number, theme: Theme): Layer[] {
  const all = speeds(page.regimes);
  // By speed, so that the key is in order.
  const inOrder = page.regimes.map((r, k) => ({ r, x: r.temperature_c[sensor] ?? [], y: axis.displacement_um[k] ?? [] })).sort((p, q) => p.r.speed_rpm - q.r.speed_rpm);
  const curves = inOrder.map(({ r, x, y }): Layer => ({ kind: 'line', name: speedName(r.speed_rpm), x, y, colour: colourOf(r.speed_rpm, all, theme), width: r.speed_rpm > 0 ? 2 : 1.2, dashed: r.speed_rpm === 0 }));
  const starts = inOrder.flatMap(({ r, x: [c], y: [first] }): Layer[] =>
    known(c) && known(first) && r.speed_rpm > 0 ? [{ kind: 'dots', name: 'start of a run', dots: [{ x: c, y: first }], colour: colourOf(r.speed_rpm, all, theme), size: 7, hollow: true }] : [],
  );
  return [...curves, ...starts];
}

export function hysteresisPlot(page: FitPage, axis: FittedAxis, sensor: number, theme: Theme): Plot {
  const over = axis.over[sensor] as Over;
  const name = page.sensors[sensor] ?? '';
  const temperatures = page.regimes.flatMap((r): readonly Maybe[] => r.temperature_c[sensor] ?? []);
  const box = { x: axisFor(`temperature ${name} in °C`, temperatures), y: axisFor(`displacement ${nameOf(axis)} in µm`, axis.displacement_um.flat()) };
  const ends = span(temperatures);
  const line = (c: number) => over.mean_um + over.slope_um_k * (c - over.mean_c);
  return {
    title: `${nameOf(axis)} over ${name}`,
    ...box,
    plane: true,
    layers: [
      { kind: 'line', name: 'best straight line', x: ends, y: ends.map(line), colour: theme.text, width: 1 },
      ...runs(page, axis, sensor, theme),
      ...spreadBar(over, 0.5 * (box.x.min + box.x.max), theme),
    ],
    readout: (x, y) => {
      const near = nearest(page, axis, sensor, { x, y }, box);
      const run = near && page.regimes[near.run];
      if (!run || near.far > NEAR) {
        return undefined;
      }
      const hours = plain((run.t_h[near.at] ?? 0) - run.start_h, 2);
      return reading(`${speedName(run.speed_rpm)} after ${hours} h`, [`${measure(run.temperature_c[sensor]?.[near.at], 1, '°C')}, ${um(axis.displacement_um[near.run]?.[near.at])}`]);
    },
  };
}
