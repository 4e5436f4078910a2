// SPDX-License-Identifier: Apache-2.0
// Scales, keys and what the pointer reads.
import { describe, expect, it } from 'vitest';
import { errorClasses } from '../../src/cut/scale';
import { loudnessScale, radiusLevels } from '../../src/chatter/raster';
import type { Plot } from '../../src/plot/drawn';
import { axisFor, axisOption, niceAbove, niceStep, roomy, span } from '../../src/plot/axes';
import { withEqualAspect } from '../../src/plot/equal_aspect';
import { keyLine, keysOf, scaleLine } from '../../src/plot/key';
import type { Layer } from '../../src/plot/layers';
import { valuesAt } from '../../src/plot/reading';
import { inView, zoomOption } from '../../src/plot/zoom';
import { curveColour, theme } from '../../src/frame/theme';

const LIGHT = theme(true);
const plot = (layers: Layer[], more: Partial<Plot> = {}): Plot => ({ title: 'T', x: { name: 'time in s', min: 0, max: 10 }, y: { name: 'y' }, layers, ...more });

describe('what the pointer reads', () => {
  const line: Layer = { kind: 'line', name: 'a <b>', x: [0, 1, 2], y: [10, null, 30], colour: 'red' };
  it('is the nearest value of each named curve, as text', () => {
    expect(valuesAt(plot([line]), 1.8)).toBe('time in s <b>1.8</b><br>a &#60;b&#62; <b>30</b>');
    expect(valuesAt(plot([line]), 1.1)).toContain('<b>–</b>');
  });
  it('is both edges of a band', () => {
    expect(valuesAt(plot([{ kind: 'band', name: 'bound', x: [0, 1], low: [-1, -2], high: [1, 2], colour: 'red', opacity: 1 }]), 0.9)).toContain('<b>−2 … 2</b>');
  });
  it('is nothing where no curve runs along x', () => {
    // A closed curve has no value at an x.
    expect(valuesAt(plot([{ ...line, x: [0, 2, 1] }]), 1)).toBeUndefined();
    expect(valuesAt(plot([{ kind: 'rules', name: 'limit', axis: 'y', at: [1], colour: 'red' }]), 1)).toBeUndefined();
  });
});

describe('the key', () => {
  it('has a mark for each kind of layer and each name once', () => {
    const keys = keysOf([
      { kind: 'line', name: 'a', x: [], y: [], colour: 'red' }, { kind: 'line', name: 'a', x: [], y: [], colour: 'blue' }, { kind: 'line', name: 'b', x: [], y: [], colour: 'red', dashed: true },
      { kind: 'dots', name: 'c', dots: [], colour: 'red', size: 3 }, { kind: 'dots', name: 'd', dots: [], colour: 'red', size: 3, hollow: true },
      { kind: 'spans', name: 'e', spans: [], colour: 'red', opacity: 0.5 }, { kind: 'line', name: 'f', x: [], y: [], colour: 'red', quiet: true },
    ]);
    expect(keys.map((k) => [k.name, k.mark])).toEqual([['a', 'line'], ['b', 'dashed'], ['c', 'dot'], ['d', 'hoop'], ['e', 'area']]);
    expect(keys[0]?.colour).toBe('red');
    expect(keyLine([{ name: '<x>', colour: 'red', mark: 'line' }])).toContain('&#60;x&#62;');
  });
  it('has the scale with its marked edge and what is beside it', () => {
    const html = scaleLine({ title: 'ρ', cells: [{ colour: '#fff', upTo: '1', marked: true }, { colour: '#000', upTo: '2' }], beside: { name: 'border', colour: 'red', mark: 'line' } });
    expect(html.match(/class="marked"/g)?.length).toBe(1);
    expect(html).toContain('border');
  });
});

