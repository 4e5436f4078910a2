#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares `steadyrest program moves` with LinuxCNC's interpreter `rs274` and writes the table of what is
accepted and what is refused.

    scripts/rs274_table.py [--steadyrest build/release/bin/steadyrest] [--data ../shared/data/nc]
                           [--linuxcnc /usr/share/linuxcnc …] [-o docs/nc-coverage.md]

Needs `rs274` (Debian: linuxcnc-uspace). Every number that rs274 prints is compared to its last digit.
Exit code 1 when one file disagrees.
"""
import os
import re
import subprocess
import sys

from nc_in_linuxcnc_words import equivalent_of
from nc_programs import add_folders, dialect_of, programs, sample, short
from rs274_oracle import TOOLS, Oracle, installed, judge, oracle_parser, tool_length_in_change


def main():
    parser = oracle_parser(__doc__)
    add_folders(parser)
    parser.add_argument("--most", type=int, help="only so many short programs of each dialect, and our own")
    parser.add_argument("-o", "--output", help="write the table to this file")
    parser.add_argument("files", nargs="*", help="only these programs")
    arguments = parser.parse_args()
    if not installed(arguments.rs274):
        return 77
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "accepted", "nc")
    found = list(programs([own])) + sample(list(programs([arguments.data])) + list(programs(arguments.linuxcnc)), arguments.most)
    if not arguments.files and not list(programs([arguments.data])):
        print("no programs in", arguments.data)
        return 77
    seen, rows, bad = set(), [], 0
    oracle = Oracle(arguments.rs274)
    for program in arguments.files or found:
        content = open(program, "rb").read()
        if content in seen:
            continue
        seen.add(content)
        dialect = dialect_of(program)
        oracle.tools = re.sub(r"Z\S+", "Z0", TOOLS) if tool_length_in_change(content.decode("latin-1")) else TOOLS
        try:
            equivalent = equivalent_of(program, dialect, oracle) if dialect != "linuxcnc" else None
            result = judge(os.path.abspath(arguments.steadyrest), oracle, program, dialect, equivalent)
        except subprocess.TimeoutExpired:
            result = {"accepted": False, "verdict": "", "moves": 0, "blocks": 0, "rs274_ok": False,
                      "refusal": {"line": 0, "word": "", "reason": "time", "text": ""}, "rs274": "did not end in 120 s"}
        bad += bool(result["verdict"])
        if result["verdict"]:
            print("DISAGREES", program, result["verdict"])
        rows.append((program, dialect, result))
    oracle.close()
    accepted = [row for row in rows if row[2]["accepted"]]
    print(f"{len(rows)} programs: {len(accepted)} accepted, {sum(r['moves'] for _, _, r in accepted)} moves in them agree "
          f"with rs274, {len(rows) - len(accepted)} refused, {bad} disagree")
    if arguments.output:
        write(arguments.output, rows, arguments)
    return 1 if bad else 0


def write(path, rows, arguments):
    root = os.path.dirname(os.path.abspath(arguments.data.rstrip("/")))
    here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
    with open(path, "w") as out:
        out.write("# Which NC programs are read\n\nMade by `scripts/rs274_table.py`; do not edit. Every program of the shared data "
                  "and of the LinuxCNC package.\n*Accepted*: every move agrees with LinuxCNC's `rs274` to the last digit that it "
                  "prints (fanuc and sinumerik programs: with\nthe text that the script derives mechanically). *Refused*: the line, "
                  "the word and the reason; `rs274` says whether it takes the program.\n\n")
        reasons = {}
        for _, _, result in rows:
            if not result["accepted"]:
                reasons[result["refusal"]["reason"]] = reasons.get(result["refusal"]["reason"], 0) + 1
        out.write("| reason | programs |\n|---|---|\n")
        out.write(f"| accepted | {sum(r['accepted'] for _, _, r in rows)} |\n")
        for reason, count in sorted(reasons.items(), key=lambda item: -item[1]):
            out.write(f"| {reason} | {count} |\n")
        out.write("\n| program | dialect | result | rs274 |\n|---|---|---|---|\n")
        for program, dialect, result in rows:
            refusal = result["refusal"]
            what = f"accepted, {result['moves']} moves"
            if not result["accepted"]:
                word = refusal["word"].replace("|", "\\|")[:30]
                what = f"line {refusal['line']}: {refusal['reason']}" + (f" `{word}`" if word else "")
            if result["verdict"]:
                what += f" DISAGREES: {result['verdict']}"
            theirs = "accepts" if result["rs274_ok"] else "refuses: " + result["rs274"].replace("|", "/")[:60]
            out.write(f"| {short(short(os.path.abspath(program), root), os.path.abspath(here))} | {dialect} | {what} | {theirs} |\n")


if __name__ == "__main__":
    sys.exit(main())
