#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random programs that ask the control, with blocks replaced and proved, run by LinuxCNC's interpreter `rs274` with every answer.

    scripts/rs274_unknown.py --hunt build/release/bin/steadyrest_nc_rewrite_test [--count 2000] [--seconds 300]

The hunt (steadyrest/nc/rewrite/test/unknown_hunt_test.cpp) writes the pairs that verify_tube() has proved. Each is run
as it was proved and with other answers: #<_task> (rs274 -T), the input that M66 reads, parameters, another work offset and
another tool from before the program, G91 in force at its start. With each answer the changed program makes the
original's moves, as long as rs274 goes on, within the tube. Exit code 1 where one does not, 77 where rs274 is absent.
"""
import itertools
import math
import os
import random
import re
import subprocess
import sys
import tempfile
import time

from nc_programs import script_parser
from rs274_oracle import CALL, Oracle, installed, numbers
from rs274_tube import farthest, points

TUBE_MM = 0.2
SLACK_MM = 0.03  # half a fine step, and printed digits
FINE_MM, COARSE_MM = 0.05, 0.5
MOVES = ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "ARC_FEED", "STRAIGHT_PROBE")
HUNT = "UnknownHunt.NothingProvedMovesOtherwiseForAnotherAnswer"


def answers(chosen):
    """(task, input, variables, start) of some of the control's answers; the first is the one assumed."""
    yield (False, False, "", "")
    yield (True, False, "", "")
    for _ in range(2):
        variables = chosen.choice(["", "100 1\n101 2\n", "5220 2\n5241 1\n5242 2\n", "100 1\n5220 2\n5241 0.5\n"])
        yield (chosen.random() < .5, chosen.random() < .5, variables, chosen.choice(["", "", "G91"]))


def listing(oracle, path, answer):
    task, read, variables, start = answer
    text = open(path, encoding="utf-8").read()
    if read:
        text = text.replace("M66 P0 L0", "#5399=1")
    if start:  # in force as if from before the program
        text = f"{start}\n{text}"
    program = oracle.path("asked.ngc")
    with open(program, "w", encoding="utf-8") as out:
        out.write(text)
    oracle.variables = variables
    oracle.fresh()
    command = [oracle.rs274, *(["-T"] if task else []), "-g", "-t", oracle.path("tool.tbl"), "-v", oracle.path("my.var")]
    done = subprocess.run([*command, program], stdin=subprocess.DEVNULL, capture_output=True, timeout=120, cwd=oracle.folder,
                          env={**os.environ, "HOME": oracle.folder})
    calls = [call.groups() for call in map(CALL.match, done.stdout.decode("latin-1").splitlines()) if call]
    return done.returncode, calls


def difference(original, changed):
    """What the listings differ in; empty when the changed one is within the tube."""
    if original[0] != changed[0]:
        return f"ends with {changed[0]}, not {original[0]}"
    ends = [next((numbers(values)[:3] for name, values in reversed(calls) if name in MOVES[:2]), [0, 0, 0]) for _, calls in (original, changed)]
    if math.dist(*ends) > TUBE_MM:
        return f"ends at {ends[1]}, not {ends[0]}"
    others = [[call for call in calls if call[0] not in (*MOVES, "SET_FEED_RATE", "COMMENT", "SELECT_PLANE")] for _, calls in (original, changed)]
    if others[0] != others[1]:
        return "does something else than move"
    fine = [points(calls, FINE_MM) for _, calls in (original, changed)]
    coarse = [points(calls, COARSE_MM) for _, calls in (original, changed)]
    apart = max(farthest(coarse[1], fine[0]), farthest(coarse[0], fine[1]))
    return f"is {apart:.3f} mm away" if apart > TUBE_MM * math.sqrt(2) + SLACK_MM else ""


def main():
    parser = script_parser(__doc__)
    parser.add_argument("--rs274", default="rs274")
    parser.add_argument("--hunt", default="build/release/bin/steadyrest_nc_rewrite_test")
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=math.inf)
    arguments = parser.parse_args()
    if not installed(arguments.rs274):
        return 77
    began, wrong, judged, runs, otherwise = time.monotonic(), 0, 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        hunt = subprocess.run([arguments.hunt, f"--gtest_filter={HUNT}"], capture_output=True, text=True, check=False,
                              env={**os.environ, "STEADYREST_UNKNOWN_PROGRAMS": str(arguments.count), "STEADYREST_UNKNOWN_FOLDER": folder})
        if hunt.returncode:
            print(hunt.stdout)
            return 1
        oracle = Oracle(arguments.rs274)
        for name in sorted(os.listdir(folder), key=lambda one: int(re.match(r"\d+", one).group())):
            if not name.endswith(".changed.ngc") or time.monotonic() - began > arguments.seconds:
                continue
            paths = [os.path.join(folder, name.replace(".changed", "")), os.path.join(folder, name)]
            judged += 1
            assumed = None
            for answer in itertools.islice(answers(random.Random(name)), 4):
                listed = [listing(oracle, path, answer) for path in paths]
                assumed = assumed or listed[0]
                runs += 1
                otherwise += listed[0] != assumed
                if what := difference(*listed):
                    wrong += 1
                    print(f"WRONG {name}, {answer}: {what}")
                    if wrong <= 3:
                        print(open(paths[1], encoding="utf-8").read())
        oracle.close()
    print(f"{arguments.count} programs, {judged} of them replaced and proved; {runs} answers, {otherwise} with another path; {wrong} wrong")
    return 1 if wrong or judged == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
