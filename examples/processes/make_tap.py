#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes tap-922hz.csv: a tool's frequency response as a tap test gives it, 2 % of noise."""
import math
import random

random.seed(922)
with open("tap-922hz.csv", "w", encoding="ascii") as out:
    out.write("# tool tip, direction x: one mode of 922 Hz, 1.1 %, 0.03993 kg; made by make_tap.py\n")
    out.write("frequency_hz,real_um_N,imag_um_N\n")
    for f in range(400, 1601, 2):
        w, w0 = 2 * math.pi * f, 2 * math.pi * 922
        h = 1e6 / 0.03993 / complex(w0 * w0 - w * w, 2 * 0.011 * w0 * w)
        h += 0.02 * abs(h) * complex(random.gauss(0, 1), random.gauss(0, 1)) / math.sqrt(2)
        out.write(f"{f},{h.real:.6g},{h.imag:.6g}\n")
