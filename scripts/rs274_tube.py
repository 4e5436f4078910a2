#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs examples and what `steadyrest program predistort` makes of them through LinuxCNC's interpreter `rs274`, and compares
how far the paths are apart with what `steadyrest program verify` has proved.

    scripts/rs274_tube.py [--steadyrest build/release/bin/steadyrest]

Dense points of either path, from the lines and arcs that rs274 prints: the farthest from the other path is what verify says,
to the points' spacing, and within the tube. Needs `rs274` (Debian: linuxcnc-uspace). Exit code 1 when one disagrees.
"""
import collections
import itertools
import math
import os
import sys

from nc_programs import ROOT
from rs274_compensate import calls
from rs274_oracle import Oracle, installed, numbers, oracle_parser
from rs274_walk import MACHINE, run

PROGRAMS = ("circle-r10.ngc", "rib-pocket.ngc")
MOST_MM = "1"  # shift: the circle needs more than the usual 0.5 mm
FINE_MM = 0.02
COARSE_MM = 0.1
APART_MM = 0.002  # of the figures: half of a fine step over a chord of the farthest, and four printed digits
ALONG, ALONG_MM = 0.05, 10.0  # of the whole way, or so much
CELL_MM = 1.2
SAME_MM = 2e-4  # start and end to the printed digits: a whole turn


def arc_points(start, values, step):
    x, y, centre_x, centre_y, turn, z = values[:6]
    begin = math.atan2(start[1] - centre_y, start[0] - centre_x)
    sweep = math.atan2(y - centre_y, x - centre_x) - begin
    radius = math.dist(start[:2], (centre_x, centre_y))
    same = SAME_MM / max(radius, SAME_MM)
    while turn > 0 and sweep <= same:
        sweep += 2 * math.pi
    while turn < 0 and sweep >= -same:
        sweep -= 2 * math.pi
    sweep += math.copysign(2 * math.pi * (abs(turn) - 1), turn)
    grown = math.dist((x, y), (centre_x, centre_y)) - radius
    parts = max(2, math.ceil(abs(sweep) * radius / step))
    for i in range(parts + 1):
        share = i / parts
        at, angle = radius + share * grown, begin + share * sweep
        yield (centre_x + at * math.cos(angle), centre_y + at * math.sin(angle), start[2] + share * (z - start[2]))


def points(listed, step):
    """Of all feed moves."""
    out, at = [], [0.0, 0.0, 0.0]
    for name, text in listed:
        values = numbers(text)
        if name == "ARC_FEED":
            out += arc_points(at, values, step)
            at = [values[0], values[1], values[5]]
        elif name in ("STRAIGHT_FEED", "STRAIGHT_TRAVERSE"):
            end = values[:3]
            if name == "STRAIGHT_FEED":
                parts = max(1, math.ceil(math.dist(at, end) / step))
                out += [tuple(a + (e - a) * i / parts for a, e in zip(at, end)) for i in range(parts + 1)]
            at = end
    return out


def way(path):
    """How far along the whole way each point is, mm; and the whole."""
    out = [0.0]
    for a, b in itertools.pairwise(path):
        out.append(out[-1] + math.dist(a, b))
    return out, out[-1]


def farthest(of, path):
    """The largest distance of these points from the nearest of the path's, as far as a cell and about as far along the way:
    the way out of a circle passes the way in."""
    (passed, whole), (passed_there, whole_there) = way(of), way(path)
    cells = collections.defaultdict(list)
    for point, at in zip(path, passed_there):
        cells[tuple(int(c // CELL_MM) for c in point)].append((point, at))
    apart, longer = max(ALONG_MM, ALONG * whole_there), whole_there / whole if whole > 0.0 else 0.0
    worst = 0.0
    for point, at_mm in zip(of, passed):
        home = [int(c // CELL_MM) for c in point]
        near = (cells.get(tuple(h + d for h, d in zip(home, by)), ()) for by in itertools.product((-1, 0, 1), repeat=3))
        beside = (math.dist(point, other) for other, at in itertools.chain(*near) if abs(at - longer * at_mm) <= apart)
        worst = max(worst, min(beside, default=math.inf))
    return worst


def answer(steadyrest, *arguments):
    code, made = run(steadyrest, *arguments)
    if code:
        sys.exit(f"steadyrest program {' '.join(arguments)}: {made['refused']}")
    return made


def main():
    parser = oracle_parser(__doc__)
    parser.add_argument("--machine", default=MACHINE)
    parser.add_argument("--most", type=int, default=len(PROGRAMS), help="programs; the first is the shortest")
    arguments = parser.parse_args()
    if not installed(arguments.rs274):
        return 77
    oracle, wrong = Oracle(arguments.rs274), 0
    for name in PROGRAMS[: arguments.most]:
        oracle.fresh()
        program, changed = os.path.join(ROOT, "examples/programs", name), oracle.path("changed.ngc")
        answer(arguments.steadyrest, "predistort", program, "--machine", arguments.machine, "--max-shift-mm", MOST_MM, "-o", changed)
        proof = answer(arguments.steadyrest, "verify", program, changed)
        listed = [calls(oracle, path, os.path.dirname(program))[1] for path in (program, changed)]
        out = [farthest(points(listed[1], COARSE_MM), points(listed[0], FINE_MM)),
               farthest(points(listed[0], COARSE_MM), points(listed[1], FINE_MM))]
        right = max(out) <= proof["tube_mm"] + APART_MM and abs(max(out) - proof["farthest_mm"]) <= APART_MM
        wrong += not right
        print(f"{'right' if right else 'WRONG'} {name}: {out[0]:.4f} mm and back {out[1]:.4f} mm; "
              f"proved {proof['farthest_mm']:.4f} mm in a tube of {proof['tube_mm']:g} mm")
    oracle.close()
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
