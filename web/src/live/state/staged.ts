// SPDX-License-Identifier: Apache-2.0
import type { KeyValue } from '../api/types';

const same = (a: KeyValue | undefined, b: KeyValue | undefined) => JSON.stringify(a) === JSON.stringify(b);

/** Changes of the machine file that wait to be looked at and applied: single keys, or the whole text. */
export class Staged {
  private readonly keys = new Map<string, KeyValue>();
  private whole: string | undefined;
  private readonly listeners = new Set<() => void>();

  get count(): number {
    return this.whole === undefined ? this.keys.size : 1;
  }

  get text(): string | undefined {
    return this.whole;
  }

  value(key: string): KeyValue | undefined {
    return this.keys.get(key);
  }

  /** Back at the value in force, a key is no longer staged. Single keys replace a staged text. */
  set(key: string, value: KeyValue, inForce: KeyValue): void {
    this.whole = undefined;
    if (same(value, inForce)) {
      this.keys.delete(key);
    } else {
      this.keys.set(key, value);
    }
    this.tell();
  }

  /** The whole text replaces staged keys. */
  setText(text: string, inForce: string): void {
    this.keys.clear();
    this.whole = text === inForce ? undefined : text;
    this.tell();
  }

  clear(): void {
    this.keys.clear();
    this.whole = undefined;
    this.tell();
  }

  /** As the server takes them. */
  request(): { changes: Record<string, KeyValue> } | { text: string } {
    return this.whole === undefined ? { changes: Object.fromEntries(this.keys) } : { text: this.whole };
  }

  /** Returns what ends it. */
  onChange(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  private tell(): void {
    this.listeners.forEach((listener) => listener());
  }
}
