// SPDX-License-Identifier: Apache-2.0
// What the pages say in sentences.
import { describe, expect, it } from 'vitest';
import type { PlanPage } from '../../src/chatter/data';
import { nothing } from '../../src/chatter/plan';
import type { VibrationFigures } from '../../src/cut/data';
import { motionRows, vibrationRows, vibrationVerdict } from '../../src/cut/figures';
import { said } from '../../src/frame/view';
import { duration } from '../../src/thermal/plan';

const vibration = (peak_um: number, surface_range_um: number | null): VibrationFigures => ({
  vibration_rms_um: peak_um / 2,
  vibration_peak_um: peak_um,
  unforced_rms_um: 0.1,
  force_peak_n: 100,
  power_peak_w: 50,
  chip_peak_um: 90,
  surface_error_um: surface_range_um === null ? null : 1,
  surface_range_um,
});

describe('what a verb said', () => {
  it('is written as sentences, one in a line, as text', () => {
    expect(said('notes', ['the panel must be at <110 %>', 'Done.'])).toBe('<ul class="notes" id="notes"><li>The panel must be at &#60;110 %&#62;.</li><li>Done.</li></ul>');
    expect(said('notes', [])).toBe('');
  });
});

describe('the vibration', () => {
  it('is in the verdict where a cut was simulated', () => {
    expect(vibrationVerdict(vibration(236, 0), vibration(31.25, 0))).toBe('The tool vibrates by up to 31.3\u00a0µm instead of 236.0\u00a0µm.');
    expect(vibrationVerdict(undefined, undefined)).toBe('');
  });
  it('tells of the wall only where the tool can move across it', () => {
    const walls = (a: number | null, b: number | null) => vibrationRows(vibration(9, a), vibration(3, b)).filter((r) => r.label.startsWith('Finished wall')).length;
    expect([walls(null, null), walls(0, 0), walls(2, 0), walls(5, 1)]).toEqual([0, 0, 2, 2]);
  });
});

describe('an axis at rest', () => {
  it('has nothing to improve on', () => {
    const atRest = { axis: 'Y', velocity_rms_mm_s: 2e-6, acceleration_rms_mm_s2: 1e-5, difference_velocity_rms_mm_s: 0, difference_acceleration_rms_mm_s2: 0, velocity_coverage_ratio: 1, acceleration_coverage_ratio: 1 };
    expect(motionRows([atRest]).map((r) => r.finer)).toEqual(['–', '–']);
  });
});

describe('a plan without a choice', () => {
  const of = (more: Partial<PlanPage['answer']>) => nothing({ depth_mm: 4, likely_depth_mm: null, helping_override_percent: null, ...more } as PlanPage['answer']);
  it('says what would be stable, but never that 0 mm is', () => {
    expect(of({ likely_depth_mm: 1.5625 })).toBe('No override step and no speed law keeps 4\u00a0mm stable. Up to 1.56\u00a0mm is likely to be stable.');
    expect(of({ likely_depth_mm: 0 })).toBe('No override step and no speed law keeps 4\u00a0mm stable.');
  });
  it('names the step that helps although only laws were asked for', () => {
    expect(of({ helping_override_percent: 105, likely_depth_mm: 0 })).toBe('No speed law keeps 4\u00a0mm stable; a constant override of 105\u00a0% does.');
  });
});

describe('the length of a transition', () => {
  it('is in seconds when it is short', () => {
    expect([0.0033333, 0.08333, 7.0782, 60, undefined].map(duration)).toEqual(['0.2 s', '5 s', '7.08 min', '60 min', '– min']);
  });
});
