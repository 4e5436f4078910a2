// SPDX-License-Identifier: Apache-2.0
// A made-up but lifelike report: a pocket with arcs, cut twice. Errors follow ε = v²/(2·R·k²) on
// arcs (servo gain k), with a kick at corners; the layer slows down until the limit holds.
import type { Figures, ReasonTime, Report, Run, Trace, WorstLine } from '../src/cut/data';

interface Piece {
  line: number;
  text: string;
  length: number;
  radius: number; // 0 = straight
  at: (s: number) => [number, number];
  z: number;
  cutting: boolean;
}

const GAIN_1_S = 50;
const FEED_MM_MIN = 1800;
export const LIMIT_UM = 10;

function pieces(): Piece[] {
  const out: Piece[] = [];
  let line = 9;
  let x = 0;
  let y = 0;
  const straight = (tx: number, ty: number, z: number, cutting = true) => {
    const [fx, fy] = [x, y];
    const length = Math.hypot(tx - fx, ty - fy);
    if (length < 1e-9) return;
    out.push({
      line: ++line,
      text: `N${line * 10} ${cutting ? 'G1' : 'G0'} X${tx.toFixed(3)} Y${ty.toFixed(3)}`,
      length,
      radius: 0,
      z,
      cutting,
      at: (s) => [fx + ((tx - fx) * s) / length, fy + ((ty - fy) * s) / length],
    });
    [x, y] = [tx, ty];
  };
  const arc = (cx: number, cy: number, sweep: number, z: number) => {
    const radius = Math.hypot(x - cx, y - cy);
    const start = Math.atan2(y - cy, x - cx);
    const end = start + sweep;
    const [tx, ty] = [cx + radius * Math.cos(end), cy + radius * Math.sin(end)];
    out.push({
      line: ++line,
      text: `N${line * 10} ${sweep > 0 ? 'G3' : 'G2'} X${tx.toFixed(3)} Y${ty.toFixed(3)} R${radius.toFixed(3)}`,
      length: Math.abs(sweep) * radius,
      radius: radius * Math.sign(sweep),
      z,
      cutting: true,
      at: (s) => {
        const angle = start + (sweep * s) / (Math.abs(sweep) * radius);
        return [cx + radius * Math.cos(angle), cy + radius * Math.sin(angle)];
      },
    });
    [x, y] = [tx, ty];
  };
  const quarter = Math.PI / 2;
  for (let pass = 0; pass < 3; ++pass) {
    const z = -2 * (pass + 1);
    [x, y] = pass === 0 ? [0, 0] : [x, y];
    straight(-50, -30, z, false);
    // The wall: straights with corner arcs of 8 mm and a rib of 5 mm on each long side.
    straight(-50 + 8, -38, z);
    for (const side of [0, 1]) {
      const sign = side === 0 ? 1 : -1;
      straight(-10 * sign, -38 * sign, z);
      arc(-10 * sign, -33 * sign, sign > 0 ? quarter : quarter, z);
      straight(-5 * sign, -20 * sign, z);
      arc(0, -20 * sign, -Math.PI, z);
      straight(5 * sign, -33 * sign, z);
      arc(10 * sign, -33 * sign, quarter, z);
      straight(42 * sign, -38 * sign, z);
      arc(42 * sign, -30 * sign, quarter, z);
      straight(50 * sign, 30 * sign, z);
      arc(42 * sign, 30 * sign, quarter, z);
    }
    straight(20, 0, z, false);
    for (const radius of [2, 3, 5, 8, 12, 17]) {
      straight(radius, 0, z);
      arc(0, 0, 2 * Math.PI, z);
    }
  }
  return out;
}

function emptyTrace(): Trace {
  return {
    time_s: [], path_mm: [], x_mm: [], y_mm: [], z_mm: [], contour_error_um: [], tracking_error_um: [],
    override_percent: [], feed_mm_min: [], line: [], cutting: [],
  };
}

function noise(seed: number): () => number {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) | 0;
    return state / 2147483648;
  };
}

