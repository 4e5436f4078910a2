// SPDX-License-Identifier: Apache-2.0
// What the pages of the chatter verbs conclude, for each kind of answer.
import { describe, expect, it } from 'vitest';
import type { Alternative, ChatterEvent, DetectPage, GrowthPage, PlanPage, SimulatePage } from '../../src/chatter/data';
import { detectView } from '../../src/chatter/detect';
import { growthView } from '../../src/chatter/growth';
import { choiceText, planView } from '../../src/chatter/plan';
import { simulateView } from '../../src/chatter/simulate';
import { typeName } from '../../src/chatter/words';

const NB = '\u00a0';

const step = (percent: number, more: Partial<Alternative> = {}): Alternative => ({
  law: 'constant', override_percent: [percent], limit_depth_mm: 1.5, probability: null, peak_growth: null, speed_rpm: 50 * percent, stable: true, growth_is_lower_bound: false, reasons: [], ...more,
});
const sine = { law: 'sine', rva: 0.2, rvf: 0.1, period_s: 0.5 };

describe('a plan', () => {
  const plan = (answer: object, alternatives: Alternative[] = []) =>
    planView({
      process: 'slot', machine: 'mill', border: {}, map: {}, others: [], steps: [],
      answer: { ...step(110), decision: 'constant', depth_mm: 2, most_depth_mm: 8, likely_depth_mm: null, helping_override_percent: null, chatter_frequency_hz: 922, notes: [], alternatives, best_speeds: [], ...answer },
    } as unknown as PlanPage);

  it('names a step by its speed and a law by its words', () => {
    expect(choiceText(step(110))).toBe(`110${NB}% = 5500${NB}rpm`);
    expect(choiceText(step(100, sine))).toBe(`sine ±20${NB}% every 0.5${NB}s`);
  });
  it('says what to do', () => {
    expect(plan({ ...step(100), decision: 'keep' }).verdict).toMatch(/^Keep the programmed speed: 100/);
    expect(plan({}).verdict).toMatch(/^Set the spindle override to 110/);
    expect(plan({ ...sine, decision: 'law' }).verdict).toMatch(/^Modulate the spindle speed: sine/);
    expect(plan({ decision: 'nothing' }).verdict).toMatch(/^No override step and no speed law/);
  });
  it('says what happens otherwise, only where the programmed speed chatters', () => {
    const now = step(100, { stable: false, limit_depth_mm: 0.75 });
    expect(plan({}, [now]).verdict).toContain(`At 5000${NB}rpm and 2${NB}mm the cut chatters at 922.0${NB}Hz; the border is at 0.750${NB}mm.`);
    expect(plan({}, [{ ...now, stable: true }]).verdict).not.toContain('chatters');
    expect(plan({ decision: 'keep', ...step(100) }, [now]).verdict).not.toContain('chatters');
  });
  it('says what is gained, and by what share of likely cuts', () => {
    expect(plan({ limit_depth_mm: 3, probability: 0.97 }).verdict).toContain(`the border is at 3.000${NB}mm and 97${NB}% of the likely cuts are stable.`);
    expect(plan({ limit_depth_mm: null }).verdict).not.toContain('border');
  });
  it('marks the choice alone among the alternatives, and gives the reasons against the rest', () => {
    const { body } = plan({}, [step(100, { reasons: ['over the <limit>'] }), step(110), step(120), step(90, { stable: true, limit_depth_mm: null, peak_growth: 12.5, growth_is_lower_bound: true })]);
    expect(body.match(/class="chosen"/g)?.length).toBe(1);
    expect(body).toContain('over the &#60;limit&#62;');
    expect(body).toContain('would also do');
    expect(body).toContain('≥ 12.5');
    expect(body).toContain('over 8');
  });
  it('lists best speeds only where the range has any', () => {
    expect(plan({}).body).not.toContain('Best spindle speeds');
    expect(plan({ best_speeds: [{ speed_rpm: 6500, limit_depth_mm: null, sure_depth_mm: 2.5 }] }).body).toContain('over 8');
  });
});

