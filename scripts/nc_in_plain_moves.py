# SPDX-License-Identifier: Apache-2.0
"""Mirror image, scaling, rotation, polar coordinates, chamfers and roundings of the fanuc family, evaluated here by complex numbers
and written as plain absolute moves in G17, so that rs274 can judge how they are read. For programs in plain numbers."""
import cmath
import math
import re

FRAMES = r"G(68|69|51\.1|50\.1|51|50|16|15|100|101)(?![\d.])"


def has_frames(text):
    """Whether a program needs this."""
    return re.search(FRAMES + r"|,\s*[CR]", re.sub(r"\(.*?\)", "", text)) is not None


class Frame:
    """From the words' coordinates to work coordinates: mirror image, then scaling, then rotation."""

    def __init__(self):
        self.mirror, self.scale, self.turn = {}, None, None

    def flat(self, point):
        for axis, about in self.mirror.items():
            point = complex(2 * about - point.real, point.imag) if axis == "X" else complex(point.real, 2 * about - point.imag)
        if self.scale:
            centre, x, y = self.scale
            off = point - self.mirrored(centre)
            point = self.mirrored(centre) + complex(x * off.real, y * off.imag)
        return point

    def mirrored(self, point):
        return Frame.flat(self._only_mirror(), point)

    def _only_mirror(self):
        frame = Frame()
        frame.mirror = self.mirror
        return frame

    def sense(self):
        x, y = self.flat(1) - self.flat(0), self.flat(1j) - self.flat(0)
        return 1 if x.real * y.imag - x.imag * y.real > 0 else -1

    def __call__(self, point):
        point = self.flat(point)
        if self.turn:
            centre, angle = self.turn
            middle = self.flat(centre)
            point = middle + (point - middle) * cmath.rect(1, math.radians(angle) * self.sense())
        return point


