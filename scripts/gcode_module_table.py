#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares `steadyrest program moves` with LinuxCNC's interpreter through its Python module `gcode`, which hands over doubles
where `rs274` prints four decimals.

    scripts/gcode_module_table.py [--steadyrest build/release/bin/steadyrest] [--data ../shared/data/nc] [FILES …]

Each program runs in a process of its own under the Python that LinuxCNC is built for (/usr/bin/python3). Without a tool
table: every tool has length and diameter 0 on both sides. A program that changes tools crashes the module when no LinuxCNC
runs beside it; those are left to `rs274_table.py`. Exit code 1 when a coordinate differs by more than 1e-6 mm
or 1e-6 degrees, 77 where the module is absent.
"""
import csv
import json
import os
import subprocess
import sys
import tempfile

from nc_programs import add_folders, dialect_of, programs, sample, script_parser

TOLERANCE = 1e-6  # mm, degrees
LINUXCNC_PYTHON = "/usr/bin/python3"

WORKER = r"""
import json, os, sys, gcode
os.chdir(os.path.dirname(sys.argv[1]))

class Canon:
    parameter_file = sys.argv[2]
    def __init__(self):
        self.moves = []
    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return lambda *values: None
    def get_axis_mask(self): return 0x1ff
    def get_external_length_units(self): return 1.0
    def get_external_angular_units(self): return 1.0
    def get_block_delete(self): return 0
    def check_abort(self): return False
    def get_tool(self, pocket): return (max(pocket, 0),) + (0.0,) * 12 + (0,)
    def straight_traverse(self, *v): self.moves.append(("rapid",) + v)
    def straight_feed(self, *v): self.moves.append(("linear",) + v)
    def straight_probe(self, *v): self.moves.append(("probe",) + v)
    def rigid_tap(self, *v): self.moves.append(("tap",) + v)
    def arc_feed(self, *v): self.moves.append(("arc",) + v)
    def set_plane(self, plane): self.moves.append(("plane", plane))
    def dwell(self, seconds): self.moves.append(("dwell", seconds))

