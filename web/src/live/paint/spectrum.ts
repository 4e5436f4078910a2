// SPDX-License-Identifier: Apache-2.0
import type { Maybe } from '../../frame/data';
import { fixed } from '../../frame/numbers';
import type { Theme } from '../../frame/theme';
import { niceAbove } from '../../plot/axes';
import type { Live } from '../state/live';
import { t } from '../texts/texts';
import { type Area, Canvas } from './canvas';
import { type Scale, drawFrame, inner, scale } from './frame';

/** A frequency that has a name. */
interface Mark {
  hz: Maybe;
  name: string;
  colour: string;
}

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
    drawFrame(area, theme, x, y, (value, text) => (value === 0 ? t('hertz', { value: text }) : text));
    const marks = [
      { hz: spectrum.tooth_hz, name: t('tooth_hz'), colour: theme.faint },
      { hz: spectrum.chatter_hz, name: t('chatter_hz'), colour: theme.run.without },
    ];
    marks.forEach((m) => this.rule(area, m, x));
    const { pen } = area;
    pen.strokeStyle = theme.run.with;
    pen.lineWidth = 1.5;
    pen.beginPath();
    spectrum.hz.forEach((hz, i) => pen.lineTo(x.at(hz), y.at(spectrum.amplitude[i] ?? 0)));
    pen.stroke();
    marks.forEach((m, row) => this.label(area, theme, m, x, row));
  }

  private rule({ pen, width, height }: Area, { hz, colour }: Mark, x: Scale): void {
    if (hz === null || hz > x.high) {
      return;
    }
    const { top, bottom } = inner({ pen, width, height });
    pen.strokeStyle = colour;
    pen.lineWidth = 1.2;
    pen.setLineDash([4, 3]);
    pen.beginPath();
    pen.moveTo(x.at(hz), top);
    pen.lineTo(x.at(hz), bottom);
    pen.stroke();
    pen.setLineDash([]);
  }

  private label({ pen, width, height }: Area, theme: Theme, { hz, name, colour }: Mark, x: Scale, row: number): void {
    if (hz === null || hz > x.high) {
      return;
    }
    const { top } = inner({ pen, width, height });
    const text = `${name} ${t('hertz', { value: fixed(hz, 0) })}`;
    const wide = pen.measureText(text).width;
    const left = x.at(hz) + wide + 10 > width ? x.at(hz) - wide - 5 : x.at(hz) + 5;
    pen.fillStyle = theme.paper;
    pen.fillRect(left - 2, top + 15 * row, wide + 4, 14);
    pen.fillStyle = colour;
    pen.textAlign = 'left';
    pen.textBaseline = 'top';
    pen.fillText(text, left, top + 15 * row + 1);
  }
}
