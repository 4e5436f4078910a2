#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes slot-chatter.csv: the vibration of a slot cut by two teeth at 5000 rpm as a sensor of 5 kHz
has it. The teeth force three orders; from 0.6 s on chatter at 940 Hz grows to its full size within
some 0.05 s. The noise is a linear congruential generator's."""

import math
import pathlib

RATE_HZ, LENGTH_S, SPEED_RPM, TEETH = 5000, 1.2, 5000, 2
CHATTER_HZ, START_S, GROWTH_S = 940.0, 0.6, 0.02


def main():
    tooth_hz = TEETH * SPEED_RPM / 60
    state = 1
    text = ("# made by make_slot_chatter.py: forced vibration of 2 teeth at 5000 rpm, chatter of 940 Hz"
            " from 0.6 s on, noise\nt_s,value,speed_rpm\n")
    for i in range(round(RATE_HZ * LENGTH_S)):
        t_s = i / RATE_HZ
        state = (1664525 * state + 1013904223) % 2**32
        value = 0.1 * (2 * state / 2**32 - 1)
        for order, size in ((1, 1.0), (2, 0.5), (3, 0.25)):
            value += size * math.sin(2 * math.pi * order * tooth_hz * t_s + order)
        if t_s > START_S:
            since = t_s - START_S
            value += 3.0 * (1 - math.exp(-since / GROWTH_S)) * math.sin(2 * math.pi * CHATTER_HZ * since)
        text += f"{t_s:.4f},{value:.3f},{SPEED_RPM}\n"
    pathlib.Path(__file__).with_name("slot-chatter.csv").write_text(text)


if __name__ == "__main__":
    main()
