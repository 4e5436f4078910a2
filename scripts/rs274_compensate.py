#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs programs and what `steadyrest program compensate` makes of them through LinuxCNC's interpreter `rs274` and
compares the machine's positions.

    scripts/rs274_compensate.py [--steadyrest build/release/bin/steadyrest] [--data ../shared/data/nc]
                                [--linuxcnc /usr/share/linuxcnc …] [--table]

Every program gets corrections of Z by 50, 100 and 70 um at a quarter, a half and three quarters of its time. Machine
positions are put together from what rs274 prints: coordinates, work offset, G92 and tool length. They must differ by the
correction in force, on Z alone; the variable file after the run must be that of the original. Needs `rs274`
(Debian: linuxcnc-uspace). Exit code 1 when one program disagrees.
"""
import json
import math
import os
import re
import subprocess
import sys

from rs274_oracle import CALL, MM_PER_INCH, numbers
from rs274_walk import restores, run, walk, with_end

STEPS_UM = (50.0, 50.0, -30.0)
MOVES = ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED", "STRAIGHT_PROBE", "RIGID_TAP")


def calls(oracle, program, folder, block_delete=False):
    """`folder` is where its subprograms are. (accepted, canonical calls, what is left behind: numbers of the variable file and
    words of the tool table)"""
    oracle.fresh()
    done = subprocess.run([oracle.rs274, "-g", *(["-b"] if block_delete else []), "-t", oracle.path("tool.tbl"),
                           "-v", oracle.path("my.var"), program],
                          stdin=subprocess.DEVNULL, capture_output=True, timeout=120, cwd=folder,
                          env={**os.environ, "HOME": oracle.folder})
    found = [CALL.match(line) for line in done.stdout.decode("latin-1").splitlines()]
    left = {}
    with open(oracle.path("my.var")) as source:
        for line in source:
            parts = line.split()
            if len(parts) == 2:
                left["#" + parts[0]] = float(parts[1])
    with open(oracle.path("tool.tbl")) as source:
        for line in source:
            words = re.findall(r"([A-Z])\s*([-+]?[\d.]+)", line.split(";")[0])
            left.update({f"T{dict(words).get('T')} {letter}": float(value) for letter, value in words})
    return done.returncode == 0, [(call.group(1), call.group(2)) for call in found if call], left


def trace(before, after):
    """'' or what the changed program leaves behind otherwise."""
    for name in sorted(set(before) | set(after)):
        if abs(before.get(name, 0.0) - after.get(name, 0.0)) > 2e-6:  # six decimals
            return f"leaves {name} at {after.get(name)} instead of {before.get(name)}"
    return ""


def turned(point, degrees):
    """About Z; None stays None."""
    if not degrees or None in point[:2]:
        return point
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return [c * point[0] - s * point[1], s * point[0] + c * point[1], point[2]]


def machine_moves(listed):
    """Each move as (name, (x, y, z) in machine mm, centre or None, digits in mm): turned(work + G92) + G5x + tool."""
    unit, coarsest, plane, rotation = 1.0, 1.0, "XY", 0.0
    offsets = {"SET_G5X_OFFSET": [0.0] * 3, "SET_G92_OFFSET": [0.0] * 3, "USE_TOOL_LENGTH_OFFSET": [0.0] * 3}
    moves, restated = [], False

    def machine(point):
        shifted = [None if value is None else value * unit + offsets["SET_G92_OFFSET"][i] for i, value in enumerate(point)]
        return [None if value is None else value + offsets["SET_G5X_OFFSET"][i] + offsets["USE_TOOL_LENGTH_OFFSET"][i]
                for i, value in enumerate(turned(shifted, rotation))]

    for name, values in listed:
        if name == "USE_LENGTH_UNITS":
            unit = MM_PER_INCH if "INCHES" in values else 1.0
            coarsest = max(coarsest, unit)  # offsets keep their printed digits
        elif name == "SELECT_PLANE":
            plane = values[-2:]
        elif name == "SET_XY_ROTATION":
            rotation = float(values)
        elif name in offsets:
            at = 1 if name == "SET_G5X_OFFSET" else 0
            offsets[name] = [value * unit for value in numbers(values)[at:at + 3]]
        elif name == "COMMENT" and "STEADYREST restated" in values:
            restated = True
        elif name in MOVES:
            printed = numbers(values)
            centre = None
            if name == "ARC_FEED":
                first, second, normal = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}[plane]
                end, centre = [0.0] * 3, [None] * 3
                end[first], end[second], end[normal] = printed[0], printed[1], printed[5]
                centre[first], centre[second] = printed[2], printed[3]
                centre = machine(centre)
            else:
                end = printed[:3]
            if not restated:
                # Coordinate and up to three offsets, each rounded to four decimals, in both programs.
                moves.append((name, machine(end), centre, (4.01 if not rotation else 6.01) * 1e-4 * coarsest))
            restated = False
    return moves


def disagreement(original, changed, totals_mm, may_leave, to_its_end=True):
    """'' or how the changed program's machine goes otherwise. `totals_mm`: by axis 0 … 2, the correction from each step on. The last
    move may be in the line that ends the program: it is then made without a correction."""
    if len(original) != len(changed):
        return f"{len(original)} moves became {len(changed)}"
    wanted, stands, digit = {axis: list(totals) for axis, totals in totals_mm.items()}, [0.0] * 3, 0.0
    for index, (before, after) in enumerate(zip(original, changed)):
        where = f"move {index + 1}"
        if before[0] != after[0]:
            return f"{where}: {before[0]} became {after[0]}"
        digit = before[3]
        shift = [after[1][axis] - before[1][axis] for axis in range(3)]
        for axis in range(3):
            left = (may_leave or index + 1 == len(original)) and abs(shift[axis]) <= digit
            while wanted.get(axis) and abs(shift[axis] - stands[axis]) > digit and not left:
                stands[axis] = wanted[axis].pop(0)
            if abs(shift[axis] - stands[axis]) > digit and not left:
                return f"{where}: {'xyz'[axis]} differs by {shift[axis]:.4f}; {stands[axis]:.4f} stands"
            if before[2] and before[2][axis] is not None:
                off = after[2][axis] - before[2][axis] - shift[axis]
                if abs(off) > digit:
                    return f"{where}: centre {'xyz'[axis]} differs by {off:.4f}"
    # A total within the digits of the correction in force, or of zero, cannot be told from it.
    never = {axis: totals for axis, totals in wanted.items()
             if totals and min(abs(totals[-1] - stands[axis]), abs(totals[-1])) > 2 * digit}
    return f"corrections that never act: {never}" if never and to_its_end else ""


def totals_of(insertions):
    """By axis 0 … 2, the correction from each place on, mm; steps that share a place are one."""
    totals = {}
    for one in insertions:
        totals.setdefault("XYZ".index(one["axis"]), {})[one["original_line"]] = one["total_um"] * 1e-3
    return {axis: list(by_line.values()) for axis, by_line in totals.items()}


def judge(steadyrest, oracle, program, machine):
    """(kind, text): kind is ours, rs274, wrong, or right"""
    oracle.fresh()
    folder = os.path.dirname(program)
    common = ["--dialect", "linuxcnc", "--machine", machine, "--tools", oracle.path("tool.tbl"), "--data-units", "inch",
              "--variables", oracle.path("my.var"), "--subprograms", folder]
    code, time = run(steadyrest, "time", program, *common)
    if code and time["refused"][0].get("reason") == "no_program_end":  # a file without M2 is read as if it had one
        program = with_end(oracle, program)
        code, time = run(steadyrest, "time", program, *common)
    if code or time.get("refused"):
        return "not read", time["refused"][0].get("reason", time["refused"][0].get("what", ""))
    if time["seconds"] <= 0.0:
        return "not compensated", "the program takes no time"
    quarter = time["seconds"] / 4.0 / 60.0
    with open(oracle.path("plan.json"), "w") as out:
        json.dump({"transitions": [{"n": 4, "t_min": [quarter] * 4, "delta_um": [0.0, *STEPS_UM]}]}, out)
    changed = oracle.path("changed.ngc")
    code, made = run(steadyrest, "compensate", program, "--plan", oracle.path("plan.json"), "-o", changed, *common)
    if code:
        return "not compensated", made["refused"][0]["what"]
    if not restores(steadyrest, oracle, changed, program):
        return "wrong", "strip does not restore it"
    ok, before, left_before = calls(oracle, program, folder)
    if not ok:
        return "not read", "rs274 refuses the original"
    ok, after, left_after = calls(oracle, changed, folder)
    if not ok:
        return "wrong", "rs274 refuses the changed program"
    with open(program, errors="replace") as source:
        may_leave = re.search(r"(?i)G0*(53|28|30)(?!\d)", source.read()) is not None
    fault = disagreement(machine_moves(before), machine_moves(after), totals_of(made["insertions"]), may_leave) or trace(left_before, left_after)
    if fault:
        return "wrong", fault
    return "right", f"{len(machine_moves(before))} moves, {made['proved_moves']} proved"


if __name__ == "__main__":
    sys.exit(walk(__doc__, judge))
