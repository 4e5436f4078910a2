# SPDX-License-Identifier: Apache-2.0
"""LinuxCNC's interpreter `rs274` and `steadyrest program moves` on one program, and the first place where they differ."""
import csv
import json
import os
import re
import shutil
import subprocess
import tempfile
import threading

from nc_programs import script_parser

MM_PER_INCH = 25.4
HALF_DIGIT = 0.00005  # rs274 prints four decimals
TOOLS = "".join(f"T{n} P{n} Z{n * 0.5:g} D{n * 0.05:g}\n" for n in range(1, 100))  # inches: rs274's own unit
CALL = re.compile(r"^\s*\d+ N\S*\s+([A-Z_0-9]+)\((.*)\)\s*$")
SHIFTS = ("USE_LENGTH_UNITS", "SET_G5X_OFFSET", "SET_G92_OFFSET", "SET_XY_ROTATION", "USE_TOOL_LENGTH_OFFSET")
KINDS = {"STRAIGHT_TRAVERSE": "rapid", "STRAIGHT_FEED": "linear", "ARC_FEED": "arc", "DWELL": "dwell", "STRAIGHT_PROBE": "probe"}


def numbers(text):
    return [float(part) for part in re.split(r"[,\s]+", text) if re.fullmatch(r"-?(\d+\.?\d*|\.\d+)", part)]


def oracle_parser(doc):
    parser = script_parser(doc)
    parser.add_argument("--rs274", default="rs274")
    return parser


def installed(rs274):
    if shutil.which(rs274) is None:
        print("rs274 is not installed (Debian: linuxcnc-uspace)")
        return False
    return True


class Oracle:
    """rs274 in a temporary folder that is also its home: it writes into its tool table, its variable file and
    `$HOME/.tool.mmap`, which two that run at once would share."""

    def __init__(self, rs274="rs274", variables=""):
        self.rs274 = rs274
        self.folder = tempfile.mkdtemp(prefix="rs274-")
        self.variables = variables
        self.tools = TOOLS

    def path(self, name):
        return os.path.join(self.folder, name)

    def close(self):
        shutil.rmtree(self.folder)

    def fresh(self):
        with open(self.path("tool.tbl"), "w") as out:
            out.write(self.tools)
        with open(self.path("my.var"), "w") as out:
            out.write(self.variables)

    def run(self, program):
        """(accepted, message, list of (kind, numbers, unit_mm, feed_mm_min))"""
        self.fresh()
        done = subprocess.run([self.rs274, "-g", "-t", self.path("tool.tbl"), "-v", self.path("my.var"), os.path.abspath(program)],
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=120,
                              cwd=os.path.dirname(os.path.abspath(program)),  # where it looks for subprograms
                              env={**os.environ, "HOME": self.folder})
        lines = done.stdout.decode("latin-1").splitlines()
        moves, unit, plane, feed, noise = [], 1.0, "XY", 0.0, []
        sync, stands = None, []  # stands: the end printed last, while its numbers still mean the same place
        for line in lines:
            call = CALL.match(line)
            if not call:
                noise.append(line.strip())
                continue
            name, values = call.group(1), call.group(2)
            if name in SHIFTS:
                stands = []
            if name == "USE_LENGTH_UNITS":
                unit = MM_PER_INCH if "INCHES" in values else 1.0
            elif name == "SELECT_PLANE":
                plane = values[-2:]
            elif name == "SET_FEED_RATE":
                feed = (float(values), unit)
            elif name == "START_SPEED_FEED_SYNC":
                sync = float(values.split(",")[0])
            elif name == "STOP_SPEED_FEED_SYNCH":
                sync = None
            elif name == "NURBS_FEED":
                moves.append(("spline", [], unit, plane, feed))
                stands = []
            elif name == "RIGID_TAP":  # in and out again
                back = stands
                moves.append(("thread", numbers(values)[:3], unit, plane, feed))
                moves.append(("thread", back, unit, plane, feed))
            elif name in KINDS:
                kind = "thread" if sync is not None and name == "STRAIGHT_FEED" else KINDS[name]
                moves.append((kind, numbers(values), unit, plane, feed))
                if kind != "dwell":
                    stands = numbers(values)[:3] if kind in ("rapid", "linear", "thread") else []
        errors = (done.stderr.decode("latin-1").strip().splitlines() + [n for n in noise if n])
        errors = [e for e in errors if e and e != "executing"]
        return done.returncode == 0, (errors[0] if errors else ""), moves


