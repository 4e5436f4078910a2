// SPDX-License-Identifier: Apache-2.0
// What every report.json begins with. `made` comes from steadyrest/apps/page/shared/provenance.hpp.

export type Maybe = number | null;

/** When a report was made, and from what. */
export interface Made {
  /** ISO 8601; null if left out so that the bytes repeat. */
  date: string | null;
  command: string;
  /** null: cannot be read twice (stdin). */
  inputs: { file: string; sha256: string | null }[];
}

export interface Head {
  schema: string;
  /** If a schema has several pages. */
  kind?: string;
  version: string;
  made?: Made;
}

/** By the schema of the data and, if a schema has several pages, by kind. */
export type ByPage<T> = Record<string, T | Record<string, T>>;

/** The page's data and what belongs to it in `known`, or a sentence that says why there is none. */
export function parsePage<T>(text: string, known: ByPage<T>): { head: Head; value: T } | string {
  let data: unknown;
  try {
    data = JSON.parse(text);
  } catch {
    return 'The data in this page is not valid JSON. Write the report again.';
  }
  if (typeof data !== 'object' || data === null) {
    return 'This page holds no data yet. Fill it with <code>steadyrest VERB … --report DIR</code>.';
  }
  const head = data as Head;
  const bySchema = own(known, head.schema);
  const value = typeof bySchema === 'object' ? own(bySchema, head.kind) : bySchema;
  if (value === undefined) {
    const name = [head.schema, head.kind].filter((part) => part !== undefined).join(', ');
    return `This page shows ${Object.keys(known).join(', ')}. Its data is ${name.replace(/[^\w./, -]/g, '')}.`;
  }
  return { head, value: value as T };
}

/** Skips what every object inherits, such as `constructor`. */
function own(of: unknown, key: unknown): unknown {
  return typeof of === 'object' && of !== null && typeof key === 'string' && Object.hasOwn(of, key) ? (of as Record<string, unknown>)[key] : undefined;
}
