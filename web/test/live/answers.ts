// SPDX-License-Identifier: Apache-2.0
// What the mock's server answers about machine, heat, lobes and records.
import type { Checked, DamagedRecord, EncoderAxis, Lobes, Machine, MachineKey, Plan, RecordData, RecordDetail, RecordRow, Thermal } from '../../src/live/api/types';

const key = (name: string, value: MachineKey['value'], unit: string, range: string, explanation: string, live = true): MachineKey => ({ key: name, value, unit, range, explanation, live });

export const TEXT = `name = "VMC with SINUMERIK 840D"
port = "sim"
mode = "observe"

[contour]
strategy = "feed_priority"
limit_um = 10
min_percent = 10
max_percent = 100
margin_percent = 5
`;

export function machine(limit_um = 10): Machine {
  return {
    file: '/etc/steadyrest/vmc-840d.toml',
    name: 'VMC with SINUMERIK 840D',
    sha256: 'ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad',
    text: TEXT,
    sections: [
      {
        name: 'contour', title: 'Contour error',
        keys: [
          key('contour.strategy', 'feed_priority', '', 'contour_priority | feed_priority | balanced', 'What counts more where contour error and time compete.'),
          key('contour.limit_um', limit_um, 'µm', '0.1 … 1000', 'The largest contour error that the layer allows.'),
          key('contour.min_percent', 10, '%', '0 … 100', 'The lowest feed override that the layer asks for.'),
          key('contour.max_percent', 100, '%', '0 … 200', 'The highest feed override that the layer asks for.'),
          key('contour.margin_percent', 5, '%', '0 … 50', 'Share of the limit that is kept in reserve.'),
        ],
      },
      { name: 'chatter', title: 'Spindle modulation', keys: [key('chatter.law', 'triangle', '', 'constant | triangle | sine', 'Shape of the modulation.'), key('chatter.amplitude_percent', 10, '%', '0 … 90', 'Swing to either side of the mean speed.'), key('chatter.period_s', 2, 's', '0.02 … 600', 'Period of the modulation.'), key('chatter.mean_percent', 95, '%', '10 … 200', 'Mean speed as a share of the programmed one.')] },
      { name: 'envelope', title: 'Limits of every command', keys: [key('envelope.max_feed_percent', 120, '%', '0 … 200', 'No command exceeds this.'), key('envelope.stale_after_ms', 200, 'ms', '1 … 10000', 'Older input is not acted on.'), key('envelope.layer_may_exceed_panel', false, '', '', 'May the layer ask for more than the operator’s switch?', false)] },
      { name: 'axis[0]', title: 'Axis X', keys: [key('axis[0].servo_gain_m_min_mm', 3, '(m/min)/mm', '0.1 … 20', 'Servo gain of the position loop.', false), key('axis[0].limits_mm', [-400, 400], 'mm', '', 'Travel.', false)] },
      { name: 'override.feed', title: 'Feed override switch', keys: [key('override.feed.percent', [0, 1, 2, 4, 6, 8, 10, 20, 30, 40, 50, 60, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120], '%', '2 … 64 values', 'What each position of the switch means.', false)] },
    ],
    findings: [{ severity: 'warning', check: 'contour.limit', what: 'The contour limit is smaller than the backlash of X and Y together (4 µm) allows at reversals.', to_do: 'Raise contour.limit_um or compensate the backlash in the control.' }],
    reload: { number: 2, utc: '2026-01-02T03:04:05Z', outcome: 'taken', words: '' },
  };
}

export function checked(request: { changes?: Record<string, unknown>; text?: string }): Checked {
  const lines = request.text === undefined ? Object.entries(request.changes ?? {}).flatMap(([k, v]) => [`-${k.replace(/^.*\./, '')} = …`, `+${k.replace(/^.*\./, '')} = ${JSON.stringify(v)}`]) : ['+# edited as a whole'];
  const limit = request.changes?.['contour.limit_um'];
  const refused = typeof limit === 'number' && (limit < 0.1 || limit > 1000);
  const fits = request.changes?.['envelope.layer_may_exceed_panel'] === undefined;
  return {
    diff: `--- vmc-840d.toml\n+++ vmc-840d.toml\n@@ -5,6 +5,6 @@\n [contour]\n${lines.join('\n')}\n`,
    text: TEXT,
    sha256_before: machine().sha256,
    refusals: refused ? [{ file: 'vmc-840d.toml', line: 7, what: `contour.limit_um is ${limit}, allowed is 0.1 … 1000 µm.`, to_do: 'Give a limit within the range.' }] : [],
    findings: machine().findings,
    fits_running: fits && !refused,
    why_not: fits ? null : 'layer_may_exceed_panel takes effect after a restart',
  };
}

