// SPDX-License-Identifier: Apache-2.0

export interface Box {
  left: number;
  right: number;
  bottom: number;
  top: number;
}

/** Widens the box so that one unit is as long across as up in an area of this size. */
export function withEqualAspect(box: Box, width_px: number, height_px: number): Box {
  const margin = 1.06;
  const smallest = 1e-3;
  const wide = Math.max(box.right - box.left, smallest) * margin;
  const high = Math.max(box.top - box.bottom, smallest) * margin;
  const per_px = Math.max(wide / width_px, high / height_px);
  const x = (box.left + box.right) / 2;
  const y = (box.bottom + box.top) / 2;
  const half = { x: (per_px * width_px) / 2, y: (per_px * height_px) / 2 };
  return { left: x - half.x, right: x + half.x, bottom: y - half.y, top: y + half.y };
}