function run(layer: boolean, samples: number): Run {
  const path = pieces();
  const trace = emptyTrace();
  const random = noise(7);
  const total = path.reduce((sum, p) => sum + p.length, 0);
  const step_mm = total / samples;
  const steps = [0, 0.2, 0.3, 0.4, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1];
  let time = 0;
  let done = 0;
  let speed = 0;
  let error = 0;
  let changes = 0;
  let lastRatio = 1;
  const worst = new Map<number, number>();
  let sumOfSquares = 0;
  let cut = 0;
  let over = 0;
  let overTime = 0;
  let cuttingTime = 0;
  const reasons = new Map<string, number>();
  // The layer sees the path ahead: the tightest radius of the next millimetres counts.
  const ahead = (index: number, s: number) => {
    const piece = path[index] as Piece;
    const next = path[index + 1];
    const previous = path[index - 1];
    const near = [piece];
    if (next && piece.length - s < 5) near.push(next);
    if (previous && s < 2.5) near.push(previous);
    return Math.min(...near.filter((p) => p.radius !== 0).map((p) => Math.abs(p.radius)), Infinity);
  };
  for (const [index, piece] of path.entries()) {
    for (let s = 0; s < piece.length; s += step_mm) {
      const radius = Math.abs(piece.radius);
      const errorAt = (v: number) => (radius > 0 ? (1000 * v * v) / (2 * radius * GAIN_1_S ** 2) : 0);
      const full = piece.cutting ? FEED_MM_MIN / 60 : 150;
      let ratio = 1;
      if (layer && piece.cutting) {
        const tight = ahead(index, s);
        const errorAhead = (v: number) => (1000 * v * v) / (2 * tight * GAIN_1_S ** 2);
        ratio = [...steps].reverse().find((r) => errorAhead(full * r) <= 0.9 * LIMIT_UM) ?? 0.2;
        const reason = ratio < 1 ? 'contour_within_limit' : 'none';
        reasons.set(reason, (reasons.get(reason) ?? 0) + step_mm / (full * ratio));
      }
      changes += ratio !== lastRatio ? 1 : 0;
      lastRatio = ratio;
      const wanted = full * ratio;
      const corner = s < 2 ? 4 * (1 - s / 2) * (Math.min(speed, full * ratio) / 30) ** 2 * (piece.cutting ? 1 : 0) : 0;
      // Rapids end at a standstill: an exact stop before the cut.
      if (piece.cutting && s === 0 && !path[index - 1]?.cutting) [speed, error] = [0, 0];
      speed += (wanted - speed) * Math.min(1, step_mm / (wanted < speed ? 0.5 : 1.2));
      const target = errorAt(speed) * Math.sign(piece.radius || 1) - corner;
      error += (target - error) * Math.min(1, step_mm / 0.7);
      const dt = step_mm / Math.max(speed, 1);
      time += dt;
      const shown = error + 0.35 * random();
      const [px, py] = piece.at(s);
      trace.time_s.push(round(time, 4));
      trace.path_mm.push(round(done + s, 3));
      trace.x_mm.push(round(px, 4));
      trace.y_mm.push(round(py, 4));
      trace.z_mm.push(piece.z);
      trace.contour_error_um.push(round(shown, 2));
      trace.tracking_error_um.push(round((1000 * speed) / GAIN_1_S, 1));
      trace.override_percent.push(round(ratio * 100, 1));
      trace.feed_mm_min.push(round(speed * 60, 1));
      trace.line.push(piece.line);
      trace.cutting.push(piece.cutting ? 1 : 0);
      if (piece.cutting) {
        cut += 1;
        cuttingTime += dt;
        sumOfSquares += shown * shown;
        over += Math.abs(shown) > LIMIT_UM ? 1 : 0;
        overTime += Math.abs(shown) > LIMIT_UM ? dt : 0;
        if (Math.abs(shown) > Math.abs(worst.get(piece.line) ?? 0)) worst.set(piece.line, shown);
      }
    }
    done += piece.length;
  }
  const figures: Figures = {
    cycle_time_s: time,
    cutting_time_s: cuttingTime,
    contour_error_max_mm: Math.max(...[...worst.values()].map(Math.abs)) / 1000,
    contour_error_rms_mm: Math.sqrt(sumOfSquares / cut) / 1000,
    tracking_error_max_mm: FEED_MM_MIN / 60 / GAIN_1_S,
    over_limit_s: overTime,
    samples: cut,
    samples_over_limit: over,
    override_changes: changes,
  };
  const sentences: Record<string, string> = {
    none: 'Nothing to correct.',
    contour_within_limit: 'Highest feed step that holds the contour limit.',
  };
  const list: ReasonTime[] = [...reasons].map(([reason, seconds]) => ({
    reason,
    sentence: sentences[reason] ?? '',
    seconds,
  }));
  return { figures, trace, reasons: list };
}

function round(value: number, decimals: number): number {
  const power = 10 ** decimals;
  return Math.round(value * power) / power;
}

