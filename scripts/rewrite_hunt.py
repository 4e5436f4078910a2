#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random programs in all dialects through every verb that rewrites one: what a verb writes with exit 0, `program verify`
accepts, and `strip` turns back into the original, byte for byte; with any other exit the target is as it was.

    scripts/rewrite_hunt.py [--steadyrest build/release/bin/steadyrest] [--seed 1] [--count 200] [--jobs 2] [--rs274 rs274] [--keep DIR]

Programs change work offsets, rotations, G52, G92, tool lengths, distance and path modes between and within cuts, lean on modal
motion and feed, go through subprograms and loops, and have lines that the operator can skip. Where rs274 is installed, LinuxCNC's
interpreter reads original and changed program too: the machine's path stays within the tube, and kept rapids end where they
ended. A verb that refuses is counted; one that fails otherwise (exit 1, a signal) is a fault. Exit code 1 when one is found.
"""
import collections
import concurrent.futures
import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

from nc_programs import ROOT
from rs274_compensate import calls, turned
from rs274_oracle import MM_PER_INCH, Oracle, numbers, oracle_parser
from rs274_tube import arc_points, farthest

MACHINES = {"linuxcnc": "linuxcnc-mill.toml", "fanuc": "vmc-840d.toml", "sinumerik": "vmc-840d.toml"}
PROCESS = os.path.join(ROOT, "examples/processes/slot-922hz.toml")
STEP_MM, NEAR_MM = 0.05, 0.02
TIMEOUT_S = 120


def n(r, low=-20.0, high=20.0):
    return r.choice((f"{r.uniform(low, high):.3f}", f"{r.uniform(low, high):.1f}", f"{r.randint(int(low), int(high))}."))


class Maker:
    """A program that a control would most likely accept; block by block."""

    def __init__(self, r, dialect):
        self.r, self.dialect, self.lines = r, dialect, []

    def axes(self, letters="XY", share=0.7):
        return " ".join(letter + n(self.r) for letter in letters if self.r.random() < share) or "X" + n(self.r)

    def cut(self):
        r = self.r
        word = r.choice(("G1 ", "G1 ", "G1 ", "", "", ""))
        feed = r.choice(("", "", "", f" F{r.choice((80, 300, 900, 2000, 4000))}"))
        kind = r.random()
        if kind < 0.6:
            return word + self.axes("XYZ" if r.random() < 0.2 else "XY") + feed
        if kind < 0.85:  # a quarter or half circle, that closes whatever the start is: incremental centre and end by G91
            i, turn = r.uniform(3, 25), r.choice(("G2", "G3"))
            return f"G91\n{turn} X{2 * i:.3f} Y0 I{i:.3f} J0{feed}\nG90"
        return f"{r.choice(('G2', 'G3'))} I{r.choice((4, 12, -9))}. J0{feed}"

    def other(self):
        r, dialect = self.r, self.dialect
        x = lambda *span: n(r, *span)
        common = [f"G91 X{x(-5, 5)}\nG90", f"G91 G1 X{x(-5, 5)} Y{x(-5, 5)}\nG90", f"G90 X{x()}", f"G1 G90 Y{x()}", "G4 P0.1" if dialect != "sinumerik" else "G4 F0.1",
                  f"G0 X{x()} Y{x()}\nG1 Z0 F500", f"G0 Z5.\nG0 X{x()}\nG1 Z{x(-2, 0)} F300", f"G0 Z5.\nX{x()} Y{x()}\nG1 Z0 F900", "M8", "M9",
                  f"G54 X{x()}", f"G55\nG0 X{x()} Y{x()} Z1.\nG1 Z0 F400\nG54\nG0 X{x()} Y{x()}\nG1 Z0 F400", "", f"S{r.choice((500, 2500, 9000, 90000))} M3", f"F{r.choice((100, 1500))}", "G9 X" + x(), f"G40 Y{x()}", f"G40 G1 X{x()}"]
        if dialect == "linuxcnc":
            common += [f"G10 L2 P{r.choice((0, 1, 1, 2))} R{r.choice((0, 15, 71, -90))}", f"G10 L2 P{r.choice((0, 1, 2))} X{x(-9, 9)}", f"G10 L20 P{r.choice((0, 1))} {r.choice('XYZ')}{x(-9, 9)}",
                       f"G10 L2 P0 X{x(-5, 5)} R{r.choice((0, 30, 71))}", f"G52 {self.axes('XY')}", "G52 X0 Y0 Z0", f"G92 {self.axes('XYZ', 0.5)}", "G92.1", "G92.2", "G92.3", f"G43.1 Z{x(0, 3)}", "G49",
                       f"T{r.randint(1, 5)} M6\nG43\nS3000 M3\nG0 X{x()} Y{x()}\nG1 Z0 F600", f"G10 L1 P{r.randint(1, 5)} Z{x(0, 9)} R{x(0, 9)}", f"G10 L10 P{r.randint(1, 5)} Z{x(0, 9)}", f"G53 X{x()} Y{x()}",
                       f"G53 G0 X{x()} Y{x()}\nG1 X{x()} F500", f"G64 P{r.choice((0.01, 0.05, 1))} X{x()}", "G61", "G61.1", "G64", f"G61 Y{x()}", f"G43 X{x()}", f"G17 X{x()}", f"G94 X{x()} F700", "M70\nG91\nM72", "M73",
                       f"o{r.randint(100, 999)} repeat [2]\nG91 G1 X2. F400\nG90\nendrepeat", f"/G1 X{x()}", f"/G1 F{r.randint(50, 2000)}", f"#1={x()}\nG1 X#1 F800", f"G41.1 D2 G1 X{x(30, 40)} Y{x()} F500\nG1 X60. Y30.\nG40",
                       f"G81 X{x()} Y{x()} Z-1. R1. F300\nG80\nG1 X{x()} F500", f"G91.1 G2 I3. J0", "G20 G1 X0.5 F20\nG21 F500", f"(MSG, x)", "G93 G1 X5. F2\nG94 F500", "G28 Z9.", f"M3 X{x()}", f"M0\nX{x()}", f"G54 G53 G0 Z1.\nG1 X{x()} Z0 F500", "G51.5",
                       f"G18\nG1 X{x()} Z{x(-2, 2)}\nG17", f"G5 I0 J-3 P0 Q-3 X{x()} Y{x()}\nG1 X{x()} F500"]
        elif dialect == "fanuc":
            common += [f"G53 X{x()} Y{x()}\nG1 X{x()}", f"G10 L2 P{r.choice((0, 1, 2))} X{x(-9, 9)} Y{x(-9, 9)}", f"G52 {self.axes('XY')}\nG0 X{x()} Y{x()}\nG1 Z0 F500", "G52 X0 Y0 Z0", f"G92 X{x()} Y{x()}", f"G43 H1\nG0 Z5.\nG1 Z0 F500", "G49\nG0 Z5.\nG1 Z0 F300", f"G91 G28 Z0\nG90\nG0 Z5.\nG1 Z0 F600",
                       f"G81 X{x()} Y{x()} Z-1. R1. F300\nG80\nG1 X{x()} F500", f"/G1 X{x()}", f"#100={x()}\nG1 X#100 F800", f"G61 X{x()}", f"G64 Y{x()}", f"G17 X{x()}", f"G94 X{x()}", "M98 P77", f"G41 D1 X{x(30, 40)}\nG40"]
        else:
            common += [f"TRANS X{x(-9, 9)} Y{x(-9, 9)}\nG0 X{x()} Y{x()}\nG1 Z0 F400", f"ROT RPL={r.choice((0, 15, 71))}\nG0 X{x()} Y{x()}\nG1 Z0 F400", f"ATRANS X{x(-3, 3)}\nG1 X{x()} Y{x()}", "TRANS\nG0 X1. Y1.\nG1 Z0 F400", f"SUPA G0 Z{x(5, 9)}\nG1 X{x()} Z0 F500", f"G153 G0 Z9.\nG1 Z0 F500",
                       f"G1 X=IC({x(-5, 5)})", f"G1 X=AC({x()})", f"R1={x()}\nG1 X=R1", f"G64 X{x()}", f"G60 Y{x()}", f"G601", f"G642", f"G500 X{x()} Y{x()}\nG54 X{x()} Y{x()}", f"/G1 X{x()}", f"D1 X{x()}\nG1 Z0", f"G17 X{x()}", f"G94 X{x()}", "MSG(\"A\")", f"CIP X{x()} Y{x()} I1=3. J1=4."]
        return r.choice(common)

    def program(self):
        r = self.r
        head = {"linuxcnc": "G21 G90 G17 G54 G94 G49", "fanuc": "G21 G90 G17 G54 G94 G49 G40", "sinumerik": "G71 G90 G17 G54 G94 G40"}[self.dialect]
        lines = (["O0042"] if self.dialect == "fanuc" else []) + [head, r.choice(("S3000 M3", "S3000 M3", "S99000 M3"))]
        if self.dialect == "linuxcnc":
            lines[0] += r.choice(("", " G64 P0.01", " G64 P0.01", " G61", " G64 P1"))
        lines += [f"G0 X{n(r)} Y{n(r)} Z5.", f"G1 Z0 F{r.choice((300, 1000, 3000))}"]
        for _ in range(r.randint(3, 14)):
            lines.append(self.cut() if r.random() < 0.62 else self.other())
        lines += [r.choice(("G0 Z5.", "", "Z5.")), r.choice(("M2", "M30")) if self.dialect == "linuxcnc" else "M30"]
        out = []
        for line in "\n".join(lines).split("\n"):
            out.append(re.match(r"o\d+", [l for l in out if re.match(r"o\d+ repeat", l)][-1]).group() + " endrepeat" if line == "endrepeat" else line)
        ending = r.choice(("\n", "\n", "\r\n"))
        return ending.join(line for line in out) + r.choice((ending, ""))


def machine_path(listed):
    """(dense points of what cuts, ends of the rapids) in machine coordinates; None where a plane is another."""
    unit, rotation, at = 1.0, 0.0, [0.0] * 3
    shift = {name: [0.0] * 3 for name in ("SET_G5X_OFFSET", "SET_G92_OFFSET", "USE_TOOL_LENGTH_OFFSET")}
    dense, rapids = [], []

    def machine(point):
        moved = turned([p * unit + s for p, s in zip(point, shift["SET_G92_OFFSET"])], rotation)
        return [p + a + b for p, a, b in zip(moved, shift["SET_G5X_OFFSET"], shift["USE_TOOL_LENGTH_OFFSET"])]

    def work(point):
        back = turned([p - a - b for p, a, b in zip(point, shift["SET_G5X_OFFSET"], shift["USE_TOOL_LENGTH_OFFSET"])], -rotation)
        return [(p - s) / unit for p, s in zip(back, shift["SET_G92_OFFSET"])]

    for name, text in listed:
        values = numbers(text)
        if name == "USE_LENGTH_UNITS":
            unit = MM_PER_INCH if "INCHES" in text else 1.0
        elif name == "SELECT_PLANE" and "XY" not in text:
            return None
        elif name == "NURBS_FEED":  # printed without its end
            return None
        elif name == "SET_XY_ROTATION":
            rotation = values[0]
        elif name in shift:
            first = 1 if name == "SET_G5X_OFFSET" else 0
            shift[name] = [value * unit for value in values[first:first + 3]]
        elif name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "STRAIGHT_PROBE"):
            end = machine(values[:3])
            if name == "STRAIGHT_TRAVERSE":
                rapids.append(end)
            else:
                parts = max(1, math.ceil(math.dist(at, end) / STEP_MM))
                dense += [tuple(a + (e - a) * i / parts for a, e in zip(at, end)) for i in range(parts + 1)]
            at = end
        elif name == "ARC_FEED":
            dense += [tuple(machine(point)) for point in arc_points(work(at), values, STEP_MM / unit)]
            at = machine([values[0], values[1], values[5]])
    return dense, rapids


def oracle_fault(oracle, original, changed, tube_mm):
    """'' or where LinuxCNC's interpreter sees another path."""
    (good, before, _), (same, after, _) = (calls(oracle, path, os.path.dirname(original)) for path in (original, changed))
    if not good:
        return ""
    if not same:
        return "rs274 refuses the changed program"
    one, other = machine_path(before), machine_path(after)
    if one is None or other is None:
        return ""
    if len(one[1]) != len(other[1]) or any(math.dist(a, b) > NEAR_MM for a, b in zip(*(found[1] for found in (one, other)))):
        return "rs274: a rapid ends elsewhere"
    out = max(farthest(one[0], other[0]), farthest(other[0], one[0]))
    return "" if out <= tube_mm + NEAR_MM + STEP_MM else f"rs274: {out:.3f} mm off in a tube of {tube_mm:g} mm"


