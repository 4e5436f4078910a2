// SPDX-License-Identifier: Apache-2.0
// Labels beside dots, where they cover neither one another nor another dot.
import type { Dot } from './layers';
import { type Axis } from './axes';
import { heightOf } from './logarithmic';

/** The inside of the narrowest plot, px: a panel on paper. In a wider one there is only more room. */
const WIDE_PX = 240;
const HIGH_PX = 220;
const LINE_PX = 16;
const CHARACTER_PX = 6.6;
const GAP_PX = 8;

interface Box {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

const apart = (a: Box, b: Box) => a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;

type Place = Required<Pick<Dot, 'side' | 'lift'>>;

const PLACES: readonly Place[] = [0, 1, -1, 2, -2].flatMap((lines) => (['right', 'left'] as const).map((side) => ({ side, lift: lines * LINE_PX })));

function boxOf(x: number, y: number, label: string, { side, lift }: Place): Box {
  const width = label.length * CHARACTER_PX;
  const left = side === 'right' ? x + GAP_PX : x - GAP_PX - width;
  return { left, right: left + width, top: y - lift - LINE_PX / 2, bottom: y - lift + LINE_PX / 2 };
}

/** The dots with sides chosen in their order; `low`, `high`: the ends of the y axis as drawn. */
export function placed(dots: readonly Dot[], x: Required<Pick<Axis, 'min' | 'max'>>, y: Axis, low: number, high: number): Dot[] {
  const at = dots.map((d) => ({
    x: (WIDE_PX * (d.x - x.min)) / (x.max - x.min),
    y: (HIGH_PX * (high - (heightOf(y, d.y) as number))) / (high - low),
  }));
  const taken: Box[] = at.map((p) => ({ left: p.x - 4, right: p.x + 4, top: p.y - 4, bottom: p.y + 4 }));
  return dots.map((d, i) => {
    const here = at[i] ?? { x: 0, y: 0 };
    const label = d.label ?? '';
    const free = PLACES.find((place) => {
      const box = boxOf(here.x, here.y, label, place);
      return box.left >= 0 && box.right <= WIDE_PX && box.top >= 0 && box.bottom <= HIGH_PX && taken.every((t) => apart(t, box));
    });
    const place = free ?? { side: here.x > WIDE_PX / 2 ? 'left' : 'right', lift: 0 } as const;
    taken.push(boxOf(here.x, here.y, label, place));
    return { ...d, ...place };
  });
}
