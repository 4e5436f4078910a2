#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a compensated program does after an abort, by LinuxCNC's interpreter `rs274`, which keeps the variable file.

    scripts/rs274_abort.py [--steadyrest build/release/bin/steadyrest] [--seed 1] [--count 60] [--verbose]

A day in the shop, at random: corrected programs in mm, in inches and without a word about it are run, aborted anywhere,
started again, started from any line, after a restart of LinuxCNC or without one; between the runs the operator touches off,
shifts, chooses other work offsets, sets and clears G92, measures tools, runs other programs.

What must hold: at the first move behind the head the work offset is the operator's own, or the program has stopped with a
message before it. Behind the end of a run it is the operator's own in every work offset, and no note is left.
The operator's own: what he has set by a touch-off or by a number, plus what he has shifted it by. Exit code 1 when one day
breaks it, 77 where rs274 is absent.
"""
import collections
import json
import os
import random
import subprocess
import sys

from nc_programs import ROOT
from rs274_oracle import CALL, MM_PER_INCH, Oracle, installed, numbers, oracle_parser

MOTION = ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED")
NEAR_MM = 0.008  # rs274 prints four digits, in inches 2.5 um; corrections are 40 um and more
MACHINE = MM_PER_INCH  # its variable file is in inches

PASSES = """G17 {units} G90 G94 {system}
G0 X0 Y0 Z{high}
G1 Z-{low} F{feed}
G1 X{far}
G0 Z{high}
G0 X0 Y{low}
G0 X{low}
G1 X{far}
{turn}
G0 Z{high}
G0 X0 Y0
G1 Z-{low}
G1 X{far}
G0 Z{high}
G1 X0
G0 Z{high}
M2
"""


class Shop:
    """The machine's state that outlives a run, and what the operator means it to be (mm)."""

    def __init__(self, oracle):
        self.oracle = oracle
        oracle.fresh()
        self.meant = [0.0] * 9
        self.meant_g92 = 0.0
        self.place = 0.0   # of the Z axis, machine coordinates
        self.unsure = False  # touched off or measured since an abort, in a way that no number shows
        self.log = []

    def variables(self):
        found = {}
        with open(self.oracle.path("my.var")) as source:
            for line in source:
                parts = line.split()
                if len(parts) == 2:
                    found[int(parts[0])] = float(parts[1])
        return found

    def active(self):
        return max(int(self.variables().get(5220, 1)), 1) - 1

    def run(self, text, folder):
        """rs274 over these lines: (ended well, calls)"""
        path = os.path.join(folder, "run.ngc")
        with open(path, "w") as out:
            out.write(text)
        done = subprocess.run([self.oracle.rs274, "-g", "-t", self.oracle.path("tool.tbl"), "-v", self.oracle.path("my.var"), path],
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=60, cwd=folder,
                              env={**os.environ, "HOME": self.oracle.folder})
        calls = [CALL.match(line) for line in done.stdout.decode("latin-1").splitlines()]
        complaint = done.stderr.decode("latin-1")
        ended = done.returncode == 0 or "File ended with no percent sign" in complaint  # ended by an abort
        return ended, [(one.group(1), one.group(2)) for one in calls if one], complaint


def follow(calls, start):
    """(offset of Z at the first move behind `start` comments, stops before it, last machine position, messages)"""
    unit, g5x, g92, length = 1.0, 0.0, 0.0, 0.0
    first, stops, place, seen, messages = None, 0, None, start == 0, []
    for name, values in calls:
        if name == "USE_LENGTH_UNITS":
            unit = MM_PER_INCH if "INCHES" in values else 1.0
        elif name == "SET_G5X_OFFSET":
            g5x = numbers(values)[3] * unit
        elif name == "SET_G92_OFFSET":
            g92 = numbers(values)[2] * unit
        elif name == "USE_TOOL_LENGTH_OFFSET":
            length = numbers(values)[2] * unit
        elif name == "COMMENT" and "run begins" in values:
            seen = True
        elif name == "PROGRAM_STOP" and seen and first is None:
            stops += 1
        elif name == "MESSAGE":
            messages.append(values)
        elif name in MOTION:
            printed = numbers(values)
            place = printed[5 if name == "ARC_FEED" else 2] * unit + g5x + g92 + length
            if seen and first is None:
                first = g5x + g92
    return first, stops, place, messages


