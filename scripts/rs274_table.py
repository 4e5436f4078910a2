#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares `steadyrest program moves` with LinuxCNC's interpreter `rs274` and writes the table of what is
accepted and what is refused.

    scripts/rs274_table.py [--steadyrest build/release/bin/steadyrest] [--data ../shared/data/nc]
                           [--linuxcnc /usr/share/linuxcnc …] [-o docs/nc-coverage.md]

Needs `rs274` (Debian: linuxcnc-uspace). Every number that rs274 prints is compared to its last digit.
Exit code 1 when one file disagrees.
"""
import argparse
import csv
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading

MM_PER_INCH = 25.4
HALF_DIGIT = 0.00005  # rs274 prints four decimals
TOOLS = "".join(f"T{n} P{n} Z{n * 0.5:g} D{n * 0.05:g}\n" for n in range(1, 100))  # inches: rs274's own unit
CALL = re.compile(r"^\s*\d+ N\S*\s+([A-Z_0-9]+)\((.*)\)\s*$")
SHIFTS = ("USE_LENGTH_UNITS", "SET_G5X_OFFSET", "SET_G92_OFFSET", "SET_XY_ROTATION", "USE_TOOL_LENGTH_OFFSET")
KINDS = {"STRAIGHT_TRAVERSE": "rapid", "STRAIGHT_FEED": "linear", "ARC_FEED": "arc", "DWELL": "dwell", "STRAIGHT_PROBE": "probe"}


def numbers(text):
    return [float(part) for part in re.split(r"[,\s]+", text) if re.fullmatch(r"-?[\d.]+", part)]


class Oracle:
    """rs274 in a folder and a home of its own: it writes into its tool table, its variable file and `$HOME/.tool.mmap`,
    which two that run at once would share."""

    def __init__(self, rs274="rs274", variables=""):
        self.rs274 = rs274
        self.folder = tempfile.mkdtemp(prefix="rs274-")
        self.variables = variables

    def path(self, name):
        return os.path.join(self.folder, name)

    def close(self):
        shutil.rmtree(self.folder)

    def fresh(self):
        with open(self.path("tool.tbl"), "w") as out:
            out.write(TOOLS)
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
        sync, stands = None, []  # stands: the end printed last, while its numbers mean the same place
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
    # Through a pipe, which has the moves in front of a refusal too; a file is written when all is read.
    end, entry = os.pipe()
    moves = []
    with open(end, encoding="utf-8") as source:
        reader = threading.Thread(target=lambda: moves.extend(source.readlines()))
        reader.start()
        try:
            done = subprocess.run([steadyrest, "program", "moves", program, "--dialect", dialect, "--json",
                                   "-o", f"/dev/fd/{entry}",
                                   *([] if dialect == "sinumerik" else ["--tools", oracle.path("tool.tbl")]),  # by name
                                   "--data-units", "inch", *extra],
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
        # what was executed before the refusal must agree as well
        common = min(len(moves), len(rows))
        verdict = compare(moves[:common], rows[:common])
    return {"accepted": ours_ok, "verdict": verdict, "moves": len(rows), "blocks": blocks,
            "refusal": refusal, "rs274_ok": theirs_ok, "rs274": message}



def tool_length_in_change(text):
    """rs274 alone re-reads its position after M6 and does not take the tool's length off: a block with M6 and G43, or M6
    while a length is in force, leaves it at another Z than a machine. Such programs are compared with lengths of zero."""
    return re.search(r"[mM]0*6(?!\d)", text) is not None


def value_at(line, at):
    """Where the value ends that begins at `at`: signs, then #…, [ ] or a function with its brackets."""
    while line[at] in "+- ":
        at += 1
    while line[at] not in "[" and (line[at].isalnum() or line[at] in "#."):
        at += 1
        if at == len(line):
            return at
    depth = 0
    while at < len(line) and line[at] == "[" or depth:
        depth += {"[": 1, "]": -1}.get(line[at], 0)
        at += 1
    return at


