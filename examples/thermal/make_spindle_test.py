#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes spindle-test.csv: what spindle-test.ngc would log on a machine that is known.

Two modes (20 min, 2 um for each 1000 rpm; 110 min, 4.5 um) and the room (2 um/K, 60 min behind),
with noise of 0.3 um. The fit must find them again.
"""
import math
import random

STEPS = [(900, 0), (7200, 6000), (4500, 0), (3600, 3000), (2700, 0), (3600, 4500), (5400, 0)]
MODES = [(20 * 60.0, 2.0), (110 * 60.0, 4.5)]
ROW_S = 30

random.seed(1)
speed = [n for seconds, n in STEPS for _ in range(seconds // ROW_S)]
x = [0.0, 0.0]
lagged = None
with open("spindle-test.csv", "w") as out:
    out.write("time_s,spindle_rpm,z_um,room_c\n")
    for i, n in enumerate(speed):
        t = i * ROW_S
        room = 20.0 + 1.2 * math.sin(t / 9000.0) + 0.00004 * t + 0.1 * math.sin(t / 700.0)
        lagged = room if lagged is None else lagged
        z = sum(x) + 2.0 * (lagged - 20.0) + random.gauss(0.0, 0.3)
        out.write(f"{t},{n},{z:.2f},{room + random.gauss(0.0, 0.02):.2f}\n")
        x = [n / 1000.0 * g + (v - n / 1000.0 * g) * math.exp(-ROW_S / tau)
             for v, (tau, g) in zip(x, MODES)]
        lagged = room + (lagged - room) * math.exp(-ROW_S / 3600.0)
