# SPDX-License-Identifier: Apache-2.0
"""What the scripts share that run programs and their changed versions through LinuxCNC's interpreter."""
import collections
import json
import os
import re
import subprocess

from nc_programs import ROOT, add_folders, dialect_of, programs, sample, short
from rs274_oracle import Oracle, installed, oracle_parser

MACHINE = os.path.join(ROOT, "examples/machines/linuxcnc-mill.toml")


def run(steadyrest, *arguments):
    """(exit code, answer) of `steadyrest program …`"""
    done = subprocess.run([steadyrest, "program", *arguments, "--json"], capture_output=True, timeout=300)
    return done.returncode, json.loads(done.stdout)


def with_end(oracle, program):
    """A copy that ends with M2: a file without it is read as if it had one."""
    ended = oracle.path("ended.ngc")
    with open(program, "rb") as source, open(ended, "wb") as out:
        out.write(source.read() + b"\nM2\n")
    return ended


def restores(steadyrest, oracle, changed, program):
    """Whether `strip` gives the original back, byte for byte."""
    stripped = oracle.path("stripped.ngc")
    run(steadyrest, "strip", changed, "-o", stripped)
    with open(stripped, "rb") as one, open(program, "rb") as other:
        return one.read() == other.read()


def walk(description, judge):
    """Judges every program for LinuxCNC in the folders of the command line; returns the exit code. `judge` takes (path of
    steadyrest, oracle, program, machine) and returns (kind, text): "right", "wrong" or one that begins with "not" or "un"."""
    parser = oracle_parser(description)
    add_folders(parser)
    parser.add_argument("--machine", default=MACHINE)
    parser.add_argument("--most", type=int, help="only short programs, and until so many are right")
    parser.add_argument("--table", action="store_true", help="print every program, not only those that disagree")
    arguments = parser.parse_args()
    if not installed(arguments.rs274):
        return 77

    folders = [folder for folder in (arguments.data, os.path.join(ROOT, "examples/programs"),
                                     os.path.join(ROOT, "tests/accepted/nc"), *arguments.linuxcnc) if os.path.isdir(folder)]
    oracle = Oracle(arguments.rs274)
    counts, reasons = collections.Counter(), collections.Counter()
    found = [program for program in map(os.path.abspath, programs(folders)) if dialect_of(program) == "linuxcnc"]
    for program in sample(found, arguments.most and len(found)):
        if counts["right"] == arguments.most:
            break
        kind, text = judge(arguments.steadyrest, oracle, program, arguments.machine)
        counts[kind] += 1
        if kind.startswith("not"):
            reasons[f"{kind}: {re.sub(r'[0-9.]+', '#', text)}"] += 1
        if kind == "wrong" or arguments.table:
            print(f"{kind:16} {short(program, arguments.data)}: {text}", flush=True)
    oracle.close()
    for reason, count in reasons.most_common():
        print(f"{count:5} {reason}")
    print(", ".join(f"{count} {kind}" for kind, count in sorted(counts.items())))
    return 1 if counts["wrong"] or not counts["right"] else 0
