// SPDX-License-Identifier: Apache-2.0
// Every way to cut the part side by side: as a table, and as error over cycle time.
import { capital, escapeHtml, section } from '../frame/html';
import { change, fixed, percent, plain, um } from '../frame/numbers';
import { type Cell, numeric, table } from '../frame/table';
import { type Theme, curveColour } from '../frame/theme';
import type { Term } from '../frame/view';
import { type Axis, span } from '../plot/axes';
import { placed } from '../plot/labels';
import { type Dot, type Layer, rules } from '../plot/layers';
import { heightOf } from '../plot/logarithmic';
import { type Plot, panels } from '../plot/plot';
import { reading } from '../plot/reading';
import type { CurvePoint, Figures, Report, WayFigures, WayName } from './data';
import { micrometres, overLimitShare, seconds } from './figures';
import { WAYS } from './way_names';

function nameOf(way: WayName, report: Report): string {
  const program = report.against === undefined ? '' : way.startsWith('changed') ? 'changed program, ' : 'original, ';
  return `${program}${WAYS[way].name}`;
}

const curveName = (point: CurvePoint) => `feed override for ${plain(point.limit_um)} µm`;

const QUANTITIES = [
  { id: 'ways-max', name: 'largest contour error in µm', value: (f: Figures) => 1000 * f.contour_error_max_mm },
  { id: 'ways-rms', name: 'contour error, RMS, in µm', value: (f: Figures) => 1000 * f.contour_error_rms_mm },
] as const;
export const WAY_PLOTS = QUANTITIES.map((q) => q.id);

/** What to do for the best; empty where nothing is better. */
export function bestSection(report: Report): string {
  const { best } = report;
  if (!best) {
    return '';
  }
  const row = (head: string, way: WayFigures | null): Cell[][] =>
    way ? [[head, capital(WAYS[way.way].name), seconds(way.cycle_time_s), micrometres(way.contour_error_max_mm), micrometres(way.contour_error_rms_mm), percent(overLimitShare(way), 2), { html: escapeHtml(way.get ?? ''), look: 'code' }]] : [];
  const rows = [...row('In the same time', best.same_time), ...row('In more time', best.any_time), ...row('Cheapest first', best.setting)];
  const columns = [{ head: '' }, { head: 'Way' }, numeric('Cycle time'), numeric('Error, max'), numeric('Error, RMS'), numeric(`Over ${um(report.limit_um)}`), { head: 'Command or setting' }];
  return rows.length === 0 ? '' : section('The best, and how to get it', table({ id: 'best', columns, rows }));
}

/** Which lines stay over the limit in the best way, and why; empty without. */
export function overSection(report: Report): string {
  const over = report.over_limit ?? [];
  const rows = over.map((o): Cell[] => [String(o.line), { html: fixed(o.error_um, 1), look: 'over' }, o.reason, o.cure ?? '']);
  const columns = [numeric('Line'), numeric('Error, µm'), { head: 'Reason' }, { head: 'Cheapest cure: its price' }];
  return rows.length === 0 ? '' : section('What is left over the limit', table({ id: 'over-limit', columns, rows: rows.slice(0, MOST_OVER) }), over.length > MOST_OVER ? `The worst ${MOST_OVER} of ${over.length} lines.` : '');
}
const MOST_OVER = 20;

export const comparesWays = (report: Report) => report.ways.length > 1;

function rowOf(name: string, figures: Figures, first: Figures, limit_um: number): Cell[] {
  const over = 1000 * figures.contour_error_max_mm > limit_um;
  return [
    capital(name),
    seconds(figures.cycle_time_s),
    figures === first ? '' : change(first.cycle_time_s, figures.cycle_time_s),
    { html: micrometres(figures.contour_error_max_mm), ...(over ? { look: 'over' } : {}) },
    micrometres(figures.contour_error_rms_mm),
    percent(overLimitShare(figures), 2),
  ];
}

function waysTable(report: Report): string {
  const first = report.ways[0] as WayFigures;
  const row = (name: string, figures: Figures) => rowOf(name, figures, first, report.limit_um);
  return table({
    id: 'ways',
    columns: [{ head: 'Way' }, numeric('Cycle time'), numeric('Change'), numeric('Error, max'), numeric('Error, RMS'), numeric(`Over ${um(report.limit_um)}`)],
    rows: [...report.ways.map((w) => row(nameOf(w.way, report), w)), ...report.curve.map((c) => row(curveName(c), c))],
  });
}

