#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random programs, compensated, started in random states: the machine must go otherwise by the plan alone, and nothing of a
correction may stay when they are over.

    scripts/rs274_compensate_random.py [--steadyrest build/release/bin/steadyrest] [--seed 1] [--count 200] [--jobs 1]

Programs have lines with `/`, M1, work offsets, G10, G28.1, G92, parameters, subprograms, probes, tool data. Original and changed
program run through LinuxCNC's interpreter `rs274` with and without block delete. They begin with units, work offsets, rotations,
G92, reference points and parameters that the compensation knows (--variables) or does not, and with tool lengths that it never knows. Machine positions, move by move, the
whole variable file and the tool table afterwards are compared. Exit code 1 when a program deviates, 77 without rs274.
"""
import collections
import concurrent.futures
import json
import os
import random
import re
import shutil
import subprocess
import sys

from nc_programs import ROOT
from rs274_compensate import calls, disagreement, machine_moves, totals_of, trace
from rs274_oracle import Oracle, installed, oracle_parser
from rs274_walk import run

WINDOWS_S = (2.0, 6.0, 60.0, 60.0)
LEFT_OVER = ("G43.1 Z.4", "T4 M6\nG43", "G18", "G8", "G61", "G99", "G95", "M73", "G90.1")  # tells no file
SHIFTED = ("G92 Z.3", "G92 X1 Y2 Z-.2", "G52 Z.1", "G92 Z1\nG92.2")
PLAN_S = 35.0  # programs of 5 to 65 s fit it
NEVER_SWITCHED = re.compile(r"(?i)o\d+ (?!call)")  # an O-word that is skipped leaves its pair alone


def number(r, low, high, scale):
    return f"{r.uniform(low, high) * scale:.4f}".rstrip("0").rstrip(".") or "0"


def state(r):
    """The variable file at the start, in inches: {number: value}."""
    found = {}
    if r.random() < 0.8:
        for system in range(9):
            if r.random() < 0.6:
                found.update({5221 + 20 * system + axis: round(r.uniform(-5, 5), 4) for axis in range(3)})
            if r.random() < 0.25:
                found[5230 + 20 * system] = r.choice([30.0, 90.0, -12.5, 180.0])
    if r.random() < 0.4:
        found[5220] = r.randint(1, 9)
    if r.random() < 0.15:
        found.update({5210: 1, 5211: round(r.uniform(-1, 1), 3), 5213: round(r.uniform(-1, 1), 3)})
    for first in (5161, 5181):
        if r.random() < 0.5:
            found.update({first + axis: round(r.uniform(-2, 2), 3) for axis in range(3)})
    found.update({n: round(r.uniform(-3, 30), 3) for n in (100, 101, 3000) if r.random() < 0.5})
    return found


def variables(found):
    numbers = sorted({*range(5161, 5170), *range(5181, 5190), *range(5210, 5221), *range(5221, 5401), 100, 101, 102, 3000, *found})
    return "".join(f"{n}\t{found.get(n, 1.0 if n == 5220 else 0.0):.6f}\n" for n in numbers)


def spice(r, scale):
    """Lines between the passes: nearly all affect what outlives a program or where zero is."""
    n = lambda low=-9, high=9: number(r, low, high, scale)
    offset = r.choice(["G54", "G55", "G56", "G59.3"])
    return r.choice([
        lambda: [offset], lambda: [offset], lambda: [f"{offset} G0 X{n()}"], lambda: ["M1"], lambda: ["M0"], lambda: ["G4 P.1"],
        lambda: [f"G10 L2 P{r.randint(0, 4)} {r.choice('XYZ')}{n()}"], lambda: [f"G10 L2 P{r.randint(0, 3)} R{r.choice([0, 15])}"],
        lambda: [f"G10 L20 P{r.randint(0, 4)} {r.choice('XYZZ')}{n()}"], lambda: [f"G10 L20 P0 Z[#<_z>+{n(0, 2)}]"],
        lambda: ["G28.1"], lambda: ["G30.1"], lambda: ["G28"], lambda: [f"G91 G28 Z{n(0, 3)}", "G90"], lambda: [f"G30 Z{n(10, 30)}"],
        lambda: [f"G53 G0 Z{n(0, 30)}"], lambda: ["G53 G0 Z0", f"G10 L{r.choice([10, 11])} P{r.randint(1, 5)} Z{n()}"],
        lambda: [f"G10 L{r.choice([10, 11])} P{r.randint(1, 5)} Z{n()}"], lambda: [f"G10 L1 P{r.randint(1, 5)} Z{n()} R{n(0, 2)}"],
        lambda: [f"G92 {r.choice('XYZZ')}{n()}"], lambda: [f"G52 {r.choice('XYZZ')}{n()}"], lambda: ["G92.1"], lambda: ["G92.2"],
        lambda: [f"#{r.choice([100, 101, 102])}=#<_abs_z>"], lambda: ["#100=#<_z>"], lambda: ["#102=#5422"],
        lambda: [f"#{r.choice([5223, 5243, 5221, 5161])}={n()}"], lambda: ["#5223=[#5223+1]"],
        lambda: [f"#{r.choice([5211, 5213, 5230, 5250])}={n()}", *r.choice([[], ["G92.3"], ["G55", "G54"], ["G54"]])], lambda: ["#5210=1"],
        lambda: ["#<_keep>=#<_abs_x>", "#101=#<_keep>"], lambda: ["#101=#3000"], lambda: [f"#1={n()}", "G0 Z[#1+20]"],
        lambda: [f"#100={n(10, 30)}", "G0 Z#100"], lambda: ["#100=#5063"], lambda: ["G0 Z[#<_z>+1]"],
        lambda: [f"G38.3 Z{n(-3, 0)} F90"], lambda: [r.choice(["G20", "G21"])],
        lambda: ["G91", f"G0 Z{n(0, 3)}", f"G1 X{n()} F200", "G90"], lambda: ["G91"], lambda: ["G90"],
        lambda: [f"G0 X{n()}", f"G0 Y{n()}"], lambda: [f"G0 Z{n(10, 40)}"], lambda: [f"G0 Z{n(2, 9)}"],
        lambda: [f"T{r.randint(1, 5)} M6", f"G43 H{r.randint(1, 5)}", f"G0 Z{n(10, 30)}"], lambda: ["G49"], lambda: [f"G43.1 Z{n()}"],
        lambda: ["M70", r.choice(["G91", "G20", "G55"]), f"G0 X{n()}", "M72"],
        lambda: [f"o{r.randint(200, 900)} repeat [2]", f"G1 X{n()} F300", "endrepeat"], lambda: ["G92.3"], lambda: ["G43"], lambda: ["G49"],
        lambda: ["o101 call"], lambda: ["o101 call"], lambda: ["if"], lambda: ["M2"],
        lambda: [f"G81 X{n()} Y{n()} Z{n(-3, 0)} R{n(1, 5)} F200", "G80"], lambda: [f"G41.1 D{n(0.2, 1)} G1 X{n(15, 30)} F200", "G40"],
    ])()


def nested(lines, label):
    """O-words with their numbers."""
    out = []
    for line in lines:
        if line == "endrepeat":
            line = out[-2].split()[0] + " endrepeat"
        if line == "if":
            out += [f"o{label} if [#100 GT {label % 7}]", "G0 Z33", f"o{label} endif"]
            continue
        out.append(line)
    return out


def program(r):
    """(text, axes of the plan)"""
    inch = r.random() < 0.2
    scale = 1 / 25.4 if inch else 1.0
    n = lambda low, high: number(r, low, high, scale)
    head = ["G17", "G20" if inch else "G21", "G90", "G94", r.choice(["G54", "G54", "G54", "G55", "G57", "G59.3"])]
    if r.random() < 0.15:
        head.remove(r.choice(head[2:]))
    lines = [" ".join(head)]
    if r.random() < 0.2:
        lines = head
    lines += ["T1 M6", "G43 H1", "S1000 M3"]
    if r.random() < 0.4:
        lines = ["o101 sub", f"G91 G1 X{n(1, 3)} F300", "G90", f"G1 Y{n(-5, 5)}", "o101 endsub"] + lines
    spices = r.choice([0, 0, 1, 1, 1, 2, 3])
    body = [[f"G0 X{n(-5, 5)} Y{n(-5, 5)} Z{n(10, 30)}"]]
    for _ in range(r.randint(2, 4)):
        body += [[f"G0 X{n(0, 20)} Y{n(0, 20)}"], [f"G0 X{n(0, 20)}"] if r.random() < 0.5 else [], [f"G0 Z{n(2, 5)}"] if r.random() < 0.5 else [],
                 [f"G1 Z{n(-3, 0)} F{n(200, 500)}"], [f"G1 X{n(0, 60)} F{n(300, 900)}"],
                 [f"G3 X{n(30, 31)} Y{n(0, 1)} R{n(60, 90)}"] if r.random() < 0.3 else [], [f"G0 Z{n(5, 60)}"]]
    for _ in range(spices):
        body.insert(r.randint(1, len(body)), spice(r, scale))
    for index, group in enumerate(body):
        lines += nested(group, 1000 + index)
    if "o101 call" in lines and "o101 sub" not in lines:
        lines = [line for line in lines if line != "o101 call"]
    switched = r.choice([0.0, 0.0, 0.06, 0.15])
    lines = ["/" + line if r.random() < switched and not NEVER_SWITCHED.search(line) else line for line in lines]
    lines.append(r.choice(["M2", "M2", "M30", f"G0 Z{n(30, 60)} M2"]))
    return "\n".join(lines) + "\n", r.choice(["Z"] * 7 + ["X", "Y", "XZ"])


def plan(r, axes):
    steps = r.randint(1, 3)
    times = [PLAN_S * r.uniform(0.1, 0.9) / 60.0 / steps for _ in range(steps)]
    times.append(PLAN_S / 60.0 - sum(times))
    made = {}
    for axis in axes:
        deltas = [0.0] + [round(r.choice([-1, 1]) * r.uniform(30, 60), 1) for _ in range(steps)]
        made[axis] = {"transitions": [{"n": steps + 1, "t_min": times, "delta_um": deltas}]}
    return {"axes": made}


def start_of(r, found, known):
    """The state of a run and the lines that the operator gave before it: what is known stays, units are never known."""
    before = [r.choice(["G20", "G21"])]
    if r.random() < 0.3:
        before.append(r.choice(LEFT_OVER if known else LEFT_OVER + SHIFTED + SHIFTED))
    if not known and r.random() < 0.3:
        before.append("G91")
    return variables(found if known else state(r)), "".join(line + "\n" for line in before)


def examine(task):
    """(kind, text) of one program: right, refused, not read, wrong."""
    arguments, index = task
    r = random.Random(f"{arguments.seed}/{index}")
    text, axes = program(r)
    oracle = Oracle(arguments.rs274)
    try:
        return judge(arguments, r, oracle, text, axes)
    except subprocess.TimeoutExpired as late:
        return "wrong", f"{late}\n{text}"
    finally:
        oracle.close()


def judge(arguments, r, oracle, text, axes):
    found, known = state(r), r.random() < 0.5
    names = {name: oracle.path(name) for name in ("known.var", "known.tbl", "original.ngc", "changed.ngc", "plan.json")}

    def write(name, content):
        with open(oracle.path(name), "w") as out:
            out.write(content)

    oracle.fresh()
    shutil.copy(oracle.path("tool.tbl"), names["known.tbl"])
    write("known.var", variables(found))
    write("original.ngc", text)
    write("plan.json", json.dumps(plan(r, axes)))
    said = ["--variables", names["known.var"]] if known else []
    code, made = run(arguments.steadyrest, "compensate", names["original.ngc"], "--plan", names["plan.json"], "-o", names["changed.ngc"],
                     "--machine", arguments.machine, "--dialect", "linuxcnc", "--tools", names["known.tbl"], "--data-units", "inch",
                     "--window-s", str(r.choice(WINDOWS_S)), *(["--block-delete"] if r.random() < 0.3 else []), *said)
    if code not in (0, 2):
        return "wrong", f"exit code {code}\n{text}"
    if code:
        return "refused", re.sub(r"[0-9.]+", "#", made["refused"][0]["what"])[:100]
    with open(names["changed.ngc"]) as source:
        changed = source.read()
    totals = totals_of(made["insertions"])
    may_leave = re.search(r"G0*(53|28|30)(?![\d.])", text) is not None
    read = False
    for block_delete in (False, True) if "/" in text else (False,):
        oracle.variables, before = start_of(r, found, known)
        results = []
        for name, content in (("a.ngc", text), ("b.ngc", changed)):
            write(name, before + content)
            results.append(calls(oracle, oracle.path(name), oracle.folder, block_delete))
        (ok, original, left), (ok_changed, corrected, left_changed) = results
        if not ok:
            continue
        read = True
        ends_early = re.search(r"^/?.*M2$", text[:text.rstrip().rfind("\n")], re.M) is not None
        fault = ("rs274 refuses the changed program" if not ok_changed else
                 disagreement(machine_moves(original), machine_moves(corrected), totals, may_leave, not ends_early) or
                 trace(left, left_changed))
        if fault:
            shown = {name: value for name, value in (line.split() for line in oracle.variables.splitlines()) if float(value)}
            return "wrong", f"{fault}; block delete {block_delete}, {before.split()}, known {known}, {shown}\n{changed}"
    return ("right", f"{len(made['insertions'])} corrections") if read else ("not read", "rs274 refuses the original")


def main():
    parser = oracle_parser(__doc__)
    parser.add_argument("--machine", default=os.path.join(ROOT, "examples/machines/linuxcnc-mill.toml"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--first", type=int, default=0, help="number of the first program")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--reasons", action="store_true", help="print why programs were refused")
    arguments = parser.parse_args()
    if not installed(arguments.rs274):
        return 77
    counts, reasons = collections.Counter(), collections.Counter()
    tasks = [(arguments, index) for index in range(arguments.first, arguments.first + arguments.count)]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for (_, index), (kind, text) in zip(tasks, pool.map(examine, tasks)):
            counts[kind] += 1
            if kind == "refused":
                reasons[text] += 1
            if kind == "wrong":
                print(f"--- seed {arguments.seed}, program {index}: {text}", flush=True)
    for reason, count in reasons.most_common() if arguments.reasons else ():
        print(f"{count:6} {reason}")
    compensated = counts["right"] + counts["wrong"]
    print(f"{arguments.count} random programs, {compensated} compensated and compared ({100.0 * compensated / arguments.count:.0f} %), "
          f"{counts['refused']} refused, {counts['not read']} not read by rs274, {counts['wrong']} deviate")
    return 1 if counts["wrong"] or 4 * compensated < arguments.count else 0


if __name__ == "__main__":
    sys.exit(main())
