// SPDX-License-Identifier: Apache-2.0
// What the live page keeps, and how it reads what people enter.
import { describe, expect, it } from 'vitest';
import { waitBefore } from '../../src/live/api/stream';
import type { Frame, Hello } from '../../src/live/api/types';
import { addressOf, keyOf, routeOf } from '../../src/live/shell/route';
import { Live } from '../../src/live/state/live';
import { Ring } from '../../src/live/state/ring';
import { may } from '../../src/live/state/role';
import { parseSettings } from '../../src/live/state/settings';
import { Staged } from '../../src/live/state/staged';
import { Layer } from '../live/layer';

describe('a ring', () => {
  it('keeps the newest rows in its memory, oldest first', () => {
    const ring = new Ring(['t'] as const, 4);
    expect([ring.size, ring.newest('t')]).toEqual([0, NaN]);
    for (let t = 0; t < 10; ++t) ring.push({ t });
    expect([ring.size, ring.at('t', 0), ring.newest('t'), ring.at('t', 4)]).toEqual([4, 6, 9, NaN]);
  });
  it('finds where a time begins', () => {
    const ring = new Ring(['t'] as const, 8);
    for (let t = 0; t < 12; ++t) ring.push({ t });
    expect([-1, 4, 7.5, 11, 12].map((t) => ring.from('t', t))).toEqual([0, 0, 4, 7, 8]);
  });
});

describe('the stream', () => {
  const take = (live: Live, frame: Frame) => live.take(frame);
  const started = (): { live: Live; layer: Layer } => {
    const [live, layer] = [new Live(), new Layer()];
    live.take(layer.hello());
    return { live, layer };
  };
  it('fills the samples without a gap while nothing is missing', () => {
    const { live, layer } = started();
    take(live, layer.frame(33));
    take(live, layer.frame(33));
    expect([live.samples.size, live.missing.seconds]).toEqual([66, 0]);
  });
  it('counts what did not arrive', () => {
    const { live, layer } = started();
    take(live, layer.frame(33));
    layer.skip(500);
    take(live, layer.frame(33, 3));
    expect(live.missing.seconds).toBeCloseTo(0.5, 3);
    expect(live.missing.frames).toBe(3);
    // The trail is broken there, not joined by a line that the tool never went.
    expect(Array.from({ length: live.trail.size }, (_, i) => live.trail.at('x', i)).filter(Number.isNaN).length).toBe(1);
  });
  it('counts nothing of the time before its first frame', () => {
    const { live, layer } = started();
    const stale = layer.frame(3, 7).samples;
    layer.skip(2000);
    const frame = layer.frame(30, 7);
    frame.lost_cycles = 5;
    for (const name of Object.keys(stale) as (keyof typeof stale)[]) {
      (frame.samples[name] as unknown[]).unshift(...stale[name]);
    }
    take(live, frame);
    expect([live.missing, live.samples.size]).toEqual([{ seconds: 0, frames: 0, cycles: 0 }, 30]);
    layer.skip(50);
    take(live, layer.frame(30, 1));
    expect(live.missing.seconds).toBeCloseTo(0.05, 3);
    expect(live.missing.frames).toBe(1);
  });
  it('starts again with the clock of the control', () => {
    const { live, layer } = started();
    take(live, layer.frame(33));
    take(live, new Layer().frame(10));
    expect(live.samples.size).toBe(10);
  });
  it('holds no more than its memory', () => {
    const { live, layer } = started();
    for (let i = 0; i < 600; ++i) take(live, layer.frame(33));
    expect(live.samples.size).toBe(live.samples.capacity);
    expect(live.trail.size).toBeLessThanOrEqual(live.trail.capacity);
  });
  it('takes null as no value, and a machine of two axes', () => {
    const { live, layer } = started();
    const frame = layer.frame(3);
    frame.samples.contour_error_um = [null, null, null];
    frame.samples.position_mm = frame.samples.position_mm.map((p) => p.slice(0, 2));
    take(live, frame);
    expect([live.samples.newest('error_um'), live.samples.newest('z'), live.trail.size]).toEqual([NaN, NaN, 1]);
  });
  it('says when the machine file was read anew', () => {
    const { live, layer } = started();
    expect([live.take(layer.hello() satisfies Hello), live.take(layer.frame(1))]).toEqual([true, false]);
  });
  it('waits longer after each attempt, but never long', () => {
    expect([0, 1, 2, 3, 4, 20].map(waitBefore)).toEqual([500, 1000, 2000, 4000, 5000, 5000]);
  });
});

describe('an address', () => {
  it('names a view, and a record in any spelling', () => {
    expect(routeOf('#/motion')).toEqual({ view: 'motion', argument: '' });
    expect(routeOf(addressOf('record', 'a/b %.sqlite'))).toEqual({ view: 'record', argument: 'a/b %.sqlite' });
    expect([routeOf('').view, routeOf('#/nonsense').view, routeOf('#/record/100%').argument]).toEqual(['now', 'now', '100%']);
  });
  it('may bring a key', () => {
    expect([keyOf('#key=abc-123'), keyOf('#/now'), keyOf('#key='), keyOf('')]).toEqual(['abc-123', undefined, undefined, undefined]);
  });
});

describe('settings', () => {
  it('follow the browser until they are chosen', () => {
    expect(parseSettings(null, ['fr-FR', 'de-AT'])).toEqual({ language: 'de', look: 'auto', units: 'mm' });
    expect(parseSettings('{"language":"ru","look":"contrast","units":"inch"}', ['de'])).toEqual({ language: 'ru', look: 'contrast', units: 'inch' });
  });
  it.each(['', 'null', '[]', '{"language":"xx","look":1}', '{'])('survive %s', (stored) => {
    expect(parseSettings(stored, [])).toEqual({ language: 'en', look: 'auto', units: 'mm' });
  });
});

describe('roles', () => {
  it('include those below them', () => {
    expect(may('engineer', 'operator') && may('operator', 'viewer') && may('viewer', 'viewer')).toBe(true);
    expect(may('viewer', 'operator') || may('operator', 'engineer')).toBe(false);
  });
});

describe('staged changes', () => {
  it('are those that differ from what is in force', () => {
    const staged = new Staged();
    let told = 0;
    const end = staged.onChange(() => ++told);
    staged.set('contour.limit_um', 12, 10);
    staged.set('contour.strategy', 'feed_priority', 'feed_priority');
    expect([staged.count, told, staged.request()]).toEqual([1, 2, { changes: { 'contour.limit_um': 12 } }]);
    staged.set('contour.limit_um', 10, 10);
    end();
    staged.set('list', [1, 2], [1, 2]);
    expect([staged.count, told]).toEqual([0, 3]);
  });
  it('are single settings or the whole text, never both', () => {
    const staged = new Staged();
    staged.set('a.b', true, false);
    staged.setText('x', 'y');
    expect([staged.count, staged.request()]).toEqual([1, { text: 'x' }]);
    staged.set('a.b', true, false);
    expect([staged.count, staged.text]).toEqual([1, undefined]);
    staged.setText('y', 'y');
    expect(staged.count).toBe(0);
  });
});
