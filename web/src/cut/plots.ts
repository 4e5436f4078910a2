// SPDX-License-Identifier: Apache-2.0
// The plots of a cut: the path coloured by its error, and quantities along the program.
import type { Maybe } from '../frame/data';
import { capital } from '../frame/html';
import { fixed, measure, um } from '../frame/numbers';
import type { Theme } from '../frame/theme';
import { niceAbove } from '../plot/axes';
import type { ColourScale } from '../plot/key';
import { type Layer, rules } from '../plot/layers';
import type { Plot } from '../plot/plot';
import { reading, readingTable } from '../plot/reading';
import { lowerBound, nearestIndex } from '../plot/thin';
import { RUNS, type Report, type RunName, type Trace } from './data';
import { NOT_CUTTING, NearestSample, type Plane, boundingBox, columns, polylinesByClass } from './path';
import { type ErrorClass, classOf } from './scale';
import { WAYS } from './way_names';

export type Abscissa = 'path_mm' | 'time_s';

/** On curves and pictures; where the best way is shown in place of the layer, its name. */
export function runName(report: Report, run: RunName): string {
  const best = report.best_run === undefined ? undefined : report.best?.same_time;
  if (!best) {
    return run === 'with' ? 'with the layer' : 'without the layer';
  }
  return run === 'with' ? WAYS[best.way].name : WAYS.alone.name;
}
/** Beyond this many samples, those too close to be seen apart are merged. */
const MOST_SAMPLES = 20_000;
const PATH_PX = 4000;

export function errorScale(classes: readonly ErrorClass[], theme: Theme): ColourScale {
  return {
    title: 'Contour error up to … µm; the upright mark is the limit',
    cells: classes.map((c, i) => ({ colour: c.colour, upTo: fixed(c.to_um, c.to_um < 10 && c.to_um % 1 !== 0 ? 1 : 0), marked: c.over && !classes[i - 1]?.over })),
    beside: { name: 'not cutting', colour: theme.rapid, mark: 'line' },
  };
}

function pathLayers(trace: Trace, plane: Plane, classes: readonly ErrorClass[], smallest_mm: number, theme: Theme): Layer[] {
  const [h, v] = columns(trace, plane);
  const classOfSample = h.map((_, i) => {
    const error = trace.contour_error_um[i];
    return trace.cutting[i] === 1 && error != null ? classOf(classes, error) : NOT_CUTTING;
  });
  const lines = [...polylinesByClass(h, v, classOfSample, smallest_mm)].sort(([a], [b]) => a - b); // the worst on top
  return lines.map(([cls, { x, y }]): Layer => ({ kind: 'line', x, y, ...(cls === NOT_CUTTING ? { colour: theme.rapid, width: 0.8 } : { colour: classes[cls]?.colour ?? theme.text, width: 2.2 }) }));
}

/** The whole trace: the CSV of a path holds more than its picture. */
function pathColumns(trace: Trace) {
  return Object.entries(trace).map(([head, values]) => ({ head, values: values as Maybe[] }));
}

export function pathPlot(report: Report, run: RunName, plane: Plane, classes: readonly ErrorClass[], theme: Theme): Plot {
  const trace = report[run].trace;
  const box = boundingBox(RUNS.map((r) => report[r].trace), plane) ?? { left: 0, right: 1, bottom: 0, top: 1 };
  const [horizontal = '', vertical = ''] = plane.toUpperCase();
  const smallest = trace.time_s.length > MOST_SAMPLES ? Math.max(box.right - box.left, box.top - box.bottom) / PATH_PX : 0;
  let nearest: NearestSample | undefined;
  const [h, v] = columns(trace, plane);
  return {
    title: `Path ${runName(report, run)}, coloured by contour error`,
    x: { name: `${horizontal} in mm`, min: box.left, max: box.right },
    y: { name: `${runName(report, run)}, ${vertical} in mm`, min: box.bottom, max: box.top },
    equal: true,
    plane: true,
    group: 'paths',
    scale: errorScale(classes, theme),
    layers: pathLayers(trace, plane, classes, smallest, theme),
    columns: () => pathColumns(trace),
    readout: (x, y, reach) => {
      nearest ??= new NearestSample(trace, plane);
      const i = nearest.find(x, y, reach);
      return i === undefined ? undefined : { html: sample(trace, i), at: [h[i] ?? 0, v[i] ?? 0] };
    },
  };
}

function sample(t: Trace, i: number): string {
  return reading(`Line ${t.line[i]}`, [
    `contour error <b>${um(t.contour_error_um[i])}</b>`,
    `X ${fixed(t.x_mm[i], 3)}  Y ${fixed(t.y_mm[i], 3)}  Z ${fixed(t.z_mm[i], 3)}`,
    `at ${measure(t.path_mm[i], 2, 'mm')}, ${measure(t.time_s[i], 3, 's')}`,
    `override ${measure(t.override_percent[i], 0, '%')}, feed ${measure(t.feed_mm_min[i], 0, 'mm/min')}`,
  ]);
}

interface Quantity {
  id: string;
  name: string;
  decimals: number;
  step?: boolean;
  column: (trace: Trace) => Maybe[];
}

