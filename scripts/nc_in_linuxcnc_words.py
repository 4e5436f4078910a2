# SPDX-License-Identifier: Apache-2.0
"""A fanuc or sinumerik program in LinuxCNC's words, derived mechanically where the meaning is the same, so that rs274 can
judge how it is read."""
import re

from nc_in_plain_moves import has_frames, pecks_with_dwell, plain_moves


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


def haas_words(text):
    """Words that move nothing go; a dwell without a point is in milliseconds; a cycle taps rigidly."""
    text = re.sub(r"G(187|103|5\.1|8)(?![\d.])[^\n(]*", "", text)
    text = re.sub(r"M(31|33|83|84|88|89|10|11|80|81)(?!\d)", "", text)
    return re.sub(r"G0*4 ?P(\d+)(?![\d.])", lambda m: f"G4 P{int(m.group(1)) / 1000}", text)


def equivalent_of(program, dialect, oracle):
    """The same program in LinuxCNC's words, derived mechanically, where the meaning is common; None where it is not."""
    text = open(program, errors="replace").read()
    if dialect in ("grbl", "mach3"):
        lines = [re.sub(r";.*|[?~]", "", re.sub(r"\(.*\)", "", line)) for line in text.splitlines() if not re.match(r"\s*[$%?~]", line)]
        body = "\n".join(lines) + "\nM2\n"
    elif dialect in ("fanuc", "haas"):
        if dialect == "haas":
            text = haas_words(text)
        text = pecks_with_dwell(re.sub(r"M1[01](?!\d)", "", text))
        if has_frames(text):
            text = "\n".join(plain_moves(text))
        text = re.sub(r"(?im)^(.*?)G0*([01])?\s*(G91)?\s*G0*28", lambda m: m.group(0), text)
        lines = []
        for line in text.splitlines():
            code = re.sub(r"\(.*?\)", "", line)
            if re.search(r"G0*28", code):  # there a G0 with G28 only sets the mode
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
