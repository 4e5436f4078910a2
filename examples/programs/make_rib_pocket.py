#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes rib-pocket.ngc (LinuxCNC) and rib-pocket.mpf (SINUMERIK): a pocket of an aircraft rib.

Tool centre paths, mm, end mill of 4 mm. What the part holds:
  - a helix down into the middle, then a spiral of half circles, radii 2 to 24 mm
  - two offset passes and one finishing pass along an outline with fillets of 2 to 40 mm, convex and concave
  - tangential quarter-circle lead-in and lead-out
  - a lightening hole of 6 mm radius milled with a full circle, four drilled holes
  - a lettering-like run of short chords on a 15 mm radius, as CAM systems write arcs

Usage: make_rib_pocket.py [FOLDER]   (default: the folder of this script)
"""
import math
import pathlib
import sys

# Corners of the finishing path (tool centre), counter-clockwise, with the fillet radius of each.
OUTLINE = [
    ((0.0, 0.0), 8.0),
    ((62.0, -6.0), 40.0),
    ((128.0, 0.0), 3.0),
    ((132.0, 34.0), 12.0),
    ((110.0, 44.0), 5.0),
    ((116.0, 82.0), 2.0),
    ((64.0, 74.0), 20.0),
    ((10.0, 86.0), 4.0),
    ((-6.0, 46.0), 30.0),
]
DEPTHS = (-2.0, -4.0)
FEED_ROUGH, FEED_FINISH, FEED_PLUNGE = 3000, 2400, 600
HOLES = [(12.0, 14.0), (112.0, 16.0), (94.0, 60.0), (16.0, 62.0)]


def offset_corners(inward):
    """The outline moved inward; fillets of convex corners shrink, of concave corners grow."""
    n = len(OUTLINE)
    lines = []
    for i in range(n):
        (x0, y0), (x1, y1) = OUTLINE[i][0], OUTLINE[(i + 1) % n][0]
        length = math.hypot(x1 - x0, y1 - y0)
        tx, ty = (x1 - x0) / length, (y1 - y0) / length
        lines.append((x0 - ty * inward, y0 + tx * inward, tx, ty))
    corners = []
    for i in range(n):
        px, py, ux, uy = lines[i - 1]
        qx, qy, vx, vy = lines[i]
        cross = ux * vy - uy * vx
        s = ((qx - px) * vy - (qy - py) * vx) / cross
        radius = OUTLINE[i][1] - inward if cross > 0 else OUTLINE[i][1] + inward
        corners.append(((px + s * ux, py + s * uy), max(radius, 2.0)))
    return corners


def contour(corners):
    """Blocks of the closed contour: starts and ends in the middle of the first edge."""
    n = len(corners)
    mid = tuple((corners[0][0][k] + corners[1][0][k]) / 2 for k in (0, 1))
    blocks = []
    for i in [*range(1, n), 0]:
        (px, py), (x, y), (qx, qy) = corners[i - 1][0], corners[i][0], corners[(i + 1) % n][0]
        radius = corners[i][1]
        a, b = math.hypot(x - px, y - py), math.hypot(qx - x, qy - y)
        ux, uy, vx, vy = (x - px) / a, (y - py) / a, (qx - x) / b, (qy - y) / b
        cross = ux * vy - uy * vx
        turn = math.atan2(cross, ux * vx + uy * vy)
        cut = radius * math.tan(abs(turn) / 2)
        side = math.copysign(1.0, cross)
        blocks.append(("line", x - cut * ux, y - cut * uy))
        blocks.append(("left" if cross > 0 else "right", x + cut * vx, y + cut * vy,
                       -uy * radius * side, ux * radius * side))
    blocks.append(("line", *mid))
    return mid, blocks


class Program:
    """Collects blocks and writes them in one dialect."""

    def __init__(self, dialect):
        self.sinumerik = dialect == "sinumerik"
        self.text = []
        self.number = 0

    def raw(self, block):
        self.number += 10
        self.text.append(f"N{self.number} {block}")

    def comment(self, words):
        self.text.append(f"; {words}")

    def tool(self, number, speed):
        self.raw(f"T{number} M6")
        self.raw("D1" if self.sinumerik else f"G43 H{number}")
        self.raw(f"S{speed} M3")

    def rapid(self, x=None, y=None, z=None):
        self.raw("G0" + words(X=x, Y=y, Z=z))

    def feed(self, feed, x=None, y=None, z=None):
        self.raw("G1" + words(X=x, Y=y, Z=z) + (f" F{feed}" if feed else ""))

    def follow(self, blocks, feed):
        self.text.append(f"; feed {feed} mm/min")
        self.raw(f"F{feed}")
        for block in blocks:
            if block[0] == "line":
                self.raw("G1" + words(X=block[1], Y=block[2]))
            else:
                code = "G3" if block[0] == "left" else "G2"
                self.raw(code + words(X=block[1], Y=block[2], I=block[3], J=block[4]))


def words(**values):
    return "".join(f" {k}{v:.4f}" for k, v in values.items() if v is not None)


def lead(mid, tangent, radius, leaving):
    """Quarter circle that meets the contour tangentially at `mid`, from or to its inner side (left)."""
    tx, ty = tangent
    nx, ny = -ty, tx
    if leaving:
        return ("left", mid[0] + radius * (tx + nx), mid[1] + radius * (ty + ny), radius * nx, radius * ny)
    start = (mid[0] + radius * (nx - tx), mid[1] + radius * (ny - ty))
    return start, ("left", *mid, radius * tx, radius * ty)


def spiral(program, centre, depth):
    """Half circles of growing radius, 2 mm to 24 mm."""
    x, y = centre
    program.rapid(x + 2.0, y)
    program.rapid(z=1.0)
    program.feed(FEED_PLUNGE, z=0.0)
    program.raw(f"F{FEED_ROUGH}")
    for turn in range(1, 5):
        program.raw("G3" + words(X=x + 2.0, Y=y, Z=depth * turn / 4, I=-2.0, J=0.0))
    at, side, radius = x + 2.0, -1.0, 2.0
    while radius <= 24.0:
        end = at + side * 2 * radius
        program.raw("G3" + words(X=end, Y=y, I=side * radius, J=0.0))
        at, side, radius = end, -side, radius + 1.0
    program.rapid(z=5.0)


def chords(program, centre, radius, depth):
    """A closed circle as 180 chords of about half a millimetre, as CAM systems write it."""
    x, y = centre
    program.rapid(x + radius, y)
    program.rapid(z=1.0)
    program.feed(FEED_PLUNGE, z=depth)
    program.raw(f"F{FEED_FINISH}")
    for i in range(1, 181):
        angle = 2 * math.pi * i / 180
        program.feed(None, x + radius * math.cos(angle), y + radius * math.sin(angle))
    program.rapid(z=5.0)


def build(dialect):
    program = Program(dialect)
    program.comment("Rib pocket: arcs of 2 to 40 mm, fillets, a spiral. Written by make_rib_pocket.py")
    program.raw("G17 G71 G90 G94" if program.sinumerik else "G17 G21 G90 G94")
    program.raw("G54")
    program.raw("G64" if program.sinumerik else "G61")
    program.tool(1, 6000)
    program.rapid(62.0, 40.0)
    program.rapid(z=5.0)
    for depth in DEPTHS:
        program.comment(f"spiral at Z{depth}")
        spiral(program, (64.0, 34.0), depth)
        for inward in (8.0, 4.0):
            mid, blocks = contour(offset_corners(inward))
            program.comment(f"offset pass {inward} mm inside")
            program.rapid(*mid)
            program.rapid(z=1.0)
            program.feed(FEED_PLUNGE, z=depth)
            program.follow(blocks, FEED_ROUGH)
            program.rapid(z=5.0)
    program.comment("finishing pass with tangential lead-in and lead-out")
    corners = offset_corners(0.0)
    mid, blocks = contour(corners)
    (x0, y0), (x1, y1) = corners[0][0], corners[1][0]
    length = math.hypot(x1 - x0, y1 - y0)
    tangent = ((x1 - x0) / length, (y1 - y0) / length)
    start, arrive = lead(mid, tangent, 6.0, leaving=False)
    program.rapid(*start)
    program.rapid(z=1.0)
    program.feed(FEED_PLUNGE, z=DEPTHS[-1])
    program.follow([arrive, *blocks, lead(mid, tangent, 6.0, leaving=True)], FEED_FINISH)
    program.rapid(z=5.0)
    program.comment("lightening hole, full circle of 6 mm")
    program.rapid(30.0, 40.0)
    program.rapid(z=1.0)
    program.feed(FEED_PLUNGE, z=DEPTHS[-1])
    program.feed(FEED_FINISH, 36.0, 40.0)
    program.raw("G3" + words(X=36.0, Y=40.0, I=-6.0, J=0.0))
    program.feed(None, 30.0, 40.0)
    program.rapid(z=5.0)
    program.comment("boss, 15 mm radius as short chords")
    chords(program, (64.0, 34.0), 15.0, DEPTHS[-1] - 0.5)
    program.comment("drilling")
    program.tool(2, 3000)
    program.rapid(*HOLES[0], 5.0)
    if program.sinumerik:
        for x, y in HOLES:
            program.rapid(x, y)
            program.rapid(z=1.0)
            program.feed(300, z=-6.0)
            program.rapid(z=5.0)
    else:
        for x, y in HOLES:
            program.raw("G98 G81" + words(X=x, Y=y, Z=-6.0, R=1.0) + " F300")
        program.raw("G80")
    program.raw("G0 Z50.0")
    program.raw("M5")
    program.raw("M30")
    return "\n".join(program.text) + "\n"


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent)
    (folder / "rib-pocket.ngc").write_text(build("linuxcnc"), encoding="ascii")
    (folder / "rib-pocket.mpf").write_text(build("sinumerik"), encoding="ascii")


if __name__ == "__main__":
    main()