/** A rapid leaves no surface: its error is a gap. */
const errorInCut = (trace: Trace) => trace.contour_error_um.map((e, i) => (trace.cutting[i] === 1 ? e : null));

export const COURSES: readonly Quantity[] = [
  { id: 'course-error', name: 'contour error in µm', decimals: 1, column: errorInCut },
  { id: 'course-override', name: 'feed override in %', decimals: 0, step: true, column: (t) => t.override_percent },
  { id: 'course-feed', name: 'path feed in mm/min', decimals: 0, column: (t) => t.feed_mm_min },
];

export const abscissaName = (of: Abscissa) => (of === 'path_mm' ? 'path length in mm' : 'time in s');

function end(report: Report, of: Abscissa): number {
  return Math.max(...RUNS.map((r) => report[r].trace[of].at(-1) ?? 0), 1e-3);
}

const most = (values: readonly Maybe[], sign: 1 | -1 = 1) => values.reduce<number>((m, v) => Math.max(m, sign * (v ?? 0)), 0);

/** Covers the cut; a rapid runs off the top. */
function range(report: Report, course: Quantity): [number, number] {
  const both = RUNS.map((r) => course.column(report[r].trace).map((v, i) => (report[r].trace.cutting[i] === 1 ? v : null)));
  const top = Math.max(...both.map((v) => most(v)));
  if (course.id !== 'course-error') {
    return [0, niceAbove(Math.max(top, course.id === 'course-override' ? 100 : 1) * 1.05)];
  }
  const least = report.limit_um * 1.3;
  return [-niceAbove(Math.max(...both.map((v) => most(v, -1)), least)), niceAbove(Math.max(top, least))];
}

/** All quantities of both runs at one place along the program. */
function courseReading(report: Report, of: Abscissa, x: number): string {
  const at = RUNS.map((r) => nearestIndex(report[r].trace[of], x));
  const lines = RUNS.map((r, k) => String(report[r].trace.line[at[k] ?? -1] ?? '–'));
  const quantities = COURSES.map((c) => ({ name: c.name, values: RUNS.map((r, k) => fixed(c.column(report[r].trace)[at[k] ?? -1], c.decimals)) }));
  return readingTable(of === 'path_mm' ? measure(x, 2, 'mm') : measure(x, 3, 's'), RUNS.map((r) => runName(report, r)), [{ name: 'line', values: lines }, ...quantities]);
}

export function coursePlot(report: Report, course: Quantity, of: Abscissa, theme: Theme): Plot {
  const [min, max] = range(report, course);
  const limits: Layer = { ...rules('y', [report.limit_um, -report.limit_um], theme.limit, true), name: `limit ±${um(report.limit_um)}` };
  return {
    title: `${capital(course.name)} along the program`,
    x: { name: abscissaName(of), min: 0, max: end(report, of) },
    y: { name: course.name, min, max },
    group: 'course',
    layers: [
      ...(course.id === 'course-error' ? [limits] : []),
      ...RUNS.map((run): Layer => ({
        kind: 'line',
        name: runName(report, run),
        x: report[run].trace[of],
        y: course.column(report[run].trace),
        colour: theme.run[run],
        width: run === 'with' ? 1.5 : 1.2,
        step: course.step ?? false,
      })),
    ],
    readout: (x) => courseReading(report, of, x),
  };
}

/** Path length at each instant, interpolated between the samples. */
export function pathAt(trace: Trace, times: readonly Maybe[]): Maybe[] {
  return times.map((t) => {
    if (t === null || trace.time_s.length === 0) {
      return null;
    }
    const i = Math.min(lowerBound(trace.time_s, t), trace.time_s.length - 1);
    const [t1, s1] = [trace.time_s[i] ?? 0, trace.path_mm[i] ?? 0];
    const [t0, s0] = [trace.time_s[i - 1] ?? t1, trace.path_mm[i - 1] ?? s1];
    return t1 > t0 ? s0 + ((s1 - s0) * Math.min(Math.max(t - t0, 0), t1 - t0)) / (t1 - t0) : s1;
  });
}

export const VIBRATIONS = [
  { id: 'vibration-peak', name: 'peak displacement of the tool in µm', key: 'peak_um' },
  { id: 'vibration-chatter', name: 'chatter (vibration that does not repeat from tooth to tooth), RMS in µm', key: 'unforced_um' },
  { id: 'vibration-speed', name: 'spindle speed in rpm', key: 'speed_rpm' },
] as const;

export function vibrationPlot(report: Report, what: (typeof VIBRATIONS)[number], of: Abscissa, theme: Theme): Plot {
  const layers = RUNS.flatMap((run): Layer[] => {
    const course = report[run].vibration?.course;
    const x = course && (of === 'time_s' ? course.time_s : pathAt(report[run].trace, course.time_s));
    return course && x ? [{ kind: 'line', name: runName(report, run), x, y: course[what.key], colour: theme.run[run], width: run === 'with' ? 1.5 : 1.2 }] : [];
  });
  const top = Math.max(...layers.map((l) => (l.kind === 'line' ? most(l.y) : 0)), 1e-3);
  return {
    title: capital(what.name),
    x: { name: abscissaName(of), min: 0, max: end(report, of) },
    y: { name: what.name, min: 0, max: niceAbove(top * 1.05) },
    group: 'vibration',
    layers,
  };
}
