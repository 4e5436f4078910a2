// SPDX-License-Identifier: Apache-2.0
import type { Maybe } from '../../frame/data';
import { fixed } from '../../frame/numbers';
import type { Theme } from '../../frame/theme';
import { niceAbove } from '../../plot/axes';
import type { Live } from '../state/live';
import { t } from '../texts/texts';
import { type Area, Canvas, overColour } from './canvas';
import { type Scale, drawFrame, inner, scale } from './frame';

export class SpectrumPicture {
  readonly canvas: Canvas;
  /** Falls slowly, so that the scale does not flicker. */
  private top = 0;

  constructor(
    private readonly live: Live,
    name: string,
    resized: () => void,
  ) {
    this.canvas = new Canvas(name, t('spectrum'), resized);
  }

  draw(theme: Theme): void {
    const area = this.canvas.begin();
    const { spectrum } = this.live;
    if (!area) {
      return;
    }
    const place = inner(area);
    if (!spectrum || spectrum.hz.length < 2) {
      area.pen.fillStyle = theme.faint;
      area.pen.textAlign = 'center';
      area.pen.textBaseline = 'middle';
      area.pen.fillText(t('no_spectrum'), area.width / 2, area.height / 2);
      return;
    }
    const peak = spectrum.amplitude.reduce((most, a) => Math.max(most, a), 0);
    this.top = Math.max(peak, 0.97 * this.top);
    const x = scale(0, spectrum.hz.at(-1) ?? 1, place.left, place.right);
    const y = scale(0, niceAbove(1.1 * this.top), place.bottom, place.top);
    drawFrame(area, theme, x, y, (value, text) => (value === 0 ? '0 Hz' : text));
    this.mark(area, theme.faint, x, spectrum.tooth_hz, t('tooth_hz'), 0);
    this.mark(area, overColour(theme), x, spectrum.chatter_hz, t('chatter_hz'), 1);
    const { pen } = area;
    pen.strokeStyle = theme.run.with;
    pen.lineWidth = 1.5;
    pen.beginPath();
    spectrum.hz.forEach((hz, i) => pen.lineTo(x.at(hz), y.at(spectrum.amplitude[i] ?? 0)));
    pen.stroke();
  }

  private mark({ pen, width, height }: Area, colour: string, x: Scale, hz: Maybe, name: string, row: number): void {
    if (hz === null || hz > x.high) {
      return;
    }
    const { top, bottom } = inner({ pen, width, height });
    const at = x.at(hz);
    pen.strokeStyle = pen.fillStyle = colour;
    pen.lineWidth = 1.2;
    pen.setLineDash([4, 3]);
    pen.beginPath();
    pen.moveTo(at, top);
    pen.lineTo(at, bottom);
    pen.stroke();
    pen.setLineDash([]);
    const label = `${name} ${fixed(hz, 0)} Hz`;
    pen.textBaseline = 'top';
    pen.textAlign = at + pen.measureText(label).width + 8 > width ? 'right' : 'left';
    pen.fillText(label, at + (pen.textAlign === 'left' ? 5 : -5), top + 14 * row);
  }
}