canon = Canon()
result, line = gcode.parse(sys.argv[1], canon, "G21", "")
print(json.dumps({"accepted": result <= gcode.MIN_ERROR, "error": "" if result <= gcode.MIN_ERROR else gcode.strerror(result), "moves": canon.moves}))
"""

INCH = 25.4


def theirs(program, folder):
    """What the module makes of a program: (accepted, calls, message)."""
    variables = os.path.join(folder, "module.var")
    open(variables, "w").close()
    done = subprocess.run([LINUXCNC_PYTHON, "-c", WORKER, program, variables], capture_output=True, text=True, timeout=120,
                          env={**os.environ, "HOME": folder})
    answers = [line for line in done.stdout.splitlines() if line.startswith('{"accepted"')]
    if done.returncode != 0 or not answers:
        return None
    answer = json.loads(answers[-1])
    return answer["accepted"], answer["moves"], answer["error"]


def ends(moves):
    """(kind, [x y z a b c], [centre first, second] or None, turns, plane) with lengths in mm; the module hands over inches."""
    plane = 1
    for name, *values in moves:
        if name == "plane":
            plane = values[0]
        elif name == "dwell":
            yield "dwell", None, None, None, plane
        elif name == "arc":
            first, second, c1, c2, turns, height, a, b, c = values[:9]
            axes = {1: (0, 1, 2), 2: (1, 2, 0), 3: (2, 0, 1)}[plane]
            end = [0.0] * 6
            end[axes[0]], end[axes[1]], end[axes[2]] = first * INCH, second * INCH, height * INCH
            end[3:] = [a, b, c]
            yield "arc", end, {axes[0]: c1 * INCH, axes[1]: c2 * INCH}, turns, plane
        elif name == "tap":
            yield "thread", [value * INCH for value in values[:3]] + [None] * 3, None, None, plane
        else:
            yield name, [value * INCH for value in values[:3]] + list(values[3:6]), None, None, plane


def difference(moves, rows):
    """'' or the first difference. A spline is handed over as chords that end where ours does."""
    given = list(ends(moves))
    at = 0
    worst = 0.0
    skip_back = False
    for row in rows:
        if at and given[at - 1][0] == "probe":
            # Only the machine knows where a probe stops: the module assumes the programmed end, rs274 (like ours) a
            # place 0.254 mm before it. Only rs274_table.py compares what follows.
            return "", worst
        mine = [float(row[k]) for k in ("x_mm", "y_mm", "z_mm", "a_deg", "b_deg", "c_deg")]
        if skip_back:  # out again after a rigid tap: one call there
            skip_back = False
            continue
        if at == len(given):
            return f"line {row['line']}: the module has only {len(given)} moves", worst
        kind, end, centre, turns, _ = given[at]
        at += 1
        if row["kind"] == "dwell":
            if kind != "dwell":
                return f"line {row['line']}: {kind} there, dwell here", worst
            continue
        if row["kind"] == "spline":
            while max(abs(a - b) for a, b in zip(end, mine)) > TOLERANCE and at < len(given) and given[at][0] == "linear":
                kind, end, centre, turns, _ = given[at]
                at += 1
        skip_back = kind == "thread"
        here = {"thread": "linear"}.get(row["kind"], row["kind"])
        if kind != here and not (kind == "linear" and here == "spline") and kind != "thread":
            return f"line {row['line']}: {kind} there, {here} here", worst
        for a, b in zip(end, mine):
            if a is not None:
                worst = max(worst, abs(a - b))
                if abs(a - b) > TOLERANCE:
                    return f"line {row['line']}: {a!r} there, {b!r} here", worst
        for axis, value in (centre or {}).items():
            worst = max(worst, abs(value - float(row["ijk"[axis] + "_mm"])))
            if abs(value - float(row["ijk"[axis] + "_mm"])) > TOLERANCE:
                return f"line {row['line']}: centre {value!r} there", worst
        if turns is not None and turns != int(row["turns"]):
            return f"line {row['line']}: {turns} turns there", worst
    if at != len(given):
        return f"the module has {len(given)} moves, ours end at {at}", worst
    return "", worst


def main():
    parser = script_parser(__doc__)
    add_folders(parser)
    parser.add_argument("--most", type=int, help="only so many short programs")
    parser.add_argument("files", nargs="*")
    arguments = parser.parse_args()
    probe = subprocess.run([LINUXCNC_PYTHON, "-c", "import gcode"], capture_output=True) if os.path.exists(LINUXCNC_PYTHON) else None
    if probe is None or probe.returncode != 0:
        print("LinuxCNC's Python module gcode is not installed (Debian: linuxcnc-uspace)")
        return 77
    found = arguments.files or sample(
        [p for p in list(programs([arguments.data])) + list(programs(arguments.linuxcnc))
         if dialect_of(p) == "linuxcnc"], arguments.most)
    seen, compared, moves, worst, bad, alone = set(), 0, 0, 0.0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for program in map(os.path.abspath, found):
            content = open(program, "rb").read()
            if content in seen:
                continue
            seen.add(content)
            table = os.path.join(folder, "ours.csv")
            done = subprocess.run([arguments.steadyrest, "program", "moves", program, "--dialect", "linuxcnc", "--axes", "XYZABCUVW", "-o", table, "--json"],
                                  capture_output=True, timeout=120)
            if done.returncode != 0:
                continue
            result = theirs(program, folder)
            if result is None or not result[0]:
                alone += 1
                if arguments.files:
                    print("alone:", program, result and result[2])
                continue
            with open(table) as source:
                rows = list(csv.DictReader(source))
            verdict, most = difference(result[1], rows)
            worst = max(worst, most)
            compared += 1
            moves += len(rows)
            if verdict:
                bad += 1
                print("DISAGREES", program, verdict)
    print(f"{compared} programs, {moves} moves, {bad} disagree; the largest difference is {worst:.1e} mm "
          f"({alone} more change tools: there the module needs a running LinuxCNC)")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
