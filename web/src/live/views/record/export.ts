// SPDX-License-Identifier: Apache-2.0
// A past run as a file: the record itself, or a table that the server writes.
import { h } from '../../shell/h';
import { t } from '../../texts/texts';

const NAMES: Readonly<Record<string, string>> = { sqlite: 'SQLite', csv: 'CSV', hdf5: 'HDF5' };

export interface ExportLinks {
  root: HTMLElement;
  /** What the server can write; nothing is offered before it has said so. */
  offer: (formats: readonly string[]) => void;
}

export function exportLinks(name: string): ExportLinks {
  const base = `/api/v1/records/${encodeURIComponent(name)}/export`;
  const links = h('div', { class: 'actions' });
  const root = h('div', { class: 'actions exports', hidden: true }, h('span', {}, t('export')), links, h('span', { class: 'hint' }, t('export_range')));
  return {
    root,
    offer: (formats) => {
      root.hidden = formats.length === 0;
      links.replaceChildren(
        ...formats.flatMap((format) => {
          const shown = NAMES[format];
          return shown === undefined ? [] : [h('a', { class: 'button', download: '', id: `export-${format}`, href: `${base}?format=${format}` }, shown)];
        }),
      );
    },
  };
}