def call(steadyrest, *arguments):
    try:
        done = subprocess.run([steadyrest, "program", *arguments, "--json"], capture_output=True, timeout=TIMEOUT_S)
    except subprocess.TimeoutExpired:
        return "timeout", {}
    try:
        return done.returncode, json.loads(done.stdout)
    except ValueError:
        return done.returncode, {"refused": done.stderr.decode("utf-8", "replace")[-300:]}


def plan(r, seconds):
    first = seconds / 60.0 * r.uniform(0.2, 0.8)
    return {"transitions": [{"n": 2, "t_min": [max(first, 1e-4), max(seconds / 60.0 - first, 1e-4)], "delta_um": [10.0, r.choice((20.0, -35.0))]}]}


def verbs(r, plan_file):
    """(name, arguments, whether the plan is inserted)"""
    error = ("--max-error-mm", r.choice(("0.01", "0.003", "0.05")))
    speeds = ("--process", PROCESS, "--depth-mm", "0.4")
    return [("predistort", error, False), ("predistort", (*error, "--hold-limit"), False), ("feeds", error, False), ("speeds", speeds, False),
            ("compensate", ("--plan", plan_file), True), ("correct", error, False), ("correct", (*error, "--plan", plan_file), True),
            ("correct", (*error, *speeds), False)]