describe('a signal', () => {
  const event = (more: Partial<ChatterEvent> = {}): ChatterEvent => ({
    start_s: 1.25, end_s: 2, frequency_hz: 411, type: 'hopf', speed_rpm: 4000, order: 6.165, confidence: 0.98, nearest_mode: null, advised_speed_rpm: 4400, advised_override_percent: 110, decision: null,
    evidence: [{ channel: 1, nearest_order: 6, order_folded: false, from_order_hz: 11, from_order_sd_hz: 0.5, confidence: 0.98 }], ...more,
  });
  const page = (events: ChatterEvent[]) =>
    detectView({ process: 'p', machine: 'm', teeth: 1, answer: { advice_by: 'planner', events, cuts: [], edge_revolutions: 10, at_edges: [], seconds: 3, sample_rate_hz: 20_000, sensor: [] } } as unknown as DetectPage);
  it('without chatter says so and has no table', () => {
    expect(page([]).verdict).toBe('No chatter in 3 s.');
    expect(page([]).body).not.toContain('Where it chatters');
    expect(page([]).facts).toContain('1 tooth');
  });
  it('says when, at what frequency, and what to do', () => {
    expect(page([event()]).verdict).toBe(`The cut chatters from 1.250 to 2.000 s at 411.0${NB}Hz (Hopf). Better speed, by the planner: 4400${NB}rpm (110${NB}%).`);
    expect(page([event(), event()]).verdict).toMatch(/^The cut chatters 2 times, first from/);
  });
  it('does not promise a speed where none is better', () => {
    const none = { advised_speed_rpm: null, advised_override_percent: null };
    expect(page([event(none)]).verdict).toContain('No override step is better.');
    expect(page([event({ ...none, lobe_speeds_rpm: [4110, 3082.5] })]).verdict).toContain(`unchecked: 4110, 3083${NB}rpm.`);
    expect(page([event({ ...none, decision: 'law' })]).verdict).toContain('modulate the speed');
    expect(page([event({ ...none, decision: 'nothing' })]).verdict).toContain('nothing helps at this depth');
  });
  it('shows by what evidence it is chatter', () => {
    expect(page([event()]).body).toContain(`11.0 ± 0.5${NB}Hz from order 6`);
    expect(page([event({ type: 'flip' })]).body).toContain('grew while the tooth orders held steady');
    expect(page([event({ nearest_mode: { frequency_hz: 420, off_hz: -9 } })]).body).toContain('(−9.0)');
  });
  it('keeps the name of a type that it does not know', () => expect(['hopf', 'flip', 'fold'].map(typeName)).toEqual(['Hopf', 'flip', 'fold']));
});

describe('the growth of a vibration', () => {
  const page = (answer: object, log_growth: number[], law_period_s: number | null = null) =>
    growthView({
      process: 'p', worst: 0, pass_s: 0.01, law_period_s, speed: { time_s: [], speed_rpm: [] }, courses: [{ start_pass: 0, time_s: [0.1, 0.2, 0.3], log_growth }],
      answer: { law: 'constant', speed_rpm: 3000, depth_mm: 1, spectral_radius: 0.8, log_radius: -0.22, stable: true, type: 'hopf', frequency_hz: null, peak_growth: 2.718, passes: 3, ...answer },
    } as unknown as GrowthPage).verdict;
  it('is none, or dies, or goes on', () => {
    expect(page({}, [0, -1, -2])).toBe('The cut is stable: in the long run, each tooth pass multiplies a vibration by 0.8. No vibration grows on the way.');
    expect(page({}, [0, 1, 0])).toContain('grows up to 2.72-fold, 100 ms after it starts, before it dies.');
    expect(page({ stable: false, spectral_radius: 1.2 }, [0, 1, 2])).toContain('unstable (Hopf)');
    expect(page({ stable: false, spectral_radius: 1.2 }, [0, 1, 2])).toContain('200 ms after it starts, and keeps growing.');
  });
  it('counts by periods of a law, and in seconds where they are long', () => {
    expect(page({ law: 'sine' }, [0, 1, 0], 2.5)).toContain('each period of the law multiplies a vibration by 0.8');
    expect(page({ law: 'sine' }, [0, 1, 0], 2.5)).toContain('0.1 s after it starts');
  });
});

describe('a simulated cut', () => {
  const page = (answer: object, operation = 'milling', y = [0, 1]) =>
    simulateView({
      process: 'p', operation, teeth: 2, envelope: { y_low_um: y, y_high_um: y },
      answer: { law: 'constant', speed_rpm: 3000, depth_mm: 1, peak_um: 12.3, growth_per_tooth: 0.75, stable: true, forced_um: null, chatter_rms_um: null, chatter_frequency_hz: null, force_peak_N: 250, power_peak_W: 90, wall_error_um: 3, wall_range_um: 4, ...answer },
    } as unknown as SimulatePage);
  it('is stable, or chatters at a frequency', () => {
    expect(page({}).verdict).toBe(`The cut is stable: each tooth multiplies a small vibration by 0.75. The tool moves by up to 12.3${NB}µm; the force peaks at 250${NB}N.`);
    expect(page({ stable: false, growth_per_tooth: 1.5, chatter_frequency_hz: 905 }).verdict).toMatch(new RegExp(`^The cut chatters at 905.0${NB}Hz: each tooth multiplies`));
  });
  it('counts turns where there are no teeth', () => expect(page({}, 'turning').verdict).toContain('each revolution multiplies'));
  it('tells of the wall only where the tool moves across it', () => {
    expect(page({}).body).toContain('Finished wall, mean offset');
    expect(page({}, 'milling', [0, 0]).body).not.toContain('Finished wall');
  });
  it('shows only figures that it has', () => {
    expect(page({}).body).not.toContain('Forced amplitude');
    expect(page({ forced_um: 2 }).body).toContain('Forced amplitude');
  });
});
