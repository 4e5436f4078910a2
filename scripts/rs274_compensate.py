#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs programs and what `steadyrest program compensate` makes of them through LinuxCNC's interpreter `rs274` and
compares the machine's positions.

    scripts/rs274_compensate.py [--steadyrest build/release/bin/steadyrest] [--data ../shared/data/nc]
                                [--linuxcnc /usr/share/linuxcnc …] [--table]

Every program gets corrections of Z by 50, 100 and 70 um at a quarter, a half and three quarters of its time. Machine
positions are put together from what rs274 prints: coordinates, work offset, G92 and tool length. They must differ by the
correction that stands, on Z alone; the variable file after the run must be that of the original. Needs `rs274`
(Debian: linuxcnc-uspace). Exit code 1 when one program disagrees.
"""
import argparse
import collections
import json
import os
import re
import subprocess
import sys

from rs274_table import CALL, MM_PER_INCH, Oracle, dialect_of, numbers, programs, short

STEPS_UM = (50.0, 50.0, -30.0)
MOVES = ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED", "STRAIGHT_PROBE", "RIGID_TAP")


def calls(oracle, program, folder):
    """`folder` is where its subprograms are. (accepted, canonical calls, variables after the run)"""
    oracle.fresh()
    done = subprocess.run([oracle.rs274, "-g", "-t", oracle.path("tool.tbl"), "-v", oracle.path("my.var"), program],
                          stdin=subprocess.DEVNULL, capture_output=True, timeout=120, cwd=folder,
                          env={**os.environ, "HOME": oracle.folder})
    found = [CALL.match(line) for line in done.stdout.decode("latin-1").splitlines()]
    variables = {}
    with open(oracle.path("my.var")) as source:
        for line in source:
            parts = line.split()
            if len(parts) == 2:
                variables[int(parts[0])] = float(parts[1])
    return done.returncode == 0, [(call.group(1), call.group(2)) for call in found if call], variables


def machine_moves(listed):
    """Each move as (name, (x, y, z) in machine mm, centre or None, digits in mm)."""
    unit, plane = 1.0, "XY"
    offsets = {"SET_G5X_OFFSET": [0.0] * 3, "SET_G92_OFFSET": [0.0] * 3, "USE_TOOL_LENGTH_OFFSET": [0.0] * 3}
    moves, restated = [], False
    for name, values in listed:
        if name == "USE_LENGTH_UNITS":
            unit = MM_PER_INCH if "INCHES" in values else 1.0
        elif name == "SELECT_PLANE":
            plane = values[-2:]
        elif name in offsets:
            at = 1 if name == "SET_G5X_OFFSET" else 0
            offsets[name] = [value * unit for value in numbers(values)[at:at + 3]]
        elif name == "COMMENT" and "STEADYREST restated" in values:
            restated = True
        elif name in MOVES:
            printed = numbers(values)
            shift = [sum(one[i] for one in offsets.values()) for i in range(3)]
            centre = None
            if name == "ARC_FEED":
                first, second, normal = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}[plane]
                end, centre = [0.0] * 3, [None] * 3
                end[first], end[second], end[normal] = printed[0], printed[1], printed[5]
                centre[first] = printed[2] * unit + shift[first]
                centre[second] = printed[3] * unit + shift[second]
            else:
                end = printed[:3]
            if not restated:
                # Coordinate and up to three offsets, each rounded to four decimals, in both programs.
                moves.append((name, [end[i] * unit + shift[i] for i in range(3)], centre, 4.0 * 1e-4 * unit))
            restated = False
    return moves


def disagreement(original, changed, totals_mm, may_leave):
    """'' or how the changed program's machine goes otherwise."""
    if len(original) != len(changed):
        return f"{len(original)} moves became {len(changed)}"
    wanted, stands = list(totals_mm), 0.0
    for index, (before, after) in enumerate(zip(original, changed)):
        where = f"move {index + 1}"
        if before[0] != after[0]:
            return f"{where}: {before[0]} became {after[0]}"
        digit = before[3]
        for axis in (0, 1):
            if abs(after[1][axis] - before[1][axis]) > digit:
                return f"{where}: {'xy'[axis]} differs by {after[1][axis] - before[1][axis]:.4f}"
        shift = after[1][2] - before[1][2]
        while wanted and abs(shift - stands) > digit and not (may_leave and abs(shift) <= digit):
            stands = wanted.pop(0)
        if abs(shift - stands) > digit and not (may_leave and abs(shift) <= digit):
            return f"{where}: z differs by {shift:.4f}; {stands:.4f} stands"
        if before[2]:
            for axis in range(3):
                if before[2][axis] is not None:
                    off = after[2][axis] - before[2][axis] - (shift if axis == 2 else 0.0)
                    if abs(off) > digit:
                        return f"{where}: centre {'xyz'[axis]} differs by {off:.4f}"
    return f"corrections that never act: {wanted}" if wanted else ""