def macro_line(line, inch):
    """A line with custom macros in LinuxCNC's words: what an address takes is rounded to its increment; #4003 and #5001 … have
    other numbers; M98 has no repeats in P."""
    scale = 10000 if inch else 1000
    line = re.sub(r"#(50[04]\d)", lambda m: f"#{int(m.group(1)) - 5001 + 5420}", line)
    line = line.replace("#4003", "[90+#<_incremental>]")
    line = re.sub(r"M98\s*P(\d+)(\d{4})(?!\d)", lambda m: f"M98 P{int(m.group(2))}" + (f" L{int(m.group(1))}" if int(m.group(1)) else ""), line)
    line = re.sub(r"^(\s*)[:O]0*(\d+)", r"\1O\2", line)
    line = re.sub(r"ATAN\[([^][,]*)\](?!/)", r"ATAN[\1]/[1]", line)
    if re.match(r"\s*(N\d+\s*)?#", line):
        return re.sub(r"=(.*)$", lambda m: f"=[{m.group(1)}]", line)
    out, at = "", 0
    while at < len(line):
        word = re.compile(r"([XYZABCIJKRQ])(?=\s*[-+]?\s*[#\[])").match(line, at)
        if word:
            end = value_at(line, word.end())
            out += f"{word.group(1)}[ROUND[[{line[word.end():end]}]*{scale}]/{scale}]"
            at = end
        else:
            out += line[at]
            at += 1
    return out


def closing(text, at):
    """The place of the bracket that closes the one at `at`."""
    depth = 0
    for index in range(at, len(text)):
        depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(text[index], 0)
        if depth == 0:
            return index
    return len(text) - 1


def sinumerik_value(text, names):
    """An expression in LinuxCNC's words: R1 is #1001, a variable #<name>, ( ) are [ ]."""
    out, at = "", 0
    while at < len(text):
        word = re.compile(r"[A-Za-z_][A-Za-z_0-9]*").match(text, at)
        if word:
            name, at = word.group(0).upper(), word.end()
            opens = at < len(text) and text[at] in "(["
            inner = text[at + 1:closing(text, at)] if opens else ""
            if re.fullmatch(r"R\d+", name):
                out += f"#{1000 + int(name[1:])}"
                continue
            if name in names:
                out += f"#<{name}>"
                continue
            if opens:
                at = closing(text, at) + 1
                parts = [sinumerik_value(part, names) for part in inner.split(",")]
                out += (f"#[1000+[{parts[0]}]]" if name == "R" else f"[[{parts[0]}]**2]" if name == "POT"
                        else f"ATAN[{parts[0]}]/[{parts[1]}]" if name == "ATAN2"
                        else f"{'FIX' if name == 'TRUNC' else name}[{parts[0]}]")
                continue
            out += f" {name} "
            continue
        out += {"(": "[", ")": "]"}.get(text[at], text[at])
        at += 1
    return out


def sinumerik_drilling(name, values, names):
    """The moves that the manual gives for CYCLE81 and CYCLE82."""
    rtp, rfp, sdis, dp, dpr, dwell = ([sinumerik_value(v, names) if v.strip() else None for v in values.split(",")] + [None] * 6)[:6]
    bottom = f"[{rfp}]-[{dpr}]" if dp is None else dp
    lines = [f"G0 Z[[{rfp}]+[{sdis or 0}]]", f"G1 Z[{bottom}]"]
    if name.upper() == "CYCLE82" and dwell is not None:
        lines.append(f"G4 P[{dwell}]")
    return lines + [f"G0 Z[{rtp}]"]


def sinumerik_frame(frame, names):
    """TRANS, ATRANS, ROT, AROT as G10 L2; the frame is kept in parameters, which LinuxCNC calculates."""
    adds, turns = frame.group(1) == "A", frame.group(2) == "ROT"
    words = {name: sinumerik_value(value, names) for name, value in re.findall(r"(RPL|[XYZ])\s*=?\s*(\S+)", frame.group(3))}
    out = [] if adds else [f"#<_f{axis}>=0" for axis in "xyzr"]
    if turns:
        out += [f"#<_fr>=[#<_fr>+[{value}]]" for value in words.values()]
    else:
        x, y, z = (words.get(axis, "0") for axis in "XYZ")
        out += [f"#<_fx>=[#<_fx>+[{x}]*COS[#<_fr>]-[{y}]*SIN[#<_fr>]]", f"#<_fy>=[#<_fy>+[{x}]*SIN[#<_fr>]+[{y}]*COS[#<_fr>]]",
                f"#<_fz>=[#<_fz>+[{z}]]"]
    return out + ["G10 L2 P1 X#<_fx> Y#<_fy> Z#<_fz> R#<_fr>"]


