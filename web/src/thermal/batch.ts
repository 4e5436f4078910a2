// SPDX-License-Identifier: Apache-2.0
// A day of parts: what heat did to them without a correction, with the program's text corrected, and on line.
import { section } from '../frame/html';
import { fixed, plain } from '../frame/numbers';
import { figures } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { roomy } from '../plot/axes';
import type { Layer } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { nearestIndex } from '../plot/thin';
import { BAND } from './course';
import type { BatchPage } from './data';
import { rule, um } from './over_time';

/** Minutes from … to of each part. */
function parts(page: BatchPage): [number, number][] {
  return page.answer.parts.map((p) => [p.start_s / 60, (p.start_s + page.answer.program_s) / 60]);
}

const cutting = (page: BatchPage, theme: Theme): Layer => ({ kind: 'spans', name: 'a part is being cut', spans: parts(page), colour: theme.faint, opacity: 0.08 });

function dayPlot(page: BatchPage, theme: Theme): Plot {
  const c = page.course;
  const [min, max] = roomy([...c.without_um, ...c.text_um, ...c.online_um], true);
  return {
    title: `Error of ${page.axis} by heat over the batch`,
    x: { name: 'time in min', min: 0, max: page.answer.total_s / 60 },
    y: { name: `error of ${page.axis} in µm`, min, max },
    group: 'time',
    layers: [
      cutting(page, theme),
      rule([0], 'y', theme.faint),
      { ...rule([-page.answer.band_um, page.answer.band_um], 'y', theme.limit, true), name: '±Δk' },
      { kind: 'line', name: 'without correction', x: c.t_min, y: c.without_um, colour: theme.run.without, width: 2 },
      // In a pause no text runs: nothing is corrected then.
      { kind: 'line', name: "in the program's text", x: c.t_min, y: c.text_um.map((v, i) => (c.part[i] ? v : null)), colour: theme.faint, width: 1.6 },
      { kind: 'line', name: 'on line', x: c.t_min, y: c.online_um, colour: theme.run.with, width: 2 },
    ],
    readout: (t) => {
      const i = nearestIndex(c.t_min, t);
      return `<b>${plain(t)} min</b>${c.part[i] ? `, part ${c.part[i]}` : ''}<br>without ${um(c.without_um[i])}<br>in the text ${um(c.text_um[i])}<br>on line ${um(c.online_um[i])}<br>room ${fixed(c.room_c[i], 1)} °C`;
    },
  };
}

/** The growth of the machine, and what the layer believed of it. */
function beliefPlot(page: BatchPage, theme: Theme): Plot {
  const c = page.course;
  const edge = (sign: number) => c.model_um.map((v, i) => v + sign * BAND * (c.model_sd_um[i] ?? 0));
  const [min, max] = roomy([...c.without_um, ...edge(-1), ...edge(1)], true);
  return {
    title: `Displacement of ${page.axis} and what the model believed`,
    x: { name: 'time in min', min: 0, max: page.answer.total_s / 60 },
    y: { name: `displacement of ${page.axis} in µm`, min, max },
    group: 'time',
    layers: [
      cutting(page, theme),
      rule([0], 'y', theme.faint),
      { kind: 'band', name: 'its 95 % band', x: c.t_min, low: edge(-1), high: edge(1), colour: theme.run.with, opacity: 0.18 },
      { kind: 'line', name: 'the machine', x: c.t_min, y: c.without_um, colour: theme.run.without, width: 3 },
      { kind: 'line', name: 'the model', x: c.t_min, y: c.model_um, colour: theme.run.with, width: 1.6 },
    ],
    readout: (t) => {
      const i = nearestIndex(c.t_min, t);
      return `<b>${plain(t)} min</b><br>it was ${um(c.without_um[i])}<br>believed ${um(c.model_um[i])} ± ${um(BAND * (c.model_sd_um[i] ?? 0))}`;
    },
  };
}

function roomPlot(page: BatchPage, theme: Theme): Plot {
  const [min, max] = roomy(page.course.room_c);
  return {
    title: 'Temperature of the room',
    x: { name: 'time in min', min: 0, max: page.answer.total_s / 60 },
    y: { name: 'room in °C', min, max },
    group: 'time',
    layers: [cutting(page, theme), { kind: 'line', name: 'room', x: page.course.t_min, y: page.course.room_c, colour: theme.faint, width: 1.6 }],
  };
}

function partPlot(page: BatchPage, theme: Theme): Plot {
  const all = page.answer.parts;
  const dots = (of: 'without' | 'text' | 'online') => all.map((p, i) => ({ x: i + 1, y: p[of].largest_um }));
  const [, max] = roomy([0, ...all.map((p) => p.without.largest_um)], true);
  const line = (of: 'without' | 'text' | 'online', name: string, colour: string): Layer[] => [
    { kind: 'line', name, x: all.map((_, i) => i + 1), y: all.map((p) => p[of].largest_um), colour, width: 1.2 },
    { kind: 'dots', dots: dots(of), colour, size: 8 },
  ];
  return {
    title: 'Largest error of each part',
    x: { name: 'part', min: 0, max: all.length + 1 },
    y: { name: 'largest error in µm', min: 0, max },
    layers: [...line('without', 'without correction', theme.run.without), ...line('text', "in the program's text", theme.faint), ...line('online', 'on line', theme.run.with)],
  };
}

export function batchView(page: BatchPage): View {
  const a = page.answer;
  const row = (name: string, e: { largest_um: number; rms_um: number }) => [
    { label: `${name}: largest error`, value: um(e.largest_um) },
    { label: `${name}: RMS`, value: um(e.rms_um) },
  ];
  const worse = a.text.worse_parts + a.online.worse_parts;
  return {
    product: 'Steadyrest cut, a batch',
    title: page.title,
    facts: `<b>${a.parts.length}</b> parts · <b>${plain(a.total_s / 3600, 3)} h</b> from cold · axis <b>${page.axis}</b>`,
    verdict: `Heat displaces ${page.axis} by up to ${um(a.without.largest_um)}. Corrected in the program's text the largest error is ${um(a.text.largest_um)}, ${fixed(a.text.improvement, 1)} times smaller, on line ${um(a.online.largest_um)}, ${fixed(a.online.improvement, 1)} times; ${worse === 0 ? 'no part is worse for it' : `${worse} parts are worse for it`}.`,
    body:
      section('Over the batch', host('day', 'high'), 'Shaded: a part is being cut. The model is wrong as the machine file says; the probe reads before each part.') +
      section('The parts', host('parts')) +
      section('What the model believed', host('belief') + host('room', 'low'), 'Steps: a reading of the probe.') +
      section('Figures', figures([...row('without correction', a.without), ...row('in the text', a.text), ...row('on line', a.online)])),
    explanation: [
      ['Without correction', 'How far heat displaces the axis: what the parts get.'],
      ["In the program's text", 'The corrections that were planned beforehand are written into the program; each part is cut by the same text.'],
      ['On line', 'The layer works the displacement out while it arises, from speed, temperatures and the probe, and takes it off through an axis offset.'],
      ['±Δk', 'The share of the tolerance that heat may take.'],
      ['What the model believed', 'The displacement as the layer estimated it, with its 95 % band, beside what the simulated machine really did. A step is a reading of the probe.'],
    ],
    draw: (theme) => {
      plot('day', dayPlot(page, theme), theme);
      plot('parts', partPlot(page, theme), theme);
      plot('belief', beliefPlot(page, theme), theme);
      plot('room', roomPlot(page, theme), theme);
    },
  };
}