def run(steadyrest, *arguments):
    done = subprocess.run([steadyrest, "program", *arguments, "--json"], capture_output=True, timeout=300)
    return done.returncode, json.loads(done.stdout)


def judge(steadyrest, oracle, program, machine):
    """(kind, text): kind is ours, rs274, wrong, or right"""
    oracle.fresh()
    folder = os.path.dirname(program)
    common = ["--dialect", "linuxcnc", "--machine", machine, "--tools", oracle.path("tool.tbl"), "--data-units", "inch",
              "--subprograms", folder]
    code, time = run(steadyrest, "time", program, *common)
    if code and time["refused"][0].get("reason") == "no_program_end":  # a file without M2 is read as if it had one
        ended = oracle.path("ended.ngc")
        with open(program, "rb") as source, open(ended, "wb") as out:
            out.write(source.read() + b"\nM2\n")
        program = ended
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
    stripped = oracle.path("stripped.ngc")
    run(steadyrest, "strip", changed, "-o", stripped)
    with open(stripped, "rb") as one, open(program, "rb") as other:
        if one.read() != other.read():
            return "wrong", "strip does not restore it"
    ok, before, left_before = calls(oracle, program, folder)
    if not ok:
        return "not read", "rs274 refuses the original"
    ok, after, left_after = calls(oracle, changed, folder)
    if not ok:
        return "wrong", "rs274 refuses the changed program"
    totals = [one["total_um"] * 1e-3 for one in made["insertions"]]
    with open(program, errors="replace") as source:
        may_leave = re.search(r"(?i)G0*(53|28|30)(?!\d)", source.read()) is not None
    fault = disagreement(machine_moves(before), machine_moves(after), totals, may_leave)
    if fault:
        return "wrong", fault
    for number in sorted(set(left_before) | set(left_after)):
        if abs(left_before.get(number, 0.0) - left_after.get(number, 0.0)) > 1e-6:
            return "wrong", f"leaves #{number} at {left_after.get(number)} instead of {left_before.get(number)}"
    return "right", f"{len(machine_moves(before))} moves, {made['proved_moves']} proved"


def main():
    root = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steadyrest", default=os.path.join(root, "build/release/bin/steadyrest"))
    parser.add_argument("--rs274", default="rs274")
    data = os.environ.get("STEADYREST_SHARED_DATA")
    parser.add_argument("--data", default=os.path.join(data, "nc") if data else os.path.join(root, "../shared/data/nc"))
    parser.add_argument("--linuxcnc", nargs="*", default=["/usr/share/linuxcnc", "/usr/share/doc/linuxcnc"])
    parser.add_argument("--machine", default=os.path.join(root, "examples/machines/linuxcnc-mill.toml"))
    parser.add_argument("--table", action="store_true", help="print every program, not only those that disagree")
    arguments = parser.parse_args()
    try:
        subprocess.run([arguments.rs274, "--help"], capture_output=True, timeout=20)
    except FileNotFoundError:
        print("rs274 is not installed: skipped")
        return 77
    folders = [folder for folder in (arguments.data, os.path.join(root, "examples/programs"),
                                     os.path.join(root, "tests/accepted/nc"), *arguments.linuxcnc) if os.path.isdir(folder)]
    oracle = Oracle(arguments.rs274)
    counts, reasons = collections.Counter(), collections.Counter()
    for program in programs(folders):
        program = os.path.abspath(program)
        if dialect_of(program) != "linuxcnc":
            continue
        kind, text = judge(arguments.steadyrest, oracle, program, arguments.machine)
        counts[kind] += 1
        if kind.startswith("not"):
            reasons[f"{kind}: {re.sub(r'[0-9.]+', '#', text)}"] += 1
        if kind == "wrong" or arguments.table:
            print(f"{kind:16} {short(program, root)}: {text}", flush=True)
    oracle.close()
    for reason, count in reasons.most_common():
        print(f"{count:5} {reason}")
    print(", ".join(f"{count} {kind}" for kind, count in sorted(counts.items())))
    return 1 if counts["wrong"] or not counts["right"] else 0


if __name__ == "__main__":
    sys.exit(main())
