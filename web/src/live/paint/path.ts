// SPDX-License-Identifier: Apache-2.0
// The tool's path from above: what is done in the colours of its error, what is ahead in those of the predicted error.
import { type ErrorClass, classOf, errorClasses } from '../../cut/scale';
import type { Theme } from '../../frame/theme';
import { withEqualAspect } from '../../plot/equal_aspect';
import type { Live } from '../state/live';
import { units } from '../state/units';
import { type Area, Canvas } from './canvas';
import { type Scale, drawFrame, inner, scale } from './frame';

/** Columns of the trail across and up, and the names of those axes. */
export interface Plane {
  across: 0 | 1 | 2;
  up: 0 | 1 | 2;
  names: readonly [string, string];
}

/** X and Y of a mill; a lathe is drawn as it is looked at, Z across and X up. */
export function planeOf(axes: readonly string[]): Plane {
  const [x, y, z] = ['X', 'Y', 'Z'].map((name) => axes.indexOf(name));
  const usable = (i: number | undefined): i is 0 | 1 | 2 => i !== undefined && i >= 0 && i < 3;
  if (!usable(y) && usable(x) && usable(z)) {
    return { across: z, up: x, names: ['Z', 'X'] };
  }
  return { across: usable(x) ? x : 0, up: usable(y) ? y : 1, names: [axes[usable(x) ? x : 0] ?? 'X', axes[usable(y) ? y : 1] ?? 'Y'] };
}

interface Point {
  x: number;
  y: number;
  error: number;
}

interface Run {
  colour: string;
  points: Point[];
}

/** The path in pieces of one colour, each from where the one before ends; a point without a place parts them. */
export function runsOf(points: readonly Point[], colourOf: (error: number) => string): Run[] {
  const runs: Run[] = [];
  let run: Run | undefined;
  for (const point of points) {
    if (!Number.isFinite(point.x)) {
      run = undefined;
      continue;
    }
    const colour = colourOf(point.error);
    if (run?.colour !== colour) {
      const last: Point | undefined = run?.points.at(-1);
      run = { colour, points: last ? [last] : [] };
      runs.push(run);
    }
    run.points.push(point);
  }
  return runs;
}

const NAMES = ['x', 'y', 'z'] as const;

export class PathPicture {
  readonly canvas: Canvas;
  private box = { left: 0, right: 0, bottom: 0, top: 0 };

  constructor(
    private readonly live: Live,
    label: string,
    resized: () => void,
  ) {
    this.canvas = new Canvas('path', label, resized);
  }

  /** The classes by which the path is coloured now. */
  classes(theme: Theme): ErrorClass[] {
    const limit = this.live.hello?.contour.limit_um ?? 0;
    // Always as far as 2.5 times the limit: a scale that changes cannot be learnt.
    return errorClasses(limit, 2.5 * (limit || 10), theme.scheme);
  }

  draw(theme: Theme): void {
    const area = this.canvas.begin();
    if (!area) {
      return;
    }
    const plane = planeOf(this.live.hello?.machine.axes.map((a) => a.name) ?? []);
    const trail = this.trail(plane);
    const ahead = this.ahead(plane);
    this.fit([...trail, ...ahead]);
    const place = inner(area);
    const { of } = units().length;
    const box = withEqualAspect(this.box, place.right - place.left, place.bottom - place.top);
    const x = scale(of(box.left), of(box.right), place.left, place.right);
    const y = scale(of(box.bottom), of(box.top), place.bottom, place.top);
    drawFrame(area, theme, x, y);
    this.nameAxes(area, theme, plane);
    area.pen.save();
    area.pen.beginPath();
    area.pen.rect(place.left, place.top, place.right - place.left, place.bottom - place.top);
    area.pen.clip();
    const classes = this.classes(theme);
    this.stroke(area, x, y, trail, classes, 3, []);
    this.stroke(area, x, y, ahead, classes, 2.5, [2, 5]);
    this.tool(area, theme, x, y, plane);
    area.pen.restore();
  }

