#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes sine-edges.csv: what an encoder with counts of 0.001 mm and a clock of 10 MHz records of
x = A·(1 − cos 2πft) over one period. Line k is passed where x = k·0.001 mm."""

import math
import pathlib

A_MM, F_HZ, COUNT_MM, CLOCK_HZ = 0.15, 2.0, 0.001, 1e7


def main():
    lines = round(2 * A_MM / COUNT_MM) - 1
    up = [math.acos(1 - k * COUNT_MM / A_MM) / (2 * math.pi * F_HZ) for k in range(1, lines + 1)]
    rows = [(0.0, 0)] + [(t, k) for k, t in enumerate(up, start=1)]
    rows += [(1 / F_HZ - t, k - 1) for k, t in reversed(list(enumerate(up, start=1)))]
    rows.append((1 / F_HZ, 0))
    text = "# x = 0.15 mm (1 - cos(2 pi 2 Hz t)), counts of 0.001 mm, stamps of 100 ns\nt_s,count\n"
    for t_s, count in rows:
        text += f"{math.floor(t_s * CLOCK_HZ + 1e-6) / CLOCK_HZ:.7f},{count}\n"
    pathlib.Path(__file__).with_name("sine-edges.csv").write_text(text)


if __name__ == "__main__":
    main()