describe('colour scales', () => {
  it('have no gap, and equal ratios over the limit', () => {
    const classes = errorClasses(10, 320, 'light');
    expect(classes.slice(1).every((c, i) => Math.abs(c.from_um - (classes[i]?.to_um ?? 0)) < 1e-9)).toBe(true);
    const ratios = classes.filter((c) => c.over).map((c) => c.to_um / c.from_um);
    for (const ratio of ratios) {
      expect(ratio).toBeCloseTo((400 / 10) ** 0.2, 9); // up to 400, the next round number
    }
  });
  it('divide by what was reached where there is no limit', () => expect(errorClasses(0, 87, 'light').map((c) => c.to_um)).toEqual([25, 50, 75, 100]));
  it('end at 0 dB and start at the quiet level', () => expect(loudnessScale(-50, 'light').cells.map((c) => c.upTo)).toEqual(['−50', '−40', '−30', '−20', '−10', '0']));
  // 10 % per tooth pass: the border of the first class is at 1.1, whatever the data.
  it('of the spectral radius are steps of ρ per pass', () => {
    const levels = radiusLevels([5], true, 'light');
    expect(levels.filter((l) => l.from >= 0).map((l) => Math.exp(l.from))).toEqual([1, 1.1, 1.25, 1.5, 2].map((v) => expect.closeTo(v, 12)));
  });
});

describe('axes', () => {
  it('step by 1, 2 or 5 in every decade', () => {
    for (let power = -9; power <= 9; ++power) {
      const lead = niceStep(3.7 * 10 ** power, 10) / 10 ** Math.floor(Math.log10(niceStep(3.7 * 10 ** power, 10)) + 1e-9);
      expect([1, 2, 5].some((n) => Math.abs(lead - n) < 1e-9), String(power)).toBe(true);
    }
  });
  it('end at a round number that is not below the value', () => {
    for (const value of [0.013, 1.2, 87.7, 100, 101, 4.99e7]) {
      expect(niceAbove(value)).toBeGreaterThanOrEqual(value * (1 - 1e-9));
      expect(niceAbove(value)).toBeLessThanOrEqual(1.34 * value);
    }
    expect(niceAbove(Infinity)).toBe(1);
  });
  it('span what is known', () => {
    expect([span([3, null, -1]), span([null])]).toEqual([[-1, 3], [0, 1]]);
    expect(axisFor('y', [2, 4], true)).toMatchObject({ name: 'y', min: 0 });
    expect(roomy([-5, -1], true)[1]).toBeGreaterThanOrEqual(0);
  });
  it('show their ends only where those are ticks', () => {
    expect(axisOption({ name: 'a', min: 0, max: 10 }, LIGHT, 5).axisLabel).toMatchObject({ showMinLabel: true, showMaxLabel: true });
    expect(axisOption({ name: 'a', min: 0, max: 10 }, LIGHT, 5, [0.3, 9.9]).axisLabel).toMatchObject({ showMinLabel: false, showMaxLabel: false });
  });
  it('keep the middle when both get the same scale', () => {
    const box = withEqualAspect({ left: 10, right: 20, bottom: -5, top: 5 }, 300, 100);
    expect([(box.left + box.right) / 2, (box.bottom + box.top) / 2]).toEqual([15, 0]);
  });
});

describe('the view', () => {
  const chart = (...ranges: [number, number][]) => ({ getOption: () => ({ dataZoom: ranges.map(([start, end]) => ({ start, end })) }) }) as never;
  it('is a share of the axis, and unknown where the axis finds its own ends', () => {
    expect(inView(chart([25, 75], [0, 100]), plot([]))).toEqual({ x: [2.5, 7.5], y: undefined });
    expect(inView(chart(), plot([], { y: { name: 'y', min: -1, max: 1 } }))).toEqual({ x: [0, 10], y: [-1, 1] });
  });
  it('is kept by a plot redrawn over the same axes alone', () => {
    const before = { chart: chart([10, 20], [0, 50]), plot: plot([]), shown: plot([]), theme: LIGHT };
    expect(zoomOption(plot([]), before)).toMatchObject([{ start: 10, end: 20 }, { start: 0, end: 50 }]);
    expect(zoomOption(plot([], { x: { name: 'lag in ms' } }), before)[0]).not.toHaveProperty('start');
  });
  it('zooms a plane by Ctrl on both axes, others by Shift on y', () => {
    const keys = (plane: boolean) => zoomOption(plot([], { plane })).map((o) => (o as { zoomOnMouseWheel: string }).zoomOnMouseWheel);
    expect([keys(true), keys(false)]).toEqual([['ctrl', 'ctrl'], ['ctrl', 'shift']]);
  });
});

describe('the palette', () => {
  it('starts again when it runs out', () => expect(curveColour(LIGHT, LIGHT.other.length)).toBe(curveColour(LIGHT, 0)));
  it('of paper is light', () => expect([LIGHT.scheme, LIGHT.printing, LIGHT.paper]).toEqual(['light', true, '#ffffff']));
});
