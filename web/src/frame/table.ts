// SPDX-License-Identifier: Apache-2.0
// The one table of all pages. On a narrow screen each row turns into a block of labelled cells (table.css).
import type { Maybe } from './data';
import { escapeHtml } from './html';

export interface Column {
  head: string;
  /** Aligned right, with digits of equal width. */
  number?: boolean;
  /** A head over this column and its neighbours of the same group. */
  group?: string;
}

/** Text, or HTML with a key to sort by (null: always last). */
export type Cell = string | { html: string; sort?: number | string | null; look?: string };

export interface Table {
  id: string;
  columns: readonly Column[];
  /** The first cell of each row names it. */
  rows: readonly (readonly Cell[])[];
  rowLook?: (index: number) => string;
  /** By a click on a column head. */
  sortable?: boolean;
  /** The column that the rows come sorted by, largest first. */
  sorted?: number;
  caption?: string;
}

const look = (names: readonly (string | undefined | false)[]) => {
  const all = names.filter(Boolean).join(' ');
  return all === '' ? '' : ` class="${all}"`;
};

function head({ columns, sortable, sorted }: Table): string {
  const grouped = columns.some((c) => c.group !== undefined);
  const over: { name: string; span: number }[] = [];
  for (const c of columns) {
    const last = over.at(-1);
    if (last && last.name === (c.group ?? '')) last.span += 1;
    else over.push({ name: c.group ?? '', span: 1 });
  }
  const groups = grouped ? `<tr class="groups">${over.map((g) => `<th colspan="${g.span}">${escapeHtml(g.name)}</th>`).join('')}</tr>` : '';
  const cells = columns.map((c, i) => {
    const order = i === sorted ? ' aria-sort="descending"' : '';
    const text = escapeHtml(c.head);
    return `<th scope="col"${look([c.number && 'n', startsGroup(columns, i) && 'first'])}${order}>${sortable && c.head !== '' ? `<button type="button" class="sort">${text}</button>` : text}</th>`;
  });
  return `<thead>${groups}<tr>${cells.join('')}</tr></thead>`;
}

const startsGroup = (columns: readonly Column[], i: number) => i > 0 && columns[i]?.group !== columns[i - 1]?.group;

function cell(table: Table, value: Cell, i: number): string {
  const column = table.columns[i] ?? { head: '' };
  const { html, sort, look: own } = typeof value === 'string' ? { html: escapeHtml(value), sort: undefined, look: undefined } : value;
  const label = [column.group, column.head].filter(Boolean).join(', ');
  const by = sort === undefined ? '' : ` data-sort="${sort === null ? '' : escapeHtml(String(sort))}"`;
  const attributes = `${look([column.number && 'n', startsGroup(table.columns, i) && 'first', own])} data-label="${escapeHtml(label)}"${by}`;
  return i === 0 ? `<th scope="row"${attributes}><span>${html}</span></th>` : `<td${attributes}><span>${html}</span></td>`;
}

/** Tables of more columns are set closer, */
const MANY = 9;
/** and those of no more than these fit on a phone. */
const FEW = 4;

export function table(what: Table): string {
  const rows = what.rows.map((r, k) => `<tr${look([what.rowLook?.(k)])}>${r.map((c, i) => cell(what, c, i)).join('')}</tr>`);
  const caption = what.caption === undefined ? '' : `<caption>${what.caption}</caption>`;
  const width = what.columns.length > MANY ? ' many' : what.columns.length <= FEW ? ' few' : '';
  return `<table id="${what.id}" class="data${width}">${caption}${head(what)}<tbody>${rows.join('')}</tbody></table>`;
}

/** A column of numbers. */
export const numeric = (head: string, group?: string): Column => ({ head, number: true, ...(group === undefined ? {} : { group }) });

/** A number as shown, sorted by its value. */
export const valued = (html: string, sort: Maybe): Cell => ({ html, sort });

/** A table of numbers whose first column names the row. */
export function numbers(id: string, heads: readonly string[], rows: readonly (readonly Cell[])[]): string {
  return table({ id, columns: heads.map((head, i) => (i === 0 ? { head } : numeric(head))), rows });
}

/** A name, and its value as HTML. */
export interface Figure {
  label: string;
  value: string;
}

export function figures(rows: readonly Figure[]): string {
  return numbers('figures', ['', ''], rows.map((r) => [r.label, { html: r.value }]));
}

function keyOf(row: HTMLTableRowElement, column: number): number | string | undefined {
  const at = row.cells[column];
  const text = at?.dataset['sort'] ?? at?.textContent?.trim() ?? '';
  const value = Number(text.replace(/[\s]/g, '').replace('−', '-'));
  return text === '' || text === '–' ? undefined : Number.isFinite(value) ? value : text;
}

/** Sorts by a column; rows without a value stay last. */
function sortRows(body: HTMLTableSectionElement, column: number, descending: boolean): void {
  const sign = descending ? -1 : 1;
  const rows = [...body.rows].map((row) => ({ row, key: keyOf(row, column) }));
  rows.sort((a, b) => {
    if (a.key === undefined || b.key === undefined) return Number(a.key === undefined) - Number(b.key === undefined);
    if (typeof a.key === 'number' && typeof b.key === 'number') return sign * (a.key - b.key);
    return sign * String(a.key).localeCompare(String(b.key));
  });
  body.append(...rows.map((r) => r.row));
}

/** A click on a head sorts: numbers from the largest, text from A. A second click reverses the order. */
export function onSort(root: HTMLElement): void {
  root.addEventListener('click', (event) => {
    const head = (event.target as HTMLElement).closest('button.sort')?.closest('th');
    const body = head?.closest('table')?.tBodies[0];
    if (!head || !body) {
      return;
    }
    const numbers = head.classList.contains('n');
    const now = head.getAttribute('aria-sort');
    const descending = now === null ? numbers : now === 'ascending';
    head.closest('tr')?.querySelectorAll('th').forEach((h) => h.removeAttribute('aria-sort'));
    head.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
    sortRows(body, head.cellIndex, descending);
  });
}
