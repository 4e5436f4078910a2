// SPDX-License-Identifier: Apache-2.0
// What every report.json begins with; steadyrest/apps/page/shared/provenance.hpp is the source of `made`.

export type Maybe = number | null;

/** When and out of what a report was made. */
export interface Made {
  /** ISO 8601; null where it was left out so that bytes repeat. */
  date: string | null;
  command: string;
  /** null: could not be read twice (stdin). */
  inputs: { file: string; sha256: string | null }[];
}

export interface Head {
  schema: string;
  version: string;
  made?: Made;
}

/** The data in the page, or a sentence that says why there are none. */
export function parsePage(text: string, schemas: readonly string[]): Head | string {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return 'The data in this page is not valid JSON; write the report again.';
  }
  if (typeof value !== 'object' || value === null) {
    return 'This page holds no data yet; <code>steadyrest VERB … --report DIR</code> fills it.';
  }
  const page = value as Head;
  return schemas.includes(page.schema) ? page : `This page reads ${schemas.join(', ')}; its data is ${String(page.schema).replace(/[^\w./-]/g, '')}.`;
}