  private trail(plane: Plane): Point[] {
    const { trail } = this.live;
    const points: Point[] = [];
    for (let i = 0; i < trail.size; ++i) {
      points.push({ x: trail.at(NAMES[plane.across], i), y: trail.at(NAMES[plane.up], i), error: trail.at('error_um', i) });
    }
    return points;
  }

  private ahead(plane: Plane): Point[] {
    const ahead = this.live.frame?.ahead;
    return (ahead?.points_mm ?? []).map((p, i) => ({ x: p[plane.across] ?? NaN, y: p[plane.up] ?? NaN, error: ahead?.error_um[i] ?? NaN }));
  }

  /** Grows at once; shrinks only when the path has become much smaller, so that the picture rests. */
  private fit(points: readonly Point[]): void {
    let [left, right, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
    for (const { x, y } of points) {
      if (Number.isFinite(x) && Number.isFinite(y)) {
        [left, right, bottom, top] = [Math.min(left, x), Math.max(right, x), Math.min(bottom, y), Math.max(top, y)];
      }
    }
    if (left > right) {
      return;
    }
    const { box } = this;
    const outside = left < box.left || right > box.right || bottom < box.bottom || top > box.top;
    const small = right - left < 0.6 * (box.right - box.left) && top - bottom < 0.6 * (box.top - box.bottom);
    if (outside || small) {
      const room = 0.05 * Math.max(right - left, top - bottom, 1);
      this.box = { left: left - room, right: right + room, bottom: bottom - room, top: top + room };
    }
  }

  private nameAxes({ pen, width, height }: Area, theme: Theme, plane: Plane): void {
    const { left, right, top, bottom } = inner({ pen, width, height });
    pen.fillStyle = theme.faint;
    pen.textAlign = 'left';
    pen.textBaseline = 'top';
    pen.fillText(`${plane.names[1]}, ${units().length.name}`, left + 6, top);
    pen.textAlign = 'right';
    pen.textBaseline = 'bottom';
    pen.fillText(`${plane.names[0]}, ${units().length.name}`, right - 2, bottom - 4);
  }

  private stroke({ pen }: Area, x: Scale, y: Scale, points: readonly Point[], classes: readonly ErrorClass[], width: number, dash: number[]): void {
    const { of } = units().length;
    pen.lineWidth = width;
    pen.setLineDash(dash);
    pen.lineCap = dash.length > 0 ? 'round' : 'butt';
    const colourOf = (error: number) => (Number.isNaN(error) ? 'grey' : (classes[classOf(classes, error)]?.colour ?? 'grey'));
    for (const run of runsOf(points, colourOf)) {
      pen.strokeStyle = run.colour;
      pen.beginPath();
      run.points.forEach((p) => pen.lineTo(x.at(of(p.x)), y.at(of(p.y))));
      pen.stroke();
    }
    pen.setLineDash([]);
    pen.lineCap = 'butt';
  }

  private tool({ pen }: Area, theme: Theme, x: Scale, y: Scale, plane: Plane): void {
    const { samples } = this.live;
    const { of } = units().length;
    const [px, py] = [x.at(of(samples.newest(NAMES[plane.across]))), y.at(of(samples.newest(NAMES[plane.up])))];
    if (!Number.isFinite(px) || !Number.isFinite(py)) {
      return;
    }
    pen.beginPath();
    pen.arc(px, py, 6, 0, 2 * Math.PI);
    pen.fillStyle = theme.paper;
    pen.fill();
    pen.strokeStyle = theme.text;
    pen.lineWidth = 2;
    pen.stroke();
    pen.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
      pen.moveTo(px + 6 * dx, py + 6 * dy);
      pen.lineTo(px + 11 * dx, py + 11 * dy);
    }
    pen.stroke();
  }
}
