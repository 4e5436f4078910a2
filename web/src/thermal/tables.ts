// SPDX-License-Identifier: Apache-2.0
import { table } from '../frame/table';

/** A table of figures: the first column names the row. */
export function named(id: string, head: readonly string[], rows: readonly (readonly string[])[]): string {
  return table({ id, columns: head.map((h, i) => ({ head: h, number: i > 0 })), rows });
}
