// SPDX-License-Identifier: Apache-2.0
// The plan: lobes, the alternatives in them, what was chosen and why the others were not.
import { fixed } from '../format';
import { escapeHtml } from '../page';
import { type Alternative, type PlanPage, lawText } from './data';
import { type View, plain, section } from './frame';
import { type LobeView, drawLobes, lobeHosts } from './lobes';

function isLaw(a: Alternative): boolean {
  return a.law !== 'constant';
}

export function choiceText(a: Alternative): string {
  return isLaw(a) ? lawText(a) : `${plain(a.override_percent[0] ?? 100)} % = ${fixed(a.speed_rpm, 0)} rev/min`;
}

function headline(page: PlanPage): string {
  const a = page.answer;
  const choice = choiceText(a);
  switch (a.decision) {
    case 'keep':
      return `Keep the programmed speed: ${choice}.`;
    case 'constant':
      return `Set the spindle override to ${choice}.`;
    case 'law':
      return `Modulate the spindle speed: ${choice}.`;
    case 'nothing':
      return `Nothing helps at ${plain(a.depth_mm)} mm${a.likely_depth_mm === null ? '' : `; ${plain(a.likely_depth_mm, 3)} mm would be likely enough`}.`;
  }
}

function limitText(a: Alternative, most: number): string {
  return a.limit_depth_mm === null ? (a.stable ? `over ${plain(most)}` : '–') : fixed(a.limit_depth_mm, 3);
}

function table(page: PlanPage): string {
  const most = page.answer.most_depth_mm;
  const chosen = choiceText(page.answer);
  const row = (a: Alternative) => {
    const growth = a.peak_growth === null ? '–' : `${a.growth_is_lower_bound ? '≥ ' : ''}${plain(a.peak_growth, 3)}`;
    const taken = page.answer.decision !== 'nothing' && choiceText(a) === chosen;
    const why = a.reasons.length === 0 ? (taken ? 'chosen' : 'would do') : a.reasons.map(escapeHtml).join('<br>');
    return `<tr${taken ? ' class="chosen"' : ''}><td class="n">${choiceText(a)}</td><td class="n">${limitText(a, most)}</td>
      <td class="n">${a.probability === null ? '–' : fixed(100 * a.probability, 0)}</td><td class="n">${growth}</td><td>${why}</td></tr>`;
  };
  return `<div class="wide"><table id="alternatives"><thead><tr><th class="n">choice</th><th class="n">border, mm</th><th class="n">stable cuts, %</th>
    <th class="n">growth</th><th>verdict</th></tr></thead><tbody>${page.answer.alternatives.map(row).join('')}</tbody></table></div>`;
}

export function planView(page: PlanPage): View {
  const a = page.answer;
  const chosen = a.decision !== 'nothing';
  const label = chosen ? (isLaw(a) ? `chosen: ${a.law}` : `chosen: ${plain(a.override_percent[0] ?? 100)} %`) : 'programmed';
  const view: LobeView = {
    lobes: page,
    perPass: true,
    wanted_mm: a.depth_mm,
    marked: { speed_rpm: a.speed_rpm, depth_mm: a.depth_mm, label, stable: chosen },
  };
  const notes = a.notes.map((n) => `<p class="hint">${escapeHtml(n)}</p>`).join('');
  return {
    product: 'Steadyrest chatter plan',
    title: page.process,
    facts: `<b>${escapeHtml(page.machine)}</b> · wanted <b>${plain(a.depth_mm)} mm</b>`,
    verdict: headline(page),
    body: section('The choice in the stability lobes', lobeHosts(), 'Ticks above: the override steps that may be written.') + section('Alternatives', table(page) + notes),
    draw: (theme) => drawLobes(view, theme, { border: 'border at constant speed, ρ = 1', marked: chosen ? 'what was chosen, at the wanted depth' : 'the programmed speed' }),
  };
}
