// SPDX-License-Identifier: Apache-2.0
// The plan: the lobes, the alternatives on them, what was chosen, and why the others were not.
import { escapeHtml, section } from '../frame/html';
import { fixed, hertz, measure, percent, plain, rpm } from '../frame/numbers';
import { type Cell, numeric, table, valued } from '../frame/table';
import { type View, said } from '../frame/view';
import { host } from '../plot/plot';
import { type Alternative, type PlanPage, lawText } from './data';
import { LOBE_TERMS, type LobeView, STEP_TERM, drawLobes } from './lobes';

function isLaw(a: Alternative): boolean {
  return a.law !== 'constant';
}

export function choiceText(a: Alternative): string {
  return isLaw(a) ? lawText(a) : `${plain(a.override_percent[0] ?? 100)}\u00a0% = ${rpm(a.speed_rpm)}`;
}

/** If only laws were asked for, an override step may still help. */
export function nothing(a: PlanPage['answer']): string {
  const mm = `${plain(a.depth_mm)}\u00a0mm`;
  if (a.helping_override_percent !== null) {
    return `No speed law keeps ${mm} stable; a constant override of ${plain(a.helping_override_percent)}\u00a0% does.`;
  }
  const likely = a.likely_depth_mm !== null && a.likely_depth_mm > 0 ? ` Up to ${plain(a.likely_depth_mm, 3)}\u00a0mm is likely to be stable.` : '';
  return `No override step and no speed law keeps ${mm} stable.${likely}`;
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
      return nothing(a);
  }
}

/** What the programmed speed would do, and what the choice gains. */
function worth(page: PlanPage): string {
  const a = page.answer;
  const now = a.alternatives.find((o) => !isLaw(o) && Math.abs((o.override_percent[0] ?? 0) - 100) < 1e-9);
  const limit = (o: Alternative) => (o.limit_depth_mm === null ? '' : `the border is at ${measure(o.limit_depth_mm, 3, 'mm')}`);
  const share = (o: Alternative) => (o.probability === null ? '' : `${percent(o.probability, 0)} of the likely cuts are stable`);
  const hz = a.chatter_frequency_hz === null ? '' : ` at ${hertz(a.chatter_frequency_hz)}`;
  const at = now ? `At ${rpm(now.speed_rpm)} and ${plain(a.depth_mm)}\u00a0mm the cut chatters${hz}` : '';
  const chatters = now && a.decision !== 'keep' && !now.stable ? `${[at, limit(now)].filter(Boolean).join('; ')}.` : '';
  const gained = a.decision === 'nothing' ? '' : [limit(a), share(a)].filter(Boolean).join(' and ');
  return [chatters, gained === '' ? '' : `At ${choiceText(a)} ${gained}.`].filter(Boolean).join(' ');
}

function limitText(a: Alternative, most: number): string {
  return a.limit_depth_mm === null ? (a.stable ? `over ${plain(most)}` : '–') : fixed(a.limit_depth_mm, 3);
}

function alternatives(page: PlanPage): string {
  const most = page.answer.most_depth_mm;
  const chosen = choiceText(page.answer);
  const isTaken = (a: Alternative) => page.answer.decision !== 'nothing' && choiceText(a) === chosen;
  const rows = page.answer.alternatives.map((a): Cell[] => {
    const growth = a.peak_growth === null ? '–' : `${a.growth_is_lower_bound ? '≥ ' : ''}${plain(a.peak_growth, 3)}`;
    const why = a.reasons.length === 0 ? (isTaken(a) ? 'chosen' : 'would also do') : a.reasons.map(escapeHtml).join('<br>');
    return [
      choiceText(a), valued(limitText(a, most), a.limit_depth_mm ?? (a.stable ? most : null)),
      valued(a.probability === null ? '–' : fixed(100 * a.probability, 0), a.probability), valued(growth, a.peak_growth), { html: why },
    ];
  });
  return table({
    id: 'alternatives',
    sortable: true,
    columns: [{ head: 'Choice' }, numeric('Border, mm'), numeric('Stable cuts, %'), numeric('Growth'), { head: 'Verdict' }],
    rows,
    rowLook: (i) => (isTaken(page.answer.alternatives[i] as Alternative) ? 'chosen' : ''),
  });
}

function bestSpeeds(page: PlanPage): string {
  const { best_speeds, most_depth_mm } = page.answer;
  if (best_speeds.length === 0) {
    return '';
  }
  const depth = (mm: number | null): Cell => (mm === null ? valued(`over ${plain(most_depth_mm)}`, most_depth_mm) : fixed(mm, 3));
  return section(
    'Best spindle speeds',
    table({
      id: 'best-speeds',
      sortable: true,
      columns: [numeric('Speed, rpm'), numeric('Border, mm'), numeric('Border for all likely cuts, mm')],
      rows: best_speeds.map((b) => [fixed(b.speed_rpm, 0), depth(b.limit_depth_mm), depth(b.sure_depth_mm)]),
    }),
    'If you can change the program: the best speeds in the whole range of the spindle, best first.',
  );
}

export function planView(page: PlanPage): View {
  const a = page.answer;
  const chosen = a.decision !== 'nothing';
  const label = chosen ? (isLaw(a) ? `chosen: ${a.law}` : `chosen: ${plain(a.override_percent[0] ?? 100)} %`) : 'programmed';
  const view: LobeView = {
    lobes: page,
    perPass: true,
    wanted_mm: a.depth_mm,
    names: { border: 'border at constant speed, ρ = 1', marked: chosen ? 'the choice, at the requested depth' : 'the programmed speed' },
    marked: { speed_rpm: a.speed_rpm, depth_mm: a.depth_mm, label, stable: chosen },
  };
  return {
    product: 'Steadyrest chatter plan',
    title: page.process,
    facts: `<b>${escapeHtml(page.machine)}</b> · requested depth <b>${plain(a.depth_mm)} mm</b>`,
    verdict: `${headline(page)} ${worth(page)}`,
    body:
      said('notes', a.notes) +
      section('The choice on the stability lobes', host('lobes', 'tall'), 'Ticks along the top: the override steps that may be written.') +
      section('Alternatives', alternatives(page)) +
      bestSpeeds(page),
    explanation: [
      ...LOBE_TERMS,
      STEP_TERM,
      ['Stable cuts', 'The share of cuts that are stable there, when modes and forces scatter as the process file says (or as tap tests usually do).'],
      ['Best speeds', 'Ranked by the depth that stays stable although the mode frequencies are known only roughly. A speed right under a cusp is deep on paper but not in the shop.'],
      ['Growth', 'How many times a vibration can grow before it dies: within a period under a law, within the first tooth passes at constant speed. A dash: not computed, because the cut chatters.'],
    ],
    draw: (theme) => drawLobes(view, theme),
  };
}
