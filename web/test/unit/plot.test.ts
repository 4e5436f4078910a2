// SPDX-License-Identifier: Apache-2.0
import { describe, expect, it } from 'vitest';
import { theme } from '../../src/frame/theme';
import { type Axis, axisOption } from '../../src/plot/axes';
import { keyLine, keysOf } from '../../src/plot/key';

const LIGHT = theme(true);
/** Room for so many characters beside a plot. */
const MOST_CHARACTERS = 10;

describe('the labels of an axis', () => {
  const labels = (axis: Axis, values: number[], shown?: [number, number]) => values.map(axisOption(axis, LIGHT, 8, shown).axisLabel.formatter);

  it('have room beside the plot, however large or small the values are', () => {
    expect(labels({ name: 'a', min: -1.5e6, max: 1e6 }, [-1e6, 0, 500_000])).toEqual(['−1·10⁶', '0', '5·10⁵']);
    expect(labels({ name: 'a', min: 0, max: 4e-7 }, [0, 1e-7])).toEqual(['0', '1·10⁻⁷']);
    for (const size of [1e-9, 1e-5, 0.003, 7, 40_000, 999_999, 3e6, 8e11]) {
      const step = size / 4;
      for (const text of labels({ name: 'a', min: -size, max: size }, [-3, -1, 0, 2, 4].map((k) => k * step))) {
        expect(text.length, text).toBeLessThanOrEqual(MOST_CHARACTERS);
      }
    }
  });

  it('are as usual where there is room', () => {
    expect(labels({ name: 'a', min: -250_000, max: 250_000 }, [-250_000, 0])).toEqual(['−250\u202f000', '0']);
    expect(labels({ name: 'a', min: 0, max: 0.5 }, [0, 0.1])).toEqual(['0.0', '0.1']);
  });

  it('keep a given step while all is shown', () => {
    const phase: Axis = { name: 'phase', min: -270, max: 90, step: 90 };
    expect(axisOption(phase, LIGHT, 4).interval).toBe(90);
    expect(axisOption(phase, LIGHT, 4, [-270, 90]).interval).toBe(90);
    expect(axisOption(phase, LIGHT, 4, [-200, -150]).interval).toBeNull();
    expect(axisOption({ name: 'a', min: 0, max: 1 }, LIGHT, 4).interval).toBeNull();
  });
});

describe('the key', () => {
  it('shows areas as strong as the plot does, so that two of one colour differ', () => {
    const band = { kind: 'band', x: [], low: [], high: [], colour: '#1b6aa5' } as const;
    const keys = keysOf([{ ...band, name: 'bound', opacity: 0.22 }, { ...band, name: 'values', opacity: 0.75 }, { ...band, name: 'shade', opacity: 0.02 }]);
    expect(keys.map((k) => k.opacity)).toEqual([0.22, 0.75, 0.15]);
    expect(keyLine(keys)).toContain('data-opacity="0.22"');
  });
});