def make(shop, r, folder, steadyrest, machine, name):
    """A corrected program: (original's lines, changed lines, number of lines of the head)"""
    units = r.choice(["G21", "G20", ""])
    scale = 25.4 if units == "G20" else 1.0
    system = r.choice(["", "G54", "G55"])
    turn = r.choice(["", "", "G55", "G54", "G92 Z3", "G10 L20 P0 Z4"]) if system else ""
    text = PASSES.format(units=units, system=system, turn=turn, high="%g" % round(5 / scale, 4), low="%g" % round(1 / scale, 4),
                         far="%g" % round(50 / scale, 4), feed="%g" % round(100 / scale, 4))
    original = os.path.join(folder, name + ".ngc")
    with open(original, "w") as out:
        out.write(text)
    common = ["--machine", machine, "--json"] + ([] if units else ["--units", "mm"])
    if not system:
        variables = os.path.join(folder, "start.var")
        with open(variables, "w") as out:
            out.write("5220 1\n")
        common += ["--variables", variables]
    time = json.loads(subprocess.run([steadyrest, "program", "time", original, *common], capture_output=True).stdout)
    share = time["seconds"] / 4.0 / 60.0
    deltas = [r.choice([-1, 1]) * r.randint(40, 60) for _ in range(3)]
    plan = os.path.join(folder, name + ".json")
    with open(plan, "w") as out:
        json.dump({"transitions": [{"n": 4, "t_min": [share] * 4, "delta_um": [0, *deltas]}]}, out)
    changed = os.path.join(folder, name + "-changed.ngc")
    done = subprocess.run([steadyrest, "program", "compensate", original, "--plan", plan, "-o", changed, *common], capture_output=True)
    if done.returncode:
        return None
    with open(changed) as source:
        lines = source.read().splitlines()
    head = max((i + 1 for i, line in enumerate(lines) if "STEADYREST head" in line), default=0)
    turned = turn if turn.startswith(("G92", "G10")) else ""
    return {"lines": lines, "head": head, "units": units, "sets": turned, "system": system}


def day(r, oracle, steadyrest, machine, folder, count_of):
    shop = Shop(oracle)
    for number in range(9):  # where the parts lie
        shop.meant[number] = round(r.uniform(-90, -20), 3)
    with open(oracle.path("my.var"), "w") as out:
        out.write("5220 1\n" + "".join("%d %.9f\n" % (5223 + 20 * n, z / MACHINE) for n, z in enumerate(shop.meant)))
    shop.meant = [shop.variables()[5223 + 20 * n] * MACHINE for n in range(9)]
    made = [one for one in (make(shop, r, folder, steadyrest, machine, "p%d" % i) for i in range(2)) if one]
    if not made:
        return "", shop.log
    for _ in range(r.randint(4, 10)):
        kind = r.choices(["run", "abort", "from", "operator", "other"], [3, 4, 2, 6, 1])[0]
        if kind in ("run", "abort", "from"):
            fault = start(shop, r, r.choice(made), kind, folder, count_of)
        else:
            fault = operator(shop, r, kind, folder, count_of)
        if fault:
            return fault, shop.log
    return "", shop.log


def start(shop, r, program, kind, folder, count_of):
    lines = list(program["lines"])
    first = 0
    last = len(lines)
    if kind == "abort":
        last = r.randint(program["head"], len(lines) - 1)
    if kind == "from":  # the control has the modes given by MDI
        first = r.randint(program["head"], len(lines) - 2)
        lines = ["G17 %s G90 G94 F100" % program["units"]] + lines[first:]
        last = len(lines)
    units = r.choice(["G20", "G21"]) if not program["units"] else ""
    text = "\n".join(([units] if units else []) + ["(run begins)"] + lines[:last]) + "\n"
    active = shop.active()  # M2 goes back to G54
    ended, calls, complaint = shop.run(text, folder)
    offset, stops, place, messages = follow(calls, 1)
    shop.log.append(f"{kind} lines {first}..{last} units {units or program['units']} -> ended {ended} stops {stops} offset {offset} {complaint.strip()[-100:]}")
    if place is not None:
        shop.place = place
    now = shop.variables()
    if not ended:
        count_of["stopped"] += 1
        if offset is not None and kind != "from":
            return f"complained behind the first move: {complaint}"
        put_right(shop, r, folder)
        return ""
    count_of[kind] += 1
    if kind != "from" and offset is not None:
        # The program may choose the offset in its first line.
        chosen = {"G54": 0, "G55": 1}.get(program["system"], active if not program["system"] else None)
        wanted = shop.meant[chosen] + shop.meant_g92
        if abs(offset - wanted) > NEAR_MM:
            return f"first move with offset {offset:.4f} mm instead of {wanted:.4f}"
        if shop.unsure and not stops:
            return "no stop, though a tool was measured through a correction"
    if kind != "from" and stops:
        shop.unsure = False
    if program["sets"] and sets_were_run(program, lines[:last]):
        take_over(shop, now, program)
    if kind == "abort":
        return ""
    for number in range(9):
        value = now.get(5223 + 20 * number, 0.0) * MACHINE
        noted = now.get(5229 + 20 * number, 0.0)
        if kind == "from" and noted:  # left in an offset that this run did not select: the next head finds it
            continue
        if abs(value - shop.meant[number]) > 1e-4:
            return f"behind the end work offset {number + 1} is {value:.5f} mm instead of {shop.meant[number]:.5f}"
        if noted or now.get(5228 + 20 * number, 0.0):
            return f"a note is left in work offset {number + 1}"
    return ""


