// SPDX-License-Identifier: Apache-2.0
// A day of parts: their thermal error without correction, with corrections in the program text, and corrected online.
import { escapeHtml, section } from '../frame/html';
import { counted, fixed, plain, um } from '../frame/numbers';
import { figures } from '../frame/table';
import type { Theme } from '../frame/theme';
import type { View } from '../frame/view';
import { type Axis, axisFor } from '../plot/axes';
import { type Layer, rules } from '../plot/layers';
import { type Plot, host, plot } from '../plot/plot';
import { reading } from '../plot/reading';
import { nearestIndex } from '../plot/thin';
import { BAND, bandEdges, bandLayer } from './band';
import type { BatchPage, Error } from './data';

const WITHOUT = 'without correction';
const TEXT = 'in the program text';
const ONLINE = 'online';

/** A plot over the whole batch, shaded while a part is being cut. */
function batchPlot(page: BatchPage, title: string, y: Axis, layers: readonly Layer[], theme: Theme): Plot {
  const spans = page.answer.parts.map((p): [number, number] => [p.start_s / 60, (p.start_s + page.answer.program_s) / 60]);
  return {
    title,
    x: { name: 'time in min', min: 0, max: page.answer.total_s / 60 },
    y,
    group: 'time',
    layers: [{ kind: 'spans', name: 'a part is being cut', spans, colour: theme.faint, opacity: 0.08 }, ...layers],
  };
}

function dayPlot(page: BatchPage, theme: Theme): Plot {
  const c = page.course;
  const y = axisFor(`error of ${page.axis} in µm`, [...c.without_um, ...c.text_um, ...c.online_um], true);
  const layers: Layer[] = [
    rules('y', [0], theme.faint),
    { ...rules('y', [-page.answer.band_um, page.answer.band_um], theme.limit, true), name: '±Δk' },
    { kind: 'line', name: WITHOUT, x: c.t_min, y: c.without_um, colour: theme.run.without, width: 2 },
    // In a pause no program runs, so its text corrects nothing.
    { kind: 'line', name: TEXT, x: c.t_min, y: c.text_um.map((v, i) => (c.part[i] ? v : null)), colour: theme.faint, width: 1.6 },
    { kind: 'line', name: ONLINE, x: c.t_min, y: c.online_um, colour: theme.run.with, width: 2 },
  ];
  return {
    ...batchPlot(page, `Thermal error of ${page.axis} over the batch`, y, layers, theme),
    readout: (t) => {
      const i = nearestIndex(c.t_min, t);
      return reading(`${plain(t)} min${c.part[i] ? `, part ${c.part[i]}` : ''}`, [
        `${WITHOUT} ${um(c.without_um[i])}`,
        ...(c.part[i] ? [`${TEXT} ${um(c.text_um[i])}`] : []),
        `${ONLINE} ${um(c.online_um[i])}`,
        `room ${fixed(c.room_c[i], 1)} °C`,
      ]);
    },
  };
}

/** The machine's true displacement, and what the layer took it for. */
function modelPlot(page: BatchPage, theme: Theme): Plot {
  const c = page.course;
  const y = axisFor(`displacement of ${page.axis} in µm`, [...c.without_um, ...bandEdges(c.model_um, c.model_sd_um).flat()], true);
  const layers: Layer[] = [
    rules('y', [0], theme.faint),
    bandLayer('95 % band of the model', c.t_min, c.model_um, c.model_sd_um, theme.run.with),
    { kind: 'line', name: 'actual', x: c.t_min, y: c.without_um, colour: theme.run.without, width: 3 },
    { kind: 'line', name: 'modelled', x: c.t_min, y: c.model_um, colour: theme.run.with, width: 1.6 },
  ];
  return {
    ...batchPlot(page, `Displacement of ${page.axis}, actual and modelled`, y, layers, theme),
    readout: (t) => {
      const i = nearestIndex(c.t_min, t);
      return reading(`${plain(t)} min`, [`actual ${um(c.without_um[i])}`, `modelled ${um(c.model_um[i])} ± ${um(BAND * (c.model_sd_um[i] ?? 0))}`]);
    },
  };
}