def ours(steadyrest, program, dialect, oracle, extra=()):
    """(accepted, first refusal, rows)"""
    # Through a pipe, which also has the moves before a refusal; a file is written only at the end.
    end, entry = os.pipe()
    moves = []
    with open(end, encoding="utf-8") as source:
        reader = threading.Thread(target=lambda: moves.extend(source.readlines()))
        reader.start()
        try:
            done = subprocess.run([steadyrest, "program", "moves", program, "--dialect", dialect, "--json",
                                   "-o", f"/dev/fd/{entry}",
                                   # sinumerik has its tools by name
                                   *([] if dialect == "sinumerik" else ["--tools", oracle.path("tool.tbl"), "--data-units", "inch"]),
                                   *extra],
                                  capture_output=True, timeout=120, pass_fds=[entry])
        finally:
            os.close(entry)
            reader.join()
    answer = json.loads(done.stdout)
    if "blocks" not in answer:
        raise RuntimeError(str(answer))
    rows = list(csv.DictReader(moves))
    return done.returncode == 0, (answer["refused"] or [None])[0], rows, answer["blocks"]


def end_of(kind, values, plane):
    """x y z a b c, centre, turns as rs274 printed them"""
    if kind != "arc":
        return dict(zip("xyzabc", values)), {}, None
    first, second, c1, c2, turns, height, a, b, c = values
    axes = {"XY": "xyz", "XZ": "zxy", "YZ": "yzx"}[plane]
    end = {axes[0]: first, axes[1]: second, axes[2]: height, "a": a, "b": b, "c": c}
    return end, {axes[0]: c1, axes[1]: c2}, int(turns)


def differs(printed, ours_mm, unit):
    """Whether rs274's printed number is not ours, to the last digit that it prints."""
    value = ours_mm / unit
    return abs(printed - value) > HALF_DIGIT + 1e-9 * max(1.0, abs(value))


def compare(moves, rows):
    """'' or the first difference."""
    for index, (move, row) in enumerate(zip(moves, rows)):
        kind, values, unit, plane, feed = move
        where = f"move {index + 1}, line {row['line']}"
        if kind != row["kind"]:
            return f"{where}: rs274 {kind}, ours {row['kind']}"
        if kind in ("dwell", "spline"):
            continue
        end, centre, turns = end_of(kind, values, plane)
        for axis, printed in end.items():
            rotary = axis in "abc"
            mine = float(row[axis + ("_deg" if rotary else "_mm")])
            if differs(printed, mine, 1.0 if rotary else unit):
                return f"{where}: {axis} rs274 {printed}, ours {mine / (1.0 if rotary else unit)}"
        for axis, printed in centre.items():
            mine = float(row[{"x": "i", "y": "j", "z": "k"}[axis] + "_mm"])
            if differs(printed, mine, unit):
                return f"{where}: centre {axis} rs274 {printed}, ours {mine / unit}"
        if turns is not None and turns != int(row["turns"]):
            return f"{where}: turns rs274 {turns}, ours {row['turns']}"
        if kind in ("linear", "arc") and row["feed_mm_min"] and feed:
            rate, feed_unit = feed
            mine = float(row["feed_mm_min"])
            candidates = {feed_unit, 1.0}  # degrees/min are not scaled
            if all(differs(rate, mine, one) for one in candidates) and row["per_rev"] != "1":
                return f"{where}: feed rs274 {rate}, ours {mine / feed_unit}"
    if len(moves) != len(rows):
        return f"rs274 has {len(moves)} moves, ours {len(rows)}"
    return ""


def judge(steadyrest, oracle, program, dialect="linuxcnc", equivalent=None, extra=()):
    """dict: accepted, verdict, moves, reason, rs274"""
    theirs_ok, message, moves = oracle.run(equivalent or program)
    oracle.fresh()
    ours_ok, refusal, rows, blocks = ours(steadyrest, program, dialect, oracle, extra)
    text = open(program, errors="replace").read()
    per_revolution = "1" if re.search(r"[gG]0*95(?!\d)", re.sub(r"[ \t]", "", text)) else "0"
    for row in rows:
        row["per_rev"] = per_revolution
    verdict = ""
    if ours_ok and theirs_ok:
        verdict = compare(moves, rows)
    elif ours_ok:
        verdict = f"rs274 refuses: {message}"
    else:
        # everything executed before the refusal must agree too
        common = min(len(moves), len(rows))
        verdict = compare(moves[:common], rows[:common])
    return {"accepted": ours_ok, "verdict": verdict, "moves": len(rows), "blocks": blocks,
            "refusal": refusal, "rs274_ok": theirs_ok, "rs274": message}


def tool_length_in_change(text):
    """rs274 alone re-reads its position after M6 and does not take the tool's length off: a block with M6 and G43, or M6
    while a length is in force, leaves it at another Z than a machine. Such programs are compared with lengths of zero."""
    return re.search(r"[mM]0*6(?!\d)", text) is not None