export function lobes(): Lobes {
  const speed_rpm = Array.from({ length: 81 }, (_, i) => 3000 + 100 * i);
  const depth_mm = Array.from({ length: 41 }, (_, i) => 0.1 * i);
  const border = (rpm: number) => 0.9 + 2.4 * Math.abs(Math.sin((Math.PI * 922 * 60) / (2 * rpm))) ** 8;
  return { map: { speed_rpm, depth_mm, log_radius: speed_rpm.flatMap((n) => depth_mm.map((d) => 0.35 * (d - border(n)))) }, border: { speed_rpm, depth_mm: speed_rpm.map(border) }, depth_mm: 1.2 };
}

export function plan(): Plan {
  return { decision: 'constant', override_percent: [90], law: 'constant', rva: 0, period_s: null, speed_rpm: 4680, programmed_rpm: 5200, depth_mm: 1.2, limit_depth_mm: 1.84, likely_depth_mm: null, notes: [] };
}

export function thermal(): Thermal {
  const t_s = Array.from({ length: 1080 }, (_, i) => 40 * i);
  const curve = (scale: number) => t_s.map((t) => scale * (8 * (1 - Math.exp(-t / 5000)) - 4 * (t > 22_000 ? 1 - Math.exp(-(t - 22_000) / 6000) : 0)));
  const axis = (name: string, scale: number) => {
    const displacement = curve(scale);
    return { name, displacement_um: displacement, sd_um: t_s.map((t) => 0.3 + 0.5 * scale * Math.abs(Math.sin(t / 9000))), offset_um: displacement.map((d) => -2 * Math.round(d / 2)) };
  };
  const in_s = Array.from({ length: 61 }, (_, i) => 60 * i);
  const ahead = (name: string, scale: number) => ({ name, displacement_um: in_s.map((s) => scale * (4.5 - s / 900)), sd_um: in_s.map((s) => 0.4 + s / 3000), offset_um: in_s.map((s) => -scale * (4 - s / 1000)) });
  const turns = (t: number) => t % 7200 < 5000;
  return {
    share_k: 0.3,
    cyclogram: { t_s: t_s.slice(1), speed_rpm: t_s.slice(1).map((t) => (turns(t) ? 5200 : 0)), feed_mm_min: t_s.slice(1).map((t) => (turns(t) ? 1800 : 0)), cutting_percent: t_s.slice(1).map((t) => (turns(t) ? 92 : 0)), coolant_percent: t_s.slice(1).map(() => 0) },
    outlook: { of_last_s: 600, in_s, axes: [ahead('Y', 0.3), ahead('Z', 1)] },
    corrections: {
      step_um: 1,
      done: [{ axis: 'Z', t_s: 40_000, from_um: -3, to_um: -4 }, { axis: 'Y', t_s: 42_860, from_um: 0, to_um: -1 }],
      to_come: [{ axis: 'Z', in_s: 830, from_um: -4, to_um: -3 }, { axis: 'Z', in_s: 1900, from_um: -3, to_um: -2 }],
    },
    passports: [{ axis: 'Z', modes: [{ amplitude_um: 9.2, time_constant_min: 84 }, { amplitude_um: 2.1, time_constant_min: 12 }] }, { axis: 'Y', modes: [{ amplitude_um: 2.8, time_constant_min: 95 }] }],
    history: { t_s, axes: [axis('Y', 0.3), axis('Z', 1)] },
    next: { axis: 'Z', offset_um: -3, in_s: 830 },
    readings: [{ t_s: 42_200, axis: 'Z', displacement_um: -3.9, reason: 'thermal_reading_taken', sentence: 'A probe reading re-zeroed the thermal model.' }, { t_s: 42_980, axis: 'Z', displacement_um: 41, reason: 'thermal_reading_outlier', sentence: 'A probe reading too far from the forecast was rejected.' }],
  };
}

