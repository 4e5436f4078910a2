#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes plate.ngc (LinuxCNC): a plate of 160 x 100 mm, faced, pocketed and drilled in about eleven minutes.

Tool 1 faces at 2000 rpm, tool 2 mills a pocket and the outline at 6000 rpm, tool 3 drills at 4000 rpm: a cyclogram of
three transitions. Every approach in Z is a G0 with an absolute Z, where a correction may be written.

Usage: make_plate.py [FOLDER]   (default: the folder of this script)
"""
import pathlib
import sys


def facing():
    yield "(facing)"
    yield "T1 M6"
    yield "G43 H1"
    yield "S2000 M3"
    for row in range(5):
        y = 10.0 + 20.0 * row
        yield f"G0 X-30.000 Y{y:.3f}"
        yield "G0 Z2.000"
        yield "G1 Z0.000 F400"
        yield "G1 X190.000 F600"
        yield "G0 Z20.000"


def milling():
    yield "(pocket and outline)"
    yield "T2 M6"
    yield "G43 H2"
    yield "S6000 M3"
    for layer in range(1, 9):
        z = -0.75 * layer
        yield "G0 X80.000 Y50.000"
        yield "G0 Z2.000"
        yield f"G1 Z{z:.3f} F300"
        for ring in range(1, 6):
            dx, dy = 10.0 * ring, 6.0 * ring
            yield f"G1 X{80.0 - dx:.3f} Y{50.0 - dy:.3f} F1200"
            yield f"G1 X{80.0 + dx:.3f}"
            yield f"G1 Y{50.0 + dy:.3f}"
            yield f"G1 X{80.0 - dx:.3f}"
            yield f"G1 Y{50.0 - dy:.3f}"
        yield "G0 Z20.000"


def drilling():
    yield "(holes)"
    yield "T3 M6"
    yield "G43 H3"
    yield "S4000 M3"
    for column in range(5):
        for y in (8.0, 92.0):
            yield f"G0 X{12.0 + 34.0 * column:.3f} Y{y:.3f}"
            yield "G0 Z2.000"
            yield "G1 Z-16.000 F240"
            yield "G0 Z20.000"


def program():
    yield "(plate of 160 x 100 mm, written by make_plate.py)"
    yield from ("G17 G21 G90 G94", "G54", "G61", "G0 Z20.000")
    yield from facing()
    yield from milling()
    yield from drilling()
    yield from ("M5", "G0 Z50.000", "M2")


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent
    (folder / "plate.ngc").write_text("\n".join(program()) + "\n")
