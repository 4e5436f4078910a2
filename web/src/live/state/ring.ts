// SPDX-License-Identifier: Apache-2.0

/** Rows of numbers in a fixed memory; the newest overwrite the oldest. A missing value is NaN. */
export class Ring<Name extends string> {
  private readonly columns: Record<Name, Float64Array>;
  private next = 0;
  private count = 0;

  constructor(
    names: readonly Name[],
    readonly capacity: number,
  ) {
    this.columns = Object.fromEntries(names.map((n) => [n, new Float64Array(capacity)])) as Record<Name, Float64Array>;
  }

  get size(): number {
    return this.count;
  }

  clear(): void {
    this.next = this.count = 0;
  }

  push(row: Readonly<Record<Name, number>>): void {
    for (const name in this.columns) {
      this.columns[name][this.next] = row[name];
    }
    this.next = (this.next + 1) % this.capacity;
    this.count = Math.min(this.count + 1, this.capacity);
  }

  /** 0 is the oldest row; NaN outside. */
  at(name: Name, i: number): number {
    if (i < 0 || i >= this.count) {
      return NaN;
    }
    return this.columns[name][(this.next - this.count + i + this.capacity) % this.capacity] as number;
  }

  newest(name: Name): number {
    return this.at(name, this.count - 1);
  }

  /** The first row whose value is not below `limit`; the column must not fall. */
  from(name: Name, limit: number): number {
    let [low, high] = [0, this.count];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.at(name, middle) < limit) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    return low;
  }
}