class Plain:
    """One program, line by line."""

    def __init__(self):
        self.frame, self.here, self.incremental, self.motion = Frame(), 0j, False, "0"
        self.polar, self.radius, self.angle, self.out, self.corner = False, 0.0, 0.0, [], None

    def set_frame(self, code, words):
        centre = complex(words.get("X", 0), words.get("Y", 0))
        if code == "68":
            self.frame.turn = (centre, words["R"])
        elif code == "69":
            self.frame.turn = None
        elif code == "51":
            both = words.get("P")
            self.frame.scale = (centre, both or words.get("I", 1.0), both or words.get("J", 1.0))
        elif code == "50":
            self.frame.scale = None
        elif code in ("51.1", "101"):
            self.frame.mirror.update({axis: words[axis] for axis in "XY" if axis in words})
        elif code in ("50.1", "100"):
            named = [axis for axis in "XY" if axis in words] or list("XY")
            self.frame.mirror = {axis: at for axis, at in self.frame.mirror.items() if axis not in named}
        else:
            self.polar = code == "16"

    def end_of(self, words):
        if self.polar:
            self.radius = words.get("X", self.radius)
            self.angle = words.get("Y", 0 if self.incremental else self.angle) + (self.angle if self.incremental else 0)
            return cmath.rect(self.radius, math.radians(self.angle))
        was = self.here if self.incremental else 0
        return complex(words["X"] + was.real if "X" in words else self.here.real, words["Y"] + was.imag if "Y" in words else self.here.imag)

    def line(self, line):
        code = re.sub(r"\(.*?\)", "", line)
        words = {letter: float(value) for letter, value in re.findall(r"(?<![,\w.])([XYZIJKRPFQL])\s*([-+]?[\d.]+)", re.sub(r"(?<=[\d.])(?=[A-Z,])", " ", code))}
        spaced = re.sub(r"(?<=[\d.])(?=[A-Z,])", " ", code)
        found = re.findall(FRAMES, code)
        if found:
            for frame in found:
                self.set_frame(frame, words)
            rest = re.sub(FRAMES, "", spaced)
            if any(frame in ("68", "51", "51.1", "50.1", "100", "101") for frame in found):
                return
            spaced = code = rest
        self.incremental = "G91" in code or (self.incremental and "G90" not in code)
        motion = re.search(r"G0?([0123])(?![\d.])", code)
        self.motion = motion.group(1) if motion else self.motion
        moves = "X" in words or "Y" in words or "I" in words or "J" in words
        if not moves or re.search(r"G(28|53|10|52|92)(?!\d)", code):
            self.out.append(re.sub(r"G9[01](?!\d)", "", spaced))
            return
        corner = re.search(r",\s*([CR])\s*([\d.]+)", spaced)
        kept = re.sub(r",\s*[CR]\s*[\d.]+|G9[01](?!\d)|(?<![A-Z])[XYIJ]\s*[-+]?[\d.]+", "", spaced)
        start, end = self.frame(self.here), self.end_of(words)
        at = self.frame(end)
        cycle = re.search(r"G8\d|G7[346]", code)
        arc = self.motion in "23" and not cycle
        if arc:
            if self.frame.sense() < 0:
                kept = re.sub(r"G0?([23])(?![\d.])", "", kept) + " G" + {"2": "3", "3": "2"}[self.motion]
            if "R" in words:
                grown = abs(self.frame(1) - self.frame(0))
                kept = re.sub(r"R\s*[-+]?[\d.]+", f"R{words['R'] * grown:.9f}", kept)
            else:
                centre = self.frame(self.here + complex(words.get("I", 0), words.get("J", 0))) - start
                kept += f" I{centre.real:.9f} J{centre.imag:.9f}"
        self.move(kept, start, at, corner, arc)
        self.here = end

    def move(self, kept, start, end, corner, arc):
        """A corner between lines: both ends are r·tan(φ/2), or c, from where they meet."""
        if self.corner and not arc:
            first, begin, meet, kind, size = self.corner
            into, away = (meet - begin) / abs(meet - begin), (end - meet) / abs(end - meet)
            turn = cmath.phase(away / into)
            cut = size if kind == "C" else size * math.tan(abs(turn) / 2)
            a, b = meet - into * cut, meet + away * cut
            self.out.append(f"{first} X{a.real:.9f} Y{a.imag:.9f}")
            self.out.append(f"G1 X{b.real:.9f} Y{b.imag:.9f}" if kind == "C"
                            else f"G{3 if turn > 0 else 2} X{b.real:.9f} Y{b.imag:.9f} R{size:.9f}")
            kept, start = "G1 " + re.sub(r"G0?1(?![\d.])", "", kept), b
        self.corner = (kept, start, end, corner.group(1), float(corner.group(2))) if corner else None
        if not corner:
            self.out.append(f"{kept} X{end.real:.9f} Y{end.imag:.9f}")


def plain_moves(text):
    """The program's lines in absolute words of plain moves."""
    plain = Plain()
    for line in text.splitlines():
        plain.line(line)
    return plain.out


def pecks_with_dwell(text):
    """G83 with P, which LinuxCNC has not, as the moves of each hole: absolute words, G98."""
    if not re.search(r"G83[^\n]*P", text):
        return text
    out, row, level = [], None, "0"
    for line in text.splitlines():
        code = re.sub(r"\(.*?\)", "", line)
        words = dict(re.findall(r"([XYZRPQF])\s*([-+]?[\d.]+)", code))
        if "G83" in code:
            row = {**words}
        elif "G80" in code or re.search(r"G0?[01](?!\d)", code):
            row = None
        if row is None or not ("X" in words or "Y" in words):
            level = words.get("Z", level) if row is None else level
            out.append(line)
            continue
        row.update(words)
        top, bottom, peck = float(row["R"]), float(row["Z"]), float(row["Q"])
        out += [f"F{row['F']}", "G61", f"G0 X{row['X']} Y{row['Y']}", f"G0 Z{top}"]
        depth = top - peck
        while depth > bottom:
            out += [f"G1 Z{depth:.9f}", f"G0 Z{top}", f"G0 Z{depth + 0.254:.9f}"]
            depth -= peck
        out += [f"G1 Z{bottom}", f"G4 P{float(row['P']) / 1000}", f"G0 Z{level}"]
    return "\n".join(out)
