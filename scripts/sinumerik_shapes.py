# SPDX-License-Identifier: Apache-2.0
"""Words of sinumerik that LinuxCNC lacks, as lines, arcs and moves with numbers: CIP, AR, polar coordinates, rows and circles of
holes, deep holes, frames written as data. Evaluated here, apart from steadyrest; the manual "Fundamentals" and "Cycles" of
SINUMERIK 840D sl are the source. Plain numbers in G17, G90 and mm."""
import cmath
import math
import re

# Read without effect, or with an effect on times alone.
IDLE = (r"SOFT|BRISK|FFWON|FFWOF|DYN\w+|COMP\w+|FNORM|FLIN|STARTFIFO|STOPFIFO|STOPRE|UPATH|ORI[WM]KS|DIAMOF|WALIM\w+|"
        r"(?:[CO]TOL|ADIS|LIMS)=\S+|ACC\[\w+\]=\S+|FGROUP\(.*?\)|SETAL\(.*?\)|WORKPIECE\(.*?\)|GROUP_\w+\(.*?\)|"
        r"CYCLE832(?:\(.*?\))?|S2=\S+|M2=\S+|G64[1-5]|G62|G450|G290")
WORD = re.compile(r"([A-Z]+\d?)\s*=\s*([-+.\d]+)|([A-Z])([-+.\d]+)|\b(CIP)\b")


def deep_hole(values):
    """The levels of CYCLE83, chips broken or out: the numbers of a list of moves, '0' or '1' and the height."""
    values = [float(v) if v.strip() else 0.0 for v in values.split(",")] + [0.0] * 12
    rtp, rfp, sdis, dp, dpr, fdep, fdpr, dam, _, _, _, vari = values[:12]
    bottom = dp if not dpr else rfp - dpr
    level = fdep if not fdpr else rfp - fdpr
    moves, stroke = [("0", rfp + sdis), ("1", level)], rfp - level
    strokes, rest = [], level - bottom
    while rest > 1e-9:
        if dam and stroke > dam:
            stroke = max(stroke - dam, dam)
        if dam and dam < rest <= 2 * dam:
            strokes += [rest / 2, rest / 2]
            break
        strokes.append(min(stroke, rest))
        rest -= strokes[-1]
    for step in strokes:
        moves.append(("0", rfp + sdis) if vari else ("1", level + 1))
        if vari:
            depth = rfp - bottom
            moves.append(("0", level + (0.6 if depth <= 30 else min(depth / 50, 7))))
        level -= step
        moves.append(("1", level))
    return [f"G{kind} Z{height:.9f}" for kind, height in moves + [("0", rtp)]]


class Shapes:
    """Line by line: what the words say in plain ones. Points of the plane are complex numbers."""

    def __init__(self):
        self.at, self.pole, self.radius, self.angle, self.motion = 0j, 0j, 0.0, 0.0, "G0"

    def lines(self, line):
        try:
            return self.plain_lines(line)
        except ValueError:  # an expression: for LinuxCNC to calculate
            return [line]

    def plain_lines(self, line):
        line = re.sub(rf"(?<![\w$])({IDLE})(?!\w)", "", line)
        line = re.sub(r"\b([SM])1=", r"\1", line)  # the master spindle
        frame = re.match(r"\s*\$P_UIFR\[(\d)\]\s*=\s*CTRANS\((.*?)\)(?::CROT\(Z,(.*?)\))?", line)
        if frame:
            axes = dict(re.findall(r"([XYZ]),([-+.\d]+)", frame.group(2)))
            return [f"G10 L2 P{frame.group(1)} " + " ".join(f"{axis}{axes.get(axis, 0)}" for axis in "XYZ") + f" R{frame.group(3) or 0}"]
        holes = re.match(r"\s*HOLES([12])\((.*)\)", line)
        if holes:
            return self.holes(holes.group(1) == "1", [float(v) for v in holes.group(2).split(",")])
        words = {m.group(1) or m.group(3) or "CIP": m.group(2) or m.group(4) or "1" for m in WORD.finditer(line)}
        for pole in re.findall(r"G(11[012])", line):
            base = {"110": self.at, "111": 0j, "112": self.pole}[pole]
            self.pole = base + complex(float(words.get("X", 0)), float(words.get("Y", 0)))
            return [""]
        for motion in re.findall(r"\b(G0?[0123]|CIP)\b", line):
            self.motion = motion
        if "RP" in words or "AP" in words:
            return [self.polar(line, words)]
        end = complex(float(words.get("X", self.at.real)), float(words.get("Y", self.at.imag)))
        if "AR" in words:
            line = self.by_angle(line, words, end)
        elif self.motion == "CIP" and ("X" in words or "Y" in words):
            line = self.through(words, end)
        else:
            self.at = end
        return [line]

    def polar(self, line, words):
        self.radius = float(words.get("RP", self.radius))
        self.angle = float(words.get("AP", self.angle))
        end = self.pole + cmath.rect(self.radius, math.radians(self.angle))
        out = re.sub(r"\b[RA]P\s*=\s*[-+.\d]+", "", line) + f" X{end.real:.9f} Y{end.imag:.9f}"
        if self.motion[-1] in "23":
            arm = self.pole - self.at
            out += f" I{arm.real:.9f} J{arm.imag:.9f}"
        self.at = end
        return out

    def by_angle(self, line, words, end):
        angle = math.radians(float(words["AR"])) * (1 if self.motion[-1] == "3" else -1)
        if "I" in words or "J" in words:
            arm = complex(float(words.get("I", 0)), float(words.get("J", 0)))
            end = self.at + arm - arm * cmath.exp(1j * angle)
        # The end is the start turned about the centre c: e - c = (s - c)·exp(iα).
        turn = cmath.exp(1j * angle)
        centre = (end - self.at * turn) / (1 - turn)
        arm, self.at = centre - self.at, end
        rest = re.sub(r"\b(AR\s*=\s*[-+.\d]+|[XYIJ]=?[-+.\d]+)", "", line)
        return f"{rest} X{end.real:.9f} Y{end.imag:.9f} I{arm.real:.9f} J{arm.imag:.9f}"

    def through(self, words, end):
        way = complex(float(words["I1"]), float(words["J1"]))
        # The centre is as far from all three: the circle through 0, 1 and w after moving and turning.
        w = (end - self.at) / (way - self.at)
        arm = (way - self.at) * (w - abs(w) ** 2) / (w - w.conjugate())
        sense = "3" if w.imag > 0 else "2"
        self.at = end
        feed = f" F{words['F']}" if "F" in words else ""
        return f"G{sense} X{end.real:.9f} Y{end.imag:.9f} I{arm.real:.9f} J{arm.imag:.9f}{feed}"

    def holes(self, row, values):
        first, second, count = values[0], values[1], int(values[5])
        if row:
            places = [complex(first, second) + cmath.rect(values[3] + i * values[4], math.radians(values[2])) for i in range(count)]
            if abs(places[-1] - self.at) < abs(places[0] - self.at):
                places.reverse()
        else:
            apart = values[4] or 360 / count
            places = [complex(first, second) + cmath.rect(values[2], math.radians(values[3] + i * apart)) for i in range(count)]
        self.at = places[-1]
        return [f"G0 X{p.real:.9f} Y{p.imag:.9f}" for p in places]