def judge(task):
    """[(verb, kind, text)]"""
    arguments, index = task
    r = random.Random(f"{arguments.seed} {index}")
    dialect = r.choice(("linuxcnc", "linuxcnc", "fanuc", "sinumerik"))
    machine = os.path.join(ROOT, "examples/machines", MACHINES[dialect])
    text = Maker(r, dialect).program()
    folder = tempfile.mkdtemp(prefix="hunt-")
    original, changed, back, planned = (os.path.join(folder, name) for name in ("p.ngc", "changed.ngc", "back.ngc", "plan.json"))
    with open(original, "w", newline="") as out:
        out.write(text)
    reading = ("--machine", machine, "--dialect", dialect)
    oracle = Oracle(arguments.rs274) if dialect == "linuxcnc" and shutil.which(arguments.rs274) else None
    found = []
    code, timed = call(arguments.steadyrest, "time", original, *reading)
    if code == 0 and not timed.get("refused"):
        with open(planned, "w") as out:
            json.dump(plan(r, timed["seconds"]), out)
        chosen = verbs(r, planned)
        for verb, options, with_plan in chosen if arguments.all else r.sample(chosen, 3):
            before = b"as it was"
            with open(changed, "wb") as out:
                out.write(before)
            code, made = call(arguments.steadyrest, verb, original, *reading, *options, "-o", changed, "--force")
            with open(changed, "rb") as source:
                after = source.read()
            if code == 2:
                found.append((verb, "refused" if after == before else "WRONG", str(made.get("refused"))))
                continue
            if code != 0:
                found.append((verb, "WRONG", f"exit {code}: {made.get('refused')}"))
                continue
            mark = ("--plan", planned, "--machine", machine, "--dialect", dialect) if with_plan else reading
            code, proof = call(arguments.steadyrest, "verify", original, changed, *mark)
            fault = "" if code == 0 else f"verify: {proof.get('refused')}"
            if not fault and call(arguments.steadyrest, "strip", changed, "-o", back, "--force")[0] != 0:
                with open(original, "rb") as source:
                    fault = "" if source.read() == after else "strip refuses"
            elif not fault:
                with open(original, "rb") as one, open(back, "rb") as other:
                    fault = "" if one.read() == other.read() else "strip does not give the original back"
            if not fault and oracle and not with_plan:
                fault = oracle_fault(oracle, original, changed, proof.get("tube_mm", 0.5))
            found.append((verb, "WRONG" if fault else "written" if after != text.encode() else "unchanged", fault))
    else:
        found.append(("time", "not read", str(timed.get("refused"))))
    if oracle:
        oracle.close()
    if arguments.keep and any(kind == "WRONG" for _, kind, _ in found):
        os.makedirs(arguments.keep, exist_ok=True)
        shutil.copy(original, os.path.join(arguments.keep, f"{arguments.seed}-{index}-{dialect}.ngc"))
    shutil.rmtree(folder)
    return index, dialect, found


def main():
    parser = oracle_parser(__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="index of the first program")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--all", action="store_true", help="every verb on every program, not three of them")
    parser.add_argument("--keep", help="folder for the programs with a fault")
    arguments = parser.parse_args()
    counts, reasons, wrong = collections.Counter(), collections.Counter(), 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for index, dialect, found in pool.map(judge, ((arguments, i) for i in range(arguments.first, arguments.first + arguments.count))):
            for verb, kind, text in found:
                counts[f"{verb} {kind}"] += 1
                if kind in ("refused", "not read"):
                    reasons[f"{verb}: {re.sub(r'[0-9.]+', '#', re.sub(r'/[^ ]*/', '', text))[:150]}"] += 1
                elif kind == "WRONG":
                    wrong += 1
                    print(f"WRONG program {index} ({dialect}) {verb}: {text[:400]}", flush=True)
    for name, count in sorted(counts.items()):
        print(f"{count:6} {name}")
    for reason, count in reasons.most_common(12):
        print(f"{count:6} {reason}")
    print(f"{wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