def sinumerik_lines(lines):
    """Variables, expressions and drilling cycles in LinuxCNC's words, line by line."""
    names, out, modal = set(), [], []
    for line in lines:
        line = re.sub(r"^\s*(N\d+)?\s*(%_N_.*|SETMS.*|TRAFOOF|CYCLE800\(\))?", "", line.rstrip())
        define = re.match(r"(?i)DEF\s+(REAL|INT|BOOL)\s+(.*)", line)
        if define:
            for part in re.split(r",(?![^(]*\))", define.group(2)):
                name, _, value = (piece.strip() for piece in part.partition("="))
                value = sinumerik_value(value or "0", names)
                names.add(name.upper())
                out.append(f"#<{name}>=" + (f"ROUND[{value}]" if define.group(1).upper() == "INT" else f"[{value}]"))
            continue
        frame = re.match(r"\s*(A?)(TRANS|ROT)\b(.*)", line)
        if frame:
            out += sinumerik_frame(frame, names)
            continue
        call = re.match(r"(?i)(MCALL)?\s*(CYCLE8[12])\((.*)\)\s*$", line)
        if call or re.match(r"(?i)MCALL\s*$", line):
            moves = sinumerik_drilling(call.group(2), call.group(3), names) if call else []
            if call and not call.group(1):
                out += moves
            else:
                modal = moves
            continue
        result, at, moves = "", 0, False
        while at < len(line):
            word = re.compile(r"([A-Za-z_][A-Za-z_0-9]*)\s*=").match(line, at) or re.compile(r"(R\[.*?\])\s*=").match(line, at)
            if not word:
                moves = moves or (line[at] in "XYZ" and line[at + 1:at + 2].isnumeric())
                result += line[at]
                at += 1
                continue
            end, depth = word.end(), 0  # to the blank that ends it
            while end < len(line) and (depth or not re.match(r"\s+(?!DIV|MOD|AND|OR)", line[end:])):
                depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(line[end], 0)
                end += 1
            name, value, at = word.group(1).upper(), line[word.end():end], end
            moves = moves or name in ("X", "Y", "Z")
            if re.fullmatch(r"R\d+|R\[.*\]", name) or name in names:
                out.append(f"{sinumerik_value(word.group(1), names)}=[{sinumerik_value(value, names)}]")
                continue
            way = re.match(r"(?i)\s*(AC|IC)\((.*)\)$", value)
            if way and name in "XYZ" and way.group(1).upper() == "IC":
                result += f"{name}[#{5420 + 'XYZ'.index(name)}+[{sinumerik_value(way.group(2), names)}]]"
                continue
            value = sinumerik_value(way.group(2) if way else value, names)
            if way and name in "IJK":
                value = f"[{value}]-#{5420 + 'IJK'.index(name)}"
            result += {"CR": f"R[{value}]", "TURN": f"P[[{value}]+1]"}.get(name, f"{name}[{value}]")
        out.append(result)
        out += modal if moves else []
    return out


def equivalent_of(program, dialect, oracle):
    """The same program in LinuxCNC's words, derived mechanically, where the meaning is common; None where it is not."""
    text = open(program, errors="replace").read()
    if dialect == "fanuc":
        text = re.sub(r"(?im)^(.*?)G0*([01])?\s*(G91)?\s*G0*28", lambda m: m.group(0), text)
        lines = []
        for line in text.splitlines():
            code = re.sub(r"\(.*?\)", "", line)
            if re.search(r"G0*28", code):  # there G0 beside G28 only sets the mode
                line = re.sub(r"G0*[01](?![\d.])", "", line, count=1)
            if re.search(r"G28.*G91|G91.*G28", code):
                lines.append("G91")
            inch = re.search(r"G20(?!\d)", text) is not None
            macros = "#" in re.sub(r"\(.*?\)", "", text) or re.search(r"M98", text)
            lines.append(macro_line(re.sub(r"\(.*?\)", "", line), inch) if macros else line)
        body = "\n".join(lines) + "\n"
        body = body.replace("%\n", "%\nG98\n", 1) if body.startswith("%") else "G98\n" + body
    else:
        lines = []
        text = re.sub(r";.*", "", text)
        if re.search(r"(?m)^\s*(N\d+\s*)?(DEF|R\d+|R\[|M?CALL|CYCLE|SETMS|TRAFOOF|A?TRANS|A?ROT|%_N_)", text):
            text = "\n".join(sinumerik_lines(re.sub(r'MSG\(.*?\)|T="[^"]*"', lambda m: "T1" * (m.group(0)[0] == "T"), text).splitlines()))
            text = text.replace("SUPA", "G53")
        for line in text.splitlines():
            line = re.sub(r";(.*)", "", line)
            line = re.sub(r'(?i)MSG\(.*?\)|\bFNORM\b|\bSOFT\b|\bG60[123]\b', "", line)
            line = re.sub(r'(?i)T="[^"]*"', "T1", line)
            line = re.sub(r"(?i)\bCR\s*=\s*", "R", line)
            line = re.sub(r"(?i)\bTURN\s*=\s*(\d+)", lambda m: f"P{int(m.group(1)) + 1}", line)
            line = re.sub(r"(?i)([XYZABCIJKF])=", r"\1", line)
            line = re.sub(r"(?i)\bG4\s*F", "G4 P", line)
            line = re.sub(r"(?i)\bG71\b|\bG710\b", "G21", line)
            line = re.sub(r"(?i)\bG700\b", "G20", line)
            line = re.sub(r"(?i)\bD1\b", "G43", line)
            line = re.sub(r"(?i)\bD0\b", "G49", line)
            line = re.sub(r"(?i)\bG60\b", "G61.1", line)
            lines.append(line)
        body = "\n".join(lines) + "\n"
    path = oracle.path("equivalent.ngc")
    with open(path, "w") as out:
        out.write(body)
    return path