/** Empty if there is nothing to choose between. */
export function waysSection(report: Report): string {
  return comparesWays(report) ? section('Ways to cut the part', panels(WAY_PLOTS) + waysTable(report)) : '';
}

/** Of the dots, the last on top: where several ways end at one place, each shows as a ring. */
const SMALLEST_PX = 9;

/** Room for a label on either side. */
const ROOM = 0.7;

/** The ends of an axis of time, as wide as the labels need. */
function timeAxis(times: readonly number[]): Axis & { min: number; max: number } {
  const [low, high] = span(times);
  const reach = Math.max(high - low, 0.1 * high, 1e-3);
  const middle = 0.5 * (low + high);
  return { name: 'cycle time in s', min: Math.max(0, middle - (0.5 + ROOM) * reach), max: middle + (0.5 + ROOM) * reach, ticks: 6 };
}

interface Point extends Dot {
  name: string;
  colour: string;
  way?: WayName;
}

/** The nearest point's name and values. */
function readout(points: readonly Point[], y: Axis, quantity: string): NonNullable<Plot['readout']> {
  return (atX, atY, reach) => {
    const distance = (p: Point) => Math.hypot((p.x - atX) / reach, 8 * ((heightOf(y, p.y) ?? 0) - (heightOf(y, atY) ?? 0)));
    const nearest = [...points].sort((a, b) => distance(a) - distance(b))[0];
    return nearest && distance(nearest) < 2 ? { html: reading(capital(nearest.name), [`${quantity} <b>${um(nearest.y)}</b>`, `cycle time <b>${seconds(nearest.x)}</b>`]), at: [nearest.x, nearest.y] } : undefined;
  };
}

export function wayPlot(report: Report, index: number, theme: Theme): Plot {
  const quantity = QUANTITIES[index] ?? QUANTITIES[0];
  const positive = (p: Point) => p.y > 0;
  const blue = curveColour(theme, WAYS.feed_override.colour);
  const point = (figures: Figures, label: string, name: string, colour: string): Point => ({ x: figures.cycle_time_s, y: quantity.value(figures), label, name, colour });
  const ways = report.ways.map((w): Point => ({ ...point(w, WAYS[w.way].label, nameOf(w.way, report), curveColour(theme, WAYS[w.way].colour)), way: w.way })).filter(positive);
  const curve = report.curve.map((c) => point(c, `${plain(c.limit_um)} µm`, curveName(c), blue)).filter(positive);
  const points = [...ways, ...curve];
  const x = timeAxis(points.map((p) => p.x));
  const y: Axis = { name: quantity.name, log: true };
  const limit = quantity.id === 'ways-max' ? [report.limit_um] : [];
  const [low, high] = span(points.map((p) => heightOf(y, p.y)));
  const labelled = placed(points, x, y, Math.floor(low), Math.max(Math.ceil(high), Math.floor(low) + 1));
  // The curve goes through the feed override at the report's own limit.
  const byTime = [...curve, ...ways.filter((w) => w.way === 'feed_override')].sort((a, b) => a.x - b.x);
  return {
    title: `${capital(quantity.name)} over cycle time`,
    x,
    y,
    group: 'ways',
    layers: [
      ...(limit.length > 0 ? [{ ...rules('y', limit, theme.limit, true), name: `limit ${um(report.limit_um)}` }] : []),
      ...(curve.length > 0
        ? [
            { kind: 'line', name: 'feed override at other limits', colour: blue, width: 1.2, x: byTime.map((p) => p.x), y: byTime.map((p) => p.y) } satisfies Layer,
            { kind: 'dots', dots: labelled.slice(ways.length), colour: blue, size: 7, hollow: true } satisfies Layer,
          ]
        : []),
      ...ways.map((w, i): Layer => ({ kind: 'dots', name: w.name, dots: labelled.slice(i, i + 1), colour: w.colour, size: SMALLEST_PX + 2 * (ways.length - 1 - i) })),
    ],
    readout: readout(points, y, quantity.name.replace(/,? in µm$/, '')),
  };
}

export const WAYS_TERM: Term = [
  'Ways',
  'The same part, cut as programmed, with one setting of the control changed, with a corrected text (in the same time, with lower feeds where that does not hold the limit, by lower feeds alone), with the layer acting through the feed override only, and with the layer moving the axes off the path where the machine file permits it (the feed then falls only for what the offsets leave). A changed program is judged by the path of its original. “Feed override for 5 µm” is the layer told to hold 5 µm; its share over the limit still refers to the limit of the report. Down and to the left is better.',
];