def sets_were_run(program, lines):
    return any(line.startswith(program["sets"]) for line in lines)


def take_over(shop, now, program):
    """The program has set the offset itself: what it set, less what is noted as ours, is meant."""
    shop.meant_g92 = (now.get(5213, 0.0) if now.get(5210, 0.0) else 0.0) * MACHINE
    for number in range(9):
        shop.meant[number] = now.get(5223 + 20 * number, 0.0) * MACHINE - now.get(5229 + 20 * number, 0.0)


def put_right(shop, r, folder):
    """As the message says: touch off, and take the note away; in every work offset that has one."""
    lines = ["G21 G90"]
    now = shop.variables()
    for number in range(9):
        if now.get(5229 + 20 * number, 0.0):
            shop.meant[number] = round(r.uniform(-90, -20), 3)
            lines.append("G10 L2 P%d Z%.4f" % (number + 1, shop.meant[number]))
            lines.append("#%d=0 #%d=0" % (5229 + 20 * number, 5228 + 20 * number))
    shop.run("\n".join(lines) + "\n", folder)
    now = shop.variables()
    take_over(shop, now, None)
    shop.unsure = False
    shop.log.append("put right: " + " ".join("%.4f" % z for z in shop.meant[:3]))


def operator(shop, r, kind, folder, count_of):
    now = shop.variables()
    ours = [now.get(5229 + 20 * n, 0.0) for n in range(9)]
    active = shop.active()
    lines = ["G21 G90 G49"]
    if kind == "other":
        lines += ["G0 Z30", "G1 Z1 F100", "G0 Z%g" % r.randint(5, 40)]
        what = "another program"
    else:
        what = r.choice(["touch off", "touch off same", "set", "shift", "choose", "g92", "no g92", "tool", "jog"])
        lines.append("G0 Z%.3f" % r.uniform(-2, 30))
        value = round(r.uniform(-3, 3), 3)
        system = r.choice([active, active, r.randrange(9)])
        if what == "touch off":
            lines.append("G10 L20 P%d Z%.4f" % (active + 1, value))
        elif what == "touch off same":  # finds what the control shows already
            lines.append("G10 L20 P%d Z[#<_z>]" % (active + 1))
            if ours[active]:
                shop.unsure = True
        elif what == "set":
            shop.meant[system] = round(r.uniform(-90, -20), 3)
            lines.append("G10 L2 P%d Z%.4f" % (system + 1, shop.meant[system]))
        elif what == "shift":
            lines.append("G10 L2 P%d Z[#%d*25.4+%.3f]" % (system + 1, 5223 + 20 * system, value))
            shop.meant[system] += value
        elif what == "choose":
            lines.append(r.choice(["G54", "G54", "G55", "G56", "G59.3"]))
        elif what == "g92":
            lines.append("G92 Z%.3f" % value)
        elif what == "no g92":
            lines.append("G92.1")
        elif what == "tool":
            lines += ["G10 L10 P1 Z%.3f" % value]
            shop.unsure = shop.unsure or any(ours)
    ended, calls, complaint = shop.run("\n".join(lines) + "\n", folder)
    if not ended:
        return f"the script's own lines are refused: {complaint}"
    _, _, place, _ = follow(calls, 0)
    shop.place = shop.place if place is None else place
    after = shop.variables()
    count_of[what] += 1
    if what == "touch off":
        shop.meant[active] = after[5223 + 20 * active] * MACHINE  # the operator's now, whatever was there
    elif what == "g92":
        total = (after[5223 + 20 * active] + after[5213]) * MACHINE
        shop.meant_g92 = total - shop.meant[active]
    elif what == "no g92":
        shop.meant_g92 = 0.0
    shop.log.append(f"{what}: active {active + 1} -> {shop.active() + 1}, meant {shop.meant[shop.active()]:.4f} g92 {shop.meant_g92:.4f} noted {[o for o in ours if o]}")
    return ""


def main():
    parser = oracle_parser(__doc__)
    parser.add_argument("--machine", default=os.path.join(ROOT, "examples/machines/linuxcnc-mill.toml"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--verbose", action="store_true")
    arguments = parser.parse_args()
    if not installed(arguments.rs274):
        return 77
    count_of, wrong = collections.Counter(), 0
    for number in range(arguments.count):
        seed = arguments.seed * 1_000_003 + number
        oracle = Oracle(arguments.rs274)
        fault, log = day(random.Random(seed), oracle, arguments.steadyrest, arguments.machine, oracle.folder, count_of)
        if fault or arguments.verbose:
            print(f"day {seed}: {fault or 'right'}\n    " + "\n    ".join(log), flush=True)
        wrong += 1 if fault else 0
        oracle.close()
    print(f"{arguments.count} days, {wrong} wrong; " + ", ".join(f"{count} {name}" for name, count in sorted(count_of.items())))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