def programs(folders):
    for folder in folders:
        for where, _, names in sorted(os.walk(folder)):
            for name in sorted(names):
                if name.lower().endswith((".ngc", ".nc", ".gcode", ".tap", ".ncf", ".eia", ".mpf")):
                    yield os.path.join(where, name)


def dialect_of(program):
    folder = os.path.basename(os.path.dirname(os.path.abspath(program)))
    if folder in ("linuxcnc", "fanuc", "sinumerik") and os.sep + "accepted" + os.sep in os.path.abspath(program):
        return folder
    if program.lower().endswith(".mpf"):
        return "sinumerik"
    if program.endswith((".NC", ".NCF", ".EIA")):
        return "fanuc"
    return "linuxcnc"


def sample(found, most):
    """Of each dialect `most` short programs, evenly out of the list; all of them without `most`. For builds that are slow."""
    if most is None:
        return found
    out = []
    for dialect in ("linuxcnc", "fanuc", "sinumerik"):
        brief = [program for program in found if dialect_of(program) == dialect and os.path.getsize(program) <= 30_000]
        out += brief[::max(1, len(brief) // most)][:most]
    return out


def short(path, root):
    return os.path.relpath(path, root) if path.startswith(root + os.sep) else path


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steadyrest", default="build/release/bin/steadyrest")
    parser.add_argument("--data", default=os.path.join(os.environ.get("STEADYREST_SHARED_DATA", "../shared/data"), "nc"))
    parser.add_argument("--linuxcnc", nargs="*", default=["/usr/share/linuxcnc", "/usr/share/doc/linuxcnc/examples"])
    parser.add_argument("--most", type=int, help="only so many short programs of each dialect, and our own")
    parser.add_argument("-o", "--output", help="write the table to this file")
    parser.add_argument("files", nargs="*", help="only these programs")
    arguments = parser.parse_args()
    if shutil.which("rs274") is None:
        print("rs274 is not installed (Debian: linuxcnc-uspace)")
        return 77
    own = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests", "accepted", "nc")
    found = list(programs([own])) + sample(list(programs([arguments.data])) + list(programs(arguments.linuxcnc)), arguments.most)
    if not arguments.files and not list(programs([arguments.data])):
        print("no programs in", arguments.data)
        return 77
    seen, rows, bad = set(), [], 0
    oracle = Oracle()
    for program in arguments.files or found:
        content = open(program, "rb").read()
        if content in seen:
            continue
        seen.add(content)
        dialect = dialect_of(program)
        global TOOLS
        lengths = TOOLS
        if tool_length_in_change(content.decode("latin-1")):
            TOOLS = re.sub(r"Z\S+", "Z0", TOOLS)
        try:
            equivalent = equivalent_of(program, dialect, oracle) if dialect != "linuxcnc" else None
            result = judge(os.path.abspath(arguments.steadyrest), oracle, program, dialect, equivalent)
        except subprocess.TimeoutExpired:
            result = {"accepted": False, "verdict": "", "moves": 0, "blocks": 0, "rs274_ok": False,
                      "refusal": {"line": 0, "word": "", "reason": "time", "text": ""}, "rs274": "did not end in 120 s"}
        TOOLS = lengths
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
