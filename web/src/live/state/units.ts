// SPDX-License-Identifier: Apache-2.0
// Lengths and feeds in the viewer's units: mm and µm, or inch and mil (0.001 in).
import type { Maybe } from '../../frame/data';
import { fixed, measure } from '../../frame/numbers';
import { type TextKey, t } from '../texts/texts';
import type { Units } from './settings';

const MM_PER_INCH = 25.4;
/** The same figure twice: µm in a thousandth of an inch. */
const UM_PER_MIL = 25.4;

export interface Unit {
  name: string;
  decimals: number;
  /** From mm, µm or mm/min. */
  of: (value: number) => number;
  /** And back. */
  back: (value: number) => number;
}

/** Its name is in the viewer's language. */
const same = (key: TextKey, decimals: number): Unit => ({
  get name() {
    return t(key);
  },
  decimals,
  of: (v) => v,
  back: (v) => v,
});
const per = (name: string, decimals: number, by: number): Unit => ({ name, decimals, of: (v) => v / by, back: (v) => v * by });

interface UnitSet {
  length: Unit;
  small: Unit;
  feed: Unit;
  acceleration: Unit;
}

const SETS: Record<Units, UnitSet> = {
  mm: { length: same('mm', 3), small: same('um', 1), feed: same('mm_min', 0), acceleration: same('mm_s2', 0) },
  inch: { length: per('in', 4, MM_PER_INCH), small: per('mil', 3, UM_PER_MIL), feed: per('ipm', 1, MM_PER_INCH), acceleration: per('in/s²', 1, MM_PER_INCH) },
};

let chosen = SETS.mm;

export function chooseUnits(units: Units): void {
  chosen = SETS[units];
}

export const units = (): UnitSet => chosen;

const shown = (unit: Unit, value: Maybe | undefined) => measure(value === null || value === undefined ? null : unit.of(value), unit.decimals, unit.name);

export const small = (um: Maybe | undefined) => shown(chosen.small, um);
export const length = (mm: Maybe | undefined) => shown(chosen.length, mm);
export const feed = (mm_min: Maybe | undefined) => shown(chosen.feed, mm_min);
export const acceleration = (mm_s2: Maybe | undefined) => shown(chosen.acceleration, mm_s2);

/** Without the unit. */
export function figure(unit: Unit, value: Maybe | undefined): string {
  return fixed(value === null || value === undefined ? null : unit.of(value), unit.decimals);
}