function roomPlot(page: BatchPage, theme: Theme): Plot {
  const { t_min, room_c } = page.course;
  return batchPlot(page, 'Room temperature', axisFor('room temperature in °C', room_c), [{ kind: 'line', name: 'room', x: t_min, y: room_c, colour: theme.faint, width: 1.6 }], theme);
}

function partPlot(page: BatchPage, theme: Theme): Plot {
  const all = page.answer.parts;
  const numbers = all.map((_, i) => i + 1);
  const line = (of: 'without' | 'text' | 'online', name: string, colour: string): Layer[] => [
    { kind: 'line', name, x: numbers, y: all.map((p) => p[of].largest_um), colour, width: 1.2 },
    { kind: 'dots', dots: all.map((p, i) => ({ x: i + 1, y: p[of].largest_um })), colour, size: 8 },
  ];
  return {
    title: 'Max error of each part',
    x: { name: 'part', min: 0, max: all.length + 1 },
    y: { ...axisFor('max error in µm', all.map((p) => p.without.largest_um), true), min: 0 },
    layers: [...line('without', WITHOUT, theme.run.without), ...line('text', TEXT, theme.faint), ...line('online', ONLINE, theme.run.with)],
  };
}

function verdict({ axis, answer: a }: BatchPage): string {
  const corrected = (e: Error & { improvement: number }) => `${um(e.largest_um)}, ${fixed(e.improvement, 1)} times less`;
  const worse = a.text.worse_parts + a.online.worse_parts === 0 ? 'No part gets worse.' : `Parts that get worse: ${a.text.worse_parts} with the text, ${a.online.worse_parts} online.`;
  return `Heat moves ${escapeHtml(axis)} by up to ${um(a.without.largest_um)}. Corrections in the program text leave ${corrected(a.text)}; online correction leaves ${corrected(a.online)}. ${worse}`;
}

export function batchView(page: BatchPage): View {
  const a = page.answer;
  const rows = (name: string, e: Error) => [
    { label: `${name}: max error`, value: um(e.largest_um) },
    { label: `${name}: RMS`, value: um(e.rms_um) },
  ];
  return {
    product: 'Steadyrest cut --batch',
    title: page.title,
    facts: `<b>${counted(a.parts.length, 'part', 'parts')}</b> · <b>${plain(a.total_s / 3600, 3)} h</b> from cold · axis <b>${escapeHtml(page.axis)}</b>`,
    verdict: verdict(page),
    body:
      section('Over the batch', host('day', 'high'), 'Shaded: a part is being cut. The model has the errors that the machine file gives it; the probe takes a reading before each part.') +
      section('The parts', host('parts')) +
      section('Actual and modelled displacement', host('model') + host('room', 'low'), 'Each step is a probe reading.') +
      section('Figures', figures([...rows('Without correction', a.without), ...rows('In the program text', a.text), ...rows('Online', a.online)])),
    explanation: [
      ['Without correction', 'How far heat moves the axis: the error that the parts get.'],
      ['In the program text', 'The planned corrections are written into the program; every part is cut with the same text.'],
      ['Online', 'The layer estimates the displacement as it arises, from spindle speed, temperatures and probe readings, and takes it out with an axis offset.'],
      ['±Δk', 'The share of the tolerance that drift may use.'],
      ['Modelled', 'The displacement as the layer estimated it, with its 95 % band, against what the simulated machine really did. Each step is a probe reading.'],
    ],
    draw: (theme) => {
      plot('day', dayPlot(page, theme), theme);
      plot('parts', partPlot(page, theme), theme);
      plot('model', modelPlot(page, theme), theme);
      plot('room', roomPlot(page, theme), theme);
    },
  };
}