export function encoders(): EncoderAxis[] {
  const at_mm = Array.from({ length: 200 }, (_, i) => -400 + 4 * i);
  const error = (mm: number) => 0.02 * Math.sin(mm / 40);
  const linear = (name: string) => ({ name, rotary: false, encoder: { ideal: false, count_um: 0.1, line_period_um: 20, clock_ns: 100 }, estimator: { input: 'edges' as const, cycle_ms: 1, lag_ms: 0, bounded: true, line_error_um: 0.1 } });
  return [
    { ...linear('X'), calibration: { phase_error_um: [0.012, -0.008, 0.003, -0.007], lines: 8_000_000, lines_learnt: 7_412_000, periodic: false, applied: true, curve: { at_mm, low_um: at_mm.map((mm) => error(mm) - 0.015), high_um: at_mm.map((mm) => error(mm) + 0.015) } } },
    { ...linear('Y'), calibration: { phase_error_um: [0, 0, 0, 0], lines: 0, lines_learnt: 0, periodic: false, applied: false, curve: null } },
    { ...linear('Z'), calibration: null },
    { name: 'C', rotary: true, encoder: { ideal: false, count_deg: 0.001, line_period_deg: 0.004, clock_ns: null }, calibration: null, estimator: { input: 'counts', cycle_ms: 1, lag_ms: 0, bounded: false, line_error_deg: null } },
  ];
}

export const RECORDS: (RecordRow | DamagedRecord)[] = [
  { name: 'rib-pocket-2026-01-02.sqlite', start_utc: '2026-01-02T08:04:05Z', machine: 'VMC with SINUMERIK 840D', program: 'rib-pocket.mpf', seconds: 1834, samples: 1_834_000, bytes: 91_400_000, closed: true, writing: false, fault: false },
  { name: 'circle-r10.sqlite', start_utc: '2026-01-01T17:30:00Z', machine: 'VMC with SINUMERIK 840D', program: 'circle-r10.mpf', seconds: 62, samples: 62_000, bytes: 3_300_000, closed: true, writing: false, fault: true },
  { name: 'slot <test>.sqlite', start_utc: '2025-12-30T11:00:00Z', machine: 'Lathe 16K20F3, retrofitted', program: 'slot.mpf', seconds: 411, samples: 411_000, bytes: 20_900_000, closed: false, writing: true, fault: false },
  { name: 'torn.sqlite', bytes: 1_200_000, damaged: 'file is not a database' },
];

export function record(): RecordDetail {
  return {
    run: { machine: 'VMC with SINUMERIK 840D', program: 'rib-pocket.mpf', mode: 'act', start_utc: '2026-01-02T08:04:05Z', version: '0.1.0', cycle_s: 0.001 },
    events: [
      { t_s: 0, kind: 'start', text: 'The run begins in observe.' },
      { t_s: 4.21, kind: 'note', text: 'page: anna (engineer) asked for act' },
      { t_s: 612.4, kind: 'reload', text: 'Machine file taken, sha256 ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad' },
      { t_s: 1833.9, kind: 'end', text: 'The run ends; everything was handed back.' },
    ],
    totals: { cycles: 1_834_000, overruns: 0, over_limit_s: 0.21, work_p50_us: 41.2, reasons: { contour_limit: 412_000, none: 1_204_000 } },
    formats: ['sqlite', 'csv', 'hdf5'],
  };
}

const RUN_S = 1834;

export function recordData(query: URLSearchParams): RecordData {
  const from = Number(query.get('from_s') ?? 0);
  const to = Math.min(Number(query.get('to_s') ?? RUN_S), RUN_S);
  const points = Math.min(Number(query.get('points') ?? 1000), 4000);
  const t_s = Array.from({ length: points }, (_, i) => from + ((to - from) * i) / (points - 1));
  const middle = (t: number) => 5 + 3 * Math.sin(t / 40) + 1.5 * Math.sin(t * 3.1);
  return { t_s, columns: Object.fromEntries((query.get('columns') ?? '').split(',').map((c) => [c, { min: t_s.map((t) => middle(t) - 0.8), max: t_s.map((t) => middle(t) + 0.8) }])) };
}