function worstLines(without: Run, layer: Run): WorstLine[] {
  const byLine = (trace: Trace) => {
    const out = new Map<number, number>();
    trace.contour_error_um.forEach((e, i) => {
      const line = trace.line[i] ?? 0;
      if (trace.cutting[i] === 1 && e !== null && Math.abs(e) > Math.abs(out.get(line) ?? 0)) out.set(line, e);
    });
    return out;
  };
  const [before, after] = [byLine(without.trace), byLine(layer.trace)];
  const texts = new Map(pieces().map((p) => [p.line, p.text]));
  const feeds = (trace: Trace, line: number, e: number | null) => {
    const at = trace.contour_error_um.findIndex((v, i) => v === e && trace.line[i] === line);
    return trace.feed_mm_min[at] ?? null;
  };
  return [...before]
    .sort((a, b) => Math.abs(b[1]) - Math.abs(a[1]))
    .slice(0, 20)
    .map(([line, e]): WorstLine => {
      const with_um = after.get(line) ?? null;
      const text = texts.get(line) ?? '';
      const radius = Number(/R([\d.]+)/.exec(text)?.[1] ?? 0) || null;
      const feed = feeds(layer.trace, line, with_um);
      return {
        line, text, without_um: e, with_um, feed_without_mm_min: feeds(without.trace, line, e), feed_with_mm_min: feed, radius_mm: radius,
        hold_feed_mm_min: radius ? 60 * GAIN_1_S * Math.sqrt((2 * radius * LIMIT_UM) / 1000) : feed,
        held_by: radius ? 'closed form' : 'driven',
      };
    });
}

export function makeReport(samples: number): Report {
  const without = run(false, samples);
  const layer = run(true, samples);
  return {
    schema: 'steadyrest-report/1',
    version: '0.1.0',
    made: {
      date: '2026-01-02T03:04:05Z',
      command: "steadyrest cut 'rib pocket.ngc' --machine vmc-840d.toml --report out/rib-pocket",
      inputs: [{ file: 'rib pocket.ngc', sha256: 'ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad' }],
    },
    program: 'rib-pocket.ngc',
    machine: 'VMC, SINUMERIK 840D',
    strategy: 'feed priority',
    limit_um: LIMIT_UM,
    override_table: [0, 1, 2, 4, 6, 8, 10, 20, 30, 40, 50, 60, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120].map(
      (percent, i) => ({ code: i ^ (i >> 1), percent }),
    ),
    without,
    with: layer,
    worst_lines: worstLines(without, layer),
    probes: [
      {
        time_s: 62.04,
        line: 9,
        axis: 'Z',
        displacement_um: 2.98,
        innovation_um: 2.94,
        band_um: 5.21,
        reason: 'thermal_reading_taken',
        sentence: "A probe reading re-zeroed the thermal model.",
      },
    ],
    motion: ['X', 'Y'].map((axis) => ({
      axis,
      velocity_rms_mm_s: 0.00312,
      acceleration_rms_mm_s2: 4.26,
      difference_velocity_rms_mm_s: 0.428,
      difference_acceleration_rms_mm_s2: 707.4,
      velocity_coverage_ratio: axis === 'X' ? 1 : 0.99996,
      acceleration_coverage_ratio: axis === 'X' ? 0.5 : null,
    })),
    ways: [
      { way: 'alone', ...without.figures },
      { way: 'feed_override', ...layer.figures },
      { way: 'path_offsets', ...without.figures, contour_error_max_mm: 0.009, contour_error_rms_mm: 0.0012, samples_over_limit: 0 },
    ],
    curve: [5, 20].map((limit_um) => ({
      limit_um,
      ...layer.figures,
      cycle_time_s: layer.figures.cycle_time_s * (limit_um < 10 ? 1.3 : 0.85),
      contour_error_max_mm: limit_um / 1000,
      contour_error_rms_mm: limit_um / 4000,
    })),
  };
}

export function emptyReport(): Report {
  const figures: Figures = {
    cycle_time_s: 0, cutting_time_s: 0, contour_error_max_mm: 0, contour_error_rms_mm: 0, tracking_error_max_mm: 0,
    over_limit_s: 0, samples: 0, samples_over_limit: 0, override_changes: 0,
  };
  const run = (): Run => ({ figures: { ...figures }, trace: emptyTrace(), reasons: [] });
  return { ...makeReport(50), without: run(), with: run(), worst_lines: [], override_table: [], motion: [], probes: [], ways: [], curve: [] };
}
