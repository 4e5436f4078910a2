// SPDX-License-Identifier: Apache-2.0
// Can the required resolution of velocity and acceleration be met? One table for each choice of its five buttons.
import { onChoice, put } from '../frame/dom';
import { buttons, section } from '../frame/html';
import { digits, short } from '../frame/numbers';
import { type Cell, numeric, table } from '../frame/table';
import type { Bench, Requirement } from './data';

type Judge = 'guaranteed' | 'typical';
interface Choice {
  acceleration: boolean;
  fine: boolean;
  judge: Judge;
  jerk_mm_s3: number;
  cycle_hz: number;
}

const same = (a: number, b: number) => Math.abs(a - b) <= 1e-9 * Math.abs(b);
const different = (values: readonly number[]) => [...new Set(values)].sort((a, b) => a - b);

function cell(row: Requirement | undefined, judge: Judge): Cell {
  if (!row) {
    return '';
  }
  const [value, least] = judge === 'guaranteed' ? [row.bound, row.guaranteed_floor] : [row.rms, row.optimum];
  const verdict = row[judge];
  const title = `${verdict}: ${digits(value)}, required ${digits(row.required)}, least possible ${digits(least)}`;
  return { html: `<b title="${title}">${digits(value, 2)}</b><small>${digits(least, 2)}</small>`, look: `verdict ${verdict}` };
}

function requirementTable(bench: Bench, choice: Choice): string {
  const rows = bench.requirement.filter(
    (r) => r.acceleration === choice.acceleration && r.fine === choice.fine && same(r.jerk_mm_s3, choice.jerk_mm_s3) && same(r.cycle_hz, choice.cycle_hz),
  );
  const lines = different(rows.map((r) => r.line_error_counts));
  const clocks = different(rows.map((r) => r.clock_s));
  const unit = choice.acceleration ? 'mm/s²' : 'mm/s';
  const group = (line: number) => (line === 0 ? 'ideal lines' : `line error ${short(100 * line)} % of a count (RMS)`);
  return table({
    id: 'requirement-table',
    caption: `Required: <b>${digits(rows[0]?.required)} ${unit}</b>. Large: ${choice.judge === 'guaranteed' ? 'proven bound' : 'RMS error'}; small: the least that physics permits, ${unit}.`,
    columns: [numeric('Speed'), ...lines.flatMap((l) => clocks.map((c) => numeric(`${(c * 1e9).toFixed(0)} ns`, group(l))))],
    rows: different(rows.map((r) => r.speed_mm_s)).map((v) => [
      `${digits(v)} mm/s`,
      ...lines.flatMap((l) => clocks.map((c) => cell(rows.find((r) => r.speed_mm_s === v && r.line_error_counts === l && r.clock_s === c), choice.judge))),
    ]),
  });
}

function controls(bench: Bench, choice: Choice): string {
  const values = (all: number[], unit: string): [string, string][] => different(all).map((v) => [String(v), `${v} ${unit}`]);
  return [
    buttons('quantity', 'Quantity', [['v', 'Velocity'], ['a', 'Acceleration']], choice.acceleration ? 'a' : 'v'),
    buttons('end', 'End of the required range', [['coarse', 'Coarse end'], ['fine', 'Fine end']], choice.fine ? 'fine' : 'coarse'),
    buttons('judge', 'Judged by', [['typical', 'RMS error'], ['guaranteed', 'Guaranteed bound']], choice.judge),
    buttons('jerk', 'Jerk limit', values(bench.requirement.map((r) => r.jerk_mm_s3), 'mm/s³'), String(choice.jerk_mm_s3)),
    buttons('cycle', 'Control cycle', values(bench.requirement.map((r) => r.cycle_hz), 'Hz'), String(choice.cycle_hz)),
  ].join('');
}

const HINT = `Required: 1·10⁻⁵ … 3·10⁻⁶ mm/tick and 1·10⁻⁵ … 1·10⁻⁶ mm/tick², at a count of 0.001 mm and constant speed with the limits known.
  <span class="sample met">met</span> <span class="sample forbidden">forbidden by physics</span> <span class="sample missed">missed</span>`;

/** Its section of the page, and what its buttons do; nothing if the bench did not run it. */
export function requirement(bench: Bench): { html: string; bind: () => void } {
  if (bench.requirement.length === 0) {
    return { html: '', bind: () => undefined };
  }
  const choice: Choice = { acceleration: false, fine: false, judge: 'typical', jerk_mm_s3: 5000, cycle_hz: 1000 };
  const fill = () => put('requirement', requirementTable(bench, choice));
  const on = (id: string, set: (value: string) => void) =>
    onChoice(id, (value) => {
      set(value);
      fill();
    });
  return {
    html: section('The requirement: met, forbidden, missed', `<div class="controls">${controls(bench, choice)}</div><div id="requirement"></div>`, HINT),
    bind: () => {
      on('quantity', (v) => (choice.acceleration = v === 'a'));
      on('end', (v) => (choice.fine = v === 'fine'));
      on('judge', (v) => (choice.judge = v as Judge));
      on('jerk', (v) => (choice.jerk_mm_s3 = Number(v)));
      on('cycle', (v) => (choice.cycle_hz = Number(v)));
      fill();
    },
  };
}
