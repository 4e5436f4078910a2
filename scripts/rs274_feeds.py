#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs programs and what `steadyrest program feeds` makes of them through LinuxCNC's interpreter `rs274` and compares the
paths.

    scripts/rs274_feeds.py [--steadyrest build/release/bin/steadyrest] [--data ../shared/data/nc]
                           [--linuxcnc /usr/share/linuxcnc …] [--table]

Every end point of the original is one of the changed program's, in order; between two of them the changed program stays on
the original's line or arc, and it cuts at no higher feed. `strip` restores the original. Needs `rs274` (Debian:
linuxcnc-uspace). Exit code 1 when one program disagrees.
"""
import math
import os
import sys

from rs274_compensate import calls, machine_moves
from rs274_walk import restores, run, walk, with_end

MAX_ERROR_MM = 0.01
MOST_PARTS = 400  # of one block
NEAR_MM = 6e-4  # rs274 prints four decimals, of up to four terms


def near(a, b, tolerance):
    return all(p is None or q is None or abs(p - q) <= tolerance for p, q in zip(a, b))


def off_line(point, start, end):
    way = [e - s for s, e in zip(start, end)]
    to = [p - s for s, p in zip(start, point)]
    length = math.hypot(*way)
    along = sum(w * t for w, t in zip(way, to)) / length if length else 0.0
    return math.sqrt(max(0.0, sum(t * t for t in to) - along * along))


def disagreement(original, changed):
    """'' or where the changed program's path is another. Parts shorter than the printed digits may belong to either of two
    moves: `places` has all that the moves so far can have come to."""
    places, last = {0}, [0.0, 0.0, 0.0]
    for index, (name, end, centre, digits) in enumerate(original):
        tolerance = digits + NEAR_MM
        reached, why = set(), "the changed program has ended"
        for at in places:
            for following in range(at, len(changed)):
                kind, point, other_centre, _ = changed[following]
                if kind != name:
                    why = f"{kind} instead of {name}"
                    break
                if centre is not None and not near(centre, other_centre, tolerance):
                    why = f"centre {other_centre} instead of {centre}"
                    break
                if near(end, point, tolerance):
                    reached.add(following + 1)
                elif name not in ("STRAIGHT_FEED", "ARC_FEED"):
                    why = f"{name} ends at {point} instead of {end}"
                    break
                if name == "STRAIGHT_FEED" and off_line(point, last, end) > tolerance:
                    why = f"{point} is not on the line"
                    break
                if following - at > MOST_PARTS:
                    break
        if not reached:
            return f"move {index}: {why}"
        places, last = reached, end
    return "" if len(changed) in places else f"{len(changed) - max(places)} moves more"


def feeds_of(listed):
    return [float(values) for name, values in listed if name == "SET_FEED_RATE"]


def judge(steadyrest, oracle, program, machine):
    """(kind, text): kind is not read, unchanged, wrong, or right"""
    oracle.fresh()
    folder = os.path.dirname(program)
    changed = oracle.path("changed.ngc")
    code, made = run(steadyrest, "feeds", program, "--max-error-mm", str(MAX_ERROR_MM), "-o", changed, "--dialect", "linuxcnc",
                     "--machine", machine, "--tools", oracle.path("tool.tbl"), "--data-units", "inch",
                     "--variables", oracle.path("my.var"), "--subprograms", folder)
    if code:
        what = made["refused"][0]["what"]
        # A file without M2 is read as if it had one.
        if "end it with M2" in what + made["refused"][0]["to_do"] and not program.endswith("ended.ngc"):
            return judge(steadyrest, oracle, with_end(oracle, program), machine)
        return ("wrong" if "not cut the same" in what else "not read"), what
    if not restores(steadyrest, oracle, changed, program):
        return "wrong", "strip does not restore it"
    if made["unchanged"]:
        return "unchanged", ""
    ok, before, _ = calls(oracle, program, folder)
    if not ok:
        return "not read", "rs274 refuses the original"
    if any(name.startswith("NURBS") for name, _ in before):
        return "not read", "splines, whose points rs274 does not print"
    ok, after, _ = calls(oracle, changed, folder)
    if not ok:
        return "wrong", "rs274 refuses the changed program"
    fault = disagreement(machine_moves(before), machine_moves(after))
    if not fault and max(feeds_of(after)) > max(feeds_of(before)) * 1.0001:
        fault = "a feed is above all of the original's"
    return ("wrong", fault) if fault else ("right", f"{len(machine_moves(before))} moves, {made['new_lines']} new lines")


if __name__ == "__main__":
    sys.exit(walk(__doc__, judge))
