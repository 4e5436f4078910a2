// SPDX-License-Identifier: Apache-2.0
// What the live page says: in every language, in either system of units.
import { readFileSync } from 'node:fs';
import { afterEach, describe, expect, it } from 'vitest';
import type { MachineKey, Status } from '../../src/live/api/types';
import { ticks } from '../../src/live/paint/frame';
import { planeOf, runsOf } from '../../src/live/paint/path';
import { widen } from '../../src/live/paint/strip';
import { layerInControl } from '../../src/live/shell/head';
import { chooseUnits, feed, length, small, units } from '../../src/live/state/units';
import { REASONS_DE } from '../../src/live/texts/reasons_de';
import { REASONS_RU } from '../../src/live/texts/reasons_ru';
import { REASONS_ZH } from '../../src/live/texts/reasons_zh';
import { ALL, type TextKey } from '../../src/live/texts/texts';
import { parsed, wordsOf } from '../../src/live/views/keys';
import { boundsFault, boundsOf, modulationOf } from '../../src/live/views/chatter/modulation';
import { planWords } from '../../src/live/views/chatter/plan';
import { chatterWords } from '../../src/live/views/now/chatter';
import { bytesText } from '../../src/live/views/record/list';
import { nameText } from '../../src/live/views/record/detail';
import { span } from '../../src/live/views/times';
import { plan } from '../live/answers';
import { Layer } from '../live/layer';

const places = (text: string) => [...text.matchAll(/\{\w+\}/g)].map(String).sort();

describe('the texts', () => {
  it.each(['de', 'zh', 'ru'] as const)('of %s fill in what the English ones do', (language) => {
    for (const key of Object.keys(ALL.en) as TextKey[]) {
      expect(places(ALL[language][key]), key).toEqual(places(ALL.en[key]));
      expect(ALL[language][key].trim(), key).not.toBe('');
    }
  });
  it('of the reasons are all that docs/reasons.md lists', () => {
    const docs = readFileSync(new URL('../../../docs/reasons.md', import.meta.url), 'utf8');
    const names = [...docs.matchAll(/^\| \d+ \| `(\w+)`/gm)].map((m) => m[1]).sort();
    expect(names.length).toBeGreaterThan(40);
    for (const own of [REASONS_DE, REASONS_ZH, REASONS_RU]) {
      expect(Object.keys(own).sort()).toEqual(names);
    }
  });
  it.each([['en', 'rpm'], ['de', 'U/min'], ['ru', 'об/мин'], ['zh', 'r/min']] as const)('of %s have one unit of speed, %s', (language, unit) => {
    expect(ALL[language].rpm).toBe(unit);
    const of = Object.values(ALL[language]).join('\n');
    expect(['rpm', 'U/min', '1/min', 'min⁻¹', 'об/мин', 'r/min'].filter((u) => of.replaceAll('{rpm}', '').split(/[^\p{L}\d/⁻¹]+/u).includes(u))).toEqual([unit]);
  });
  it('name no option that the program does not have', () => {
    const help = ['--record', '--past-runs', '--process', '--depth-mm'];
    for (const texts of Object.values(ALL)) {
      expect(texts.records_none_hint.match(/--[\w-]+/g)).toEqual(['--record', '--past-runs']);
      for (const text of Object.values(texts)) {
        for (const [option] of text.matchAll(/--[a-z][\w-]*/g)) expect(help).toContain(option);
      }
    }
  });
  it('name times as people do', () => {
    expect([44.6, 840, 7560].map(span)).toEqual(['45\u00a0s', '14\u00a0min', '2.1\u00a0h']);
  });
  it('name sizes and figures', () => {
    expect([bytesText(3_300_000), bytesText(1234), bytesText(2e9)]).toEqual(['3.3\u00a0MB', '1.2\u00a0kB', '2.0\u00a0GB']);
    expect(['over_limit_s', 'work_p50_us', 'cycles', 'reasons.contour_limit'].map(nameText)).toEqual(['over limit, s', 'work p50, µs', 'cycles', 'reasons · contour limit']);
    expect(nameText('spindle_rpm')).toBe('spindle, rpm');
  });
});

describe('units', () => {
  afterEach(() => chooseUnits('mm'));
  it('are metric', () => {
    expect([small(12.34), length(-3.2), feed(4000), small(null)]).toEqual(['12.3\u00a0µm', '−3.200\u00a0mm', '4000\u00a0mm/min', '–']);
  });
  it('are inch, mil and inch per minute', () => {
    chooseUnits('inch');
    expect([small(25.4), length(25.4), feed(2540)]).toEqual(['1.000\u00a0mil', '1.0000\u00a0in', '100.0\u00a0ipm']);
    expect(units().small.back(units().small.of(7))).toBeCloseTo(7, 12);
  });
});

