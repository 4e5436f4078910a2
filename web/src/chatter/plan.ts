// SPDX-License-Identifier: Apache-2.0
// The plan: lobes, the alternatives in them, what was chosen and why the others were not.
import { escapeHtml, section } from '../frame/html';
import { fixed, plain } from '../frame/numbers';
import { type Cell, table } from '../frame/table';
import { type View, said } from '../frame/view';
import { host } from '../plot/plot';
import { type Alternative, type PlanPage, lawText } from './data';
import { LOBE_TERMS, type LobeView, STEP_TERM, drawLobes } from './lobes';

function isLaw(a: Alternative): boolean {
  return a.law !== 'constant';
}

export function choiceText(a: Alternative): string {
  return isLaw(a) ? lawText(a) : `${plain(a.override_percent[0] ?? 100)} % = ${fixed(a.speed_rpm, 0)} rev/min`;
}

/** With laws alone asked for a step may help all the same. */
export function nothing(a: PlanPage['answer']): string {
  const mm = `${plain(a.depth_mm)} mm`;
  if (a.helping_override_percent !== null) {
    return `No speed law keeps ${mm} stable; a constant override of ${plain(a.helping_override_percent)} % would.`;
  }
  const likely = a.likely_depth_mm !== null && a.likely_depth_mm > 0 ? ` Up to ${plain(a.likely_depth_mm, 3)} mm is likely to be.` : '';
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

const LIKELY = 'of the likely cuts are stable';

/** What the programmed speed would do, and what is gained. */
function worth(page: PlanPage): string {
  const a = page.answer;
  const now = a.alternatives.find((o) => !isLaw(o) && Math.abs((o.override_percent[0] ?? 0) - 100) < 1e-9);
  const limit = (o: Alternative) => (o.limit_depth_mm === null ? '' : `the border is at ${fixed(o.limit_depth_mm, 3)} mm`);
  const share = (o: Alternative) => (o.probability === null ? '' : `${fixed(100 * o.probability, 0)} % ${LIKELY}`);
  const hz = a.chatter_frequency_hz === null ? '' : ` at ${fixed(a.chatter_frequency_hz, 1)} Hz`;
  const at = now ? `At ${fixed(now.speed_rpm, 0)} rev/min and ${plain(a.depth_mm)} mm the cut chatters${hz}` : '';
  const chatters = now && a.decision !== 'keep' && !now.stable ? `${[at, limit(now)].filter(Boolean).join('; ')}.` : '';
  const gained = a.decision === 'nothing' ? '' : [limit(a), share(a)].filter(Boolean).join(' and ');
  return [chatters, gained === '' ? '' : `With ${choiceText(a)} ${gained}.`].filter(Boolean).join(' ');
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
    const why = a.reasons.length === 0 ? (isTaken(a) ? 'chosen' : 'would do') : a.reasons.map(escapeHtml).join('<br>');
    return [
      choiceText(a), { html: limitText(a, most), sort: a.limit_depth_mm ?? (a.stable ? most : null) },
      { html: a.probability === null ? '–' : fixed(100 * a.probability, 0), sort: a.probability }, { html: growth, sort: a.peak_growth }, { html: why },
    ];
  });
  const number = (head: string) => ({ head, number: true });
  return table({
    id: 'alternatives',
    sortable: true,
    columns: [{ head: 'choice' }, number('border, mm'), number('stable cuts, %'), number('growth, times'), { head: 'verdict' }],
    rows,
    rowLook: (i) => (isTaken(page.answer.alternatives[i] as Alternative) ? 'chosen' : ''),
  });
}

function bestSpeeds(page: PlanPage): string {
  const { best_speeds, most_depth_mm } = page.answer;
  if (best_speeds.length === 0) {
    return '';
  }
  const number = (head: string) => ({ head, number: true });
  const depth = (mm: number | null): Cell => (mm === null ? { html: `over ${plain(most_depth_mm)}`, sort: most_depth_mm } : fixed(mm, 3));
  return section(
    'Best speeds of the spindle',
    table({
      id: 'best-speeds',
      sortable: true,
      columns: [number('rev/min'), number('border, mm'), number('border of all likely cuts, mm')],
      rows: best_speeds.map((b) => [fixed(b.speed_rpm, 0), depth(b.limit_depth_mm), depth(b.sure_depth_mm)]),
    }),
    'To be programmed, where the program may be changed: between the least and the greatest speed of the spindle, the best first.',
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
    names: { border: 'border at constant speed, ρ = 1', marked: chosen ? 'what was chosen, at the wanted depth' : 'the programmed speed' },
    marked: { speed_rpm: a.speed_rpm, depth_mm: a.depth_mm, label, stable: chosen },
  };
  return {
    product: 'Steadyrest chatter plan',
    title: page.process,
    facts: `<b>${escapeHtml(page.machine)}</b> · wanted <b>${plain(a.depth_mm)} mm</b>`,
    verdict: `${headline(page)} ${worth(page)}`,
    body:
      said('notes', a.notes) +
      section('The choice in the stability lobes', host('lobes', 'tall'), 'Ticks above: the override steps that may be written.') +
      section('Alternatives', alternatives(page)) +
      bestSpeeds(page),
    explanation: [
      ...LOBE_TERMS,
      STEP_TERM,
      ['Stable cuts', 'Of cuts whose modes and forces scatter as the process file says (or as tap tests usually do), the share that is stable there.'],
      ['Best speeds', 'Ranked by the depth that is stable although the frequencies of the modes are known to some per cent only: a speed just under a cusp is deep on paper and not in the shop.'],
      ['Growth', 'How many times a vibration may grow on its way before it dies: under a law within a period, at constant speed within the first tooth passes. A dash: it is not asked of a cut that chatters.'],
    ],
    draw: (theme) => drawLobes(view, theme),
  };
}
