// SPDX-License-Identifier: Apache-2.0
// Displacement over temperature, one curve for each stretch of one spindle speed (the paper's figure 1).
import { type View, figures, host, keyLine, plain, plot, section } from '../chatter/frame';
import { type Layer, type Plot, roomy } from '../chatter/plot';
import { fixed } from '../format';
import type { Theme } from '../theme';
import type { HysteresisPage } from './data';

/** From slow to fast; the spindle that stands is grey. */
const RAMP = ['#3b6fb5', '#2f9c95', '#6aa32d', '#d19a1c', '#c9541f', '#9c2c6d'];

export function speeds(page: HysteresisPage): number[] {
  const all = page.channels.flatMap((c) => c.stretches.map((s) => s.speed_rpm));
  return [...new Set(all)].sort((a, b) => a - b);
}

function colourOf(speed: number, all: readonly number[], theme: Theme): string {
  const turning = all.filter((s) => s > 0);
  const at = turning.indexOf(speed);
  return at < 0 ? theme.faint : (RAMP[Math.round((at * (RAMP.length - 1)) / Math.max(turning.length - 1, 1))] as string);
}

type Channel = HysteresisPage['channels'][number];

function channelPlot(page: HysteresisPage, channel: Channel, theme: Theme): Plot {
  const all = speeds(page);
  const [left, right] = roomy(channel.stretches.flatMap((s) => s.temperature_c));
  const [min, max] = roomy(channel.stretches.flatMap((s) => s.displacement_um));
  return {
    title: `${channel.channel} over ${channel.sensor}`,
    x: { name: `${channel.sensor}, temperature in °C`, min: left, max: right },
    y: { name: `${channel.channel}: displacement in µm`, min, max },
    layers: channel.stretches.map((s): Layer => ({
      kind: 'line',
      x: s.temperature_c,
      y: s.displacement_um,
      colour: colourOf(s.speed_rpm, all, theme),
      width: s.speed_rpm > 0 ? 1.8 : 1.2,
      dashed: s.speed_rpm === 0,
    })),
  };
}

export function hysteresisView(page: HysteresisPage): View {
  const rows = page.channels.map((c) => ({
    label: `${c.channel} over ${c.sensor}`,
    value: `r ${fixed(c.correlation, 2)}, ${fixed(c.spread_um, 1)} µm apart at one temperature`,
  }));
  const most = Math.max(...page.channels.map((c) => c.spread_um));
  return {
    product: 'Steadyrest thermal fit',
    title: page.title,
    facts: `<b>${page.channels.length}</b> displacements · <b>${plain(page.hours, 3)} h</b>`,
    verdict: `At one temperature a displacement differs by up to ${fixed(most, 1)} µm: a temperature alone does not tell it.`,
    body:
      section(
        'Displacement over temperature',
        `<div class="key-line" id="key-speeds"></div>${page.channels.map((_, i) => host(`channel-${i}`, 'high')).join('')}`,
        'Each displacement over the sensor that follows it best; one curve for each stretch of one spindle speed.',
      ) + section('Figures', figures(rows)),
    draw: (theme) => {
      page.channels.forEach((c, i) => plot(`channel-${i}`, channelPlot(page, c, theme), theme));
      const key = document.getElementById('key-speeds');
      if (key) {
        const all = speeds(page);
        key.innerHTML = keyLine(all.map((s) => ({ name: s > 0 ? `${fixed(s, 0)} rev/min` : 'standing', colour: colourOf(s, all, theme), kind: s > 0 ? ('line' as const) : ('dashed' as const) })));
      }
    },
  };
}
