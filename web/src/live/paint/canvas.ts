// SPDX-License-Identifier: Apache-2.0
// What is drawn many times a second is drawn straight onto a canvas: a chart library would build its whole scene anew each time.
import type { Theme } from '../../frame/theme';
import { FONT } from '../../frame/looks';
import { h } from '../shell/h';

export interface Area {
  pen: CanvasRenderingContext2D;
  width: number;
  height: number;
}

/** A canvas as sharp as the screen. */
export class Canvas {
  readonly element: HTMLCanvasElement;
  private readonly pen: CanvasRenderingContext2D;
  private readonly size: ResizeObserver;
  private width = 0;
  private height = 0;

  constructor(name: string, label: string, resized: () => void) {
    this.element = h('canvas', { class: `paint ${name}`, id: name, role: 'img', 'aria-label': label });
    this.pen = this.element.getContext('2d') as CanvasRenderingContext2D;
    this.size = new ResizeObserver(() => {
      this.width = this.element.clientWidth;
      this.height = this.element.clientHeight;
      resized();
    });
    this.size.observe(this.element);
  }

  /** Cleared, in CSS pixels; undefined while it has no size. */
  begin(): Area | undefined {
    const { element, pen, width, height } = this;
    if (width === 0 || height === 0) {
      return undefined;
    }
    const sharpness = window.devicePixelRatio || 1;
    const [wide, high] = [Math.round(width * sharpness), Math.round(height * sharpness)];
    if (element.width !== wide || element.height !== high) {
      [element.width, element.height] = [wide, high];
    }
    pen.setTransform(sharpness, 0, 0, sharpness, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.lineJoin = 'round';
    pen.font = `11px ${FONT}`;
    return { pen, width, height };
  }

  close(): void {
    this.size.disconnect();
  }
}

export const overColour = (theme: Theme) => (theme.scheme === 'dark' ? '#ff8a8a' : '#a31f2b');

/** Hatched: nothing is known here. */
export function hatch(pen: CanvasRenderingContext2D, theme: Theme, x: number, y: number, width: number, height: number): void {
  pen.save();
  pen.beginPath();
  pen.rect(x, y, width, height);
  pen.clip();
  pen.strokeStyle = theme.faint;
  pen.globalAlpha = 0.55;
  pen.lineWidth = 1;
  pen.beginPath();
  for (let at = x - height - (x % 7); at < x + width; at += 7) {
    pen.moveTo(at, y + height);
    pen.lineTo(at + height, y);
  }
  pen.stroke();
  pen.restore();
}