describe('chatter', () => {
  const layer = new Layer();
  const said = (change: object, listening = true) => chatterWords({ hello: { ...layer.hello(), listening }, frame: { ...layer.frame(1), chatter: { chatter: false, ...change } }, spectrum: undefined });
  it('is told with its frequency, and what is done against it', () => {
    expect(said({})).toBe('The cut is quiet');
    expect(said({ chatter: true })).toBe('The cut chatters');
    expect(said({ chatter: true, frequency_hz: 946.6, better_spindle_percent: 90 })).toBe('The cut chatters at 947\u00a0Hz · Better: spindle at 90 %');
    expect(said({ modulating: true })).toBe('The cut is quiet · Spindle speed modulated');
  });
  it('is not called quiet where nobody listens', () => {
    expect(said({}, false)).toBe('Nothing listens for chatter: start the layer with --process FILE --depth-mm MM.');
  });
  it('is neither there nor not out of the cut', () => {
    const frame = layer.frame(1);
    expect(chatterWords({ hello: layer.hello(), frame: { ...frame, status: { ...frame.status, cutting: false }, chatter: { chatter: false } }, spectrum: undefined })).toBe('Not cutting');
  });
  it('has a plan in words', () => {
    expect(planWords(plan())).toBe('Set the spindle override to 90 %: 4680 rpm.');
    expect(planWords({ ...plan(), decision: 'keep', speed_rpm: 5200 })).toBe('Keep 5200 rpm: the cut is stable.');
    expect(planWords({ ...plan(), decision: 'law', law: 'sine', rva: 0.2, period_s: 0.5 })).toBe('Modulate the spindle speed: sine, ±20 % every 0.5 s.');
    expect(planWords({ ...plan(), decision: 'nothing' })).toBe('Nothing helps at 1.2 mm.');
  });
});

describe('who is in control', () => {
  const status = (change: Partial<Status>): Status => ({ ...new Layer().status(), mode: 'act', feed_percent: 100, feed_panel_percent: 100, spindle_percent: 100, offset_um: [0], path_offset_um: [0], ...change });
  it('is the layer where it acts and asks for something else', () => {
    expect(layerInControl(status({ feed_percent: 60 }))).toBe(true);
    expect(layerInControl(status({ spindle_percent: 95 }))).toBe(true);
    expect(layerInControl(status({ offset_um: [0, -2] }))).toBe(true);
  });
  it('is the operator otherwise', () => {
    expect(layerInControl(status({}))).toBe(false);
    expect(layerInControl(status({ mode: 'advise', feed_percent: 60 }))).toBe(false);
    expect(layerInControl(status({ feed_percent: 70, feed_panel_percent: 70 }))).toBe(false);
  });
});

describe('the modulation', () => {
  it('is the same as bounds and as ratios', () => {
    const given = { law: 'triangle', amplitude_ratio: 0.1, period_s: 2, mean_ratio: 0.95 } as const;
    const bounds = boundsOf(given);
    expect(bounds.lower_percent).toBeCloseTo(85.5, 9);
    expect(bounds.upper_percent).toBeCloseTo(104.5, 9);
    const again = modulationOf('triangle', bounds);
    expect(again.amplitude_ratio).toBeCloseTo(0.1, 12);
    expect(again.mean_ratio).toBeCloseTo(0.95, 12);
    expect(again.period_s).toBe(2);
  });
  it('is refused where it makes no sense', () => {
    const fault = (lower_percent: number, upper_percent: number, frequency_hz: number) => boundsFault({ lower_percent, upper_percent, frequency_hz });
    expect([fault(80, 110, 0.5), fault(100, 100, 1)]).toEqual(['', '']);
    expect([fault(110, 80, 1), fault(0, 80, 1), fault(NaN, 80, 1), fault(80, 110, 0), fault(80, 110, NaN)].every((f) => f !== '')).toBe(true);
  });
});

describe('a setting of the machine file', () => {
  const key = (value: MachineKey['value'], range = ''): MachineKey => ({ key: 'a.b', value, unit: '', range, explanation: '', live: true });
  it('is read as the kind of value that it has', () => {
    expect([parsed('12,5', 1), parsed(' 3 ', 1), parsed('x', 1), parsed('', 1)]).toEqual([12.5, 3, undefined, undefined]);
    expect([parsed('1, 2.5', [0]), parsed('1, x', [0]), parsed('a, b', ['c']), parsed('text', 'other')]).toEqual([[1, 2.5], undefined, ['a', 'b'], 'text']);
  });
  it('offers the words that its range names', () => {
    expect(wordsOf(key('b', 'a | b | c'))).toEqual(['a', 'b', 'c']);
    expect([wordsOf(key('b', '0 … 10')), wordsOf(key('z', 'a | b')), wordsOf(key(1, '1 | 2'))]).toEqual([[], [], []]);
  });
});

describe('the drawing', () => {
  it('has its figures on round values', () => {
    expect(ticks({ low: 0, high: 15, at: (v) => v }, 4).map((t) => t.text)).toEqual(['0', '5', '10', '15']);
    expect(ticks({ low: -0.3, high: 0.3, at: (v) => v }, 3).map((t) => t.text)).toEqual(['−0.2', '0.0', '0.2']);
  });
  it('draws the path up to a gap, and goes on behind it', () => {
    const at = (x: number, error: number) => ({ x, y: 0, error });
    const runs = runsOf([at(0, 1), at(1, 1), at(2, 9), at(NaN, NaN), at(5, 9), at(6, 9)], (error) => (error > 5 ? 'red' : 'blue'));
    expect(runs.map((r) => [r.colour, ...r.points.map((p) => p.x)])).toEqual([['blue', 0, 1], ['red', 1, 2], ['red', 5, 6]]);
  });
  it('keeps the extremes of a column over a missing value', () => {
    const columns = { low: new Float64Array([NaN]), high: new Float64Array([NaN]) };
    for (const value of [NaN, 3, 7, NaN, 5]) widen(columns, 0, value);
    expect([columns.low[0], columns.high[0]]).toEqual([3, 7]);
  });
  it('shows a mill from above and a lathe from the front', () => {
    expect(planeOf(['X', 'Y', 'Z'])).toEqual({ across: 0, up: 1, names: ['X', 'Y'] });
    expect(planeOf(['X', 'Z'])).toEqual({ across: 1, up: 0, names: ['Z', 'X'] });
    expect(planeOf([])).toEqual({ across: 0, up: 1, names: ['X', 'Y'] });
  });
});
