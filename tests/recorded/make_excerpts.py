#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Excerpts of the recorded logs: tests/recorded/make_excerpts.py LOGS rewrites them, byte for byte.

LOGS is a folder with encoder/ and thermal/ as the README beside this describes them. With --figures it writes
nothing and prints what the tests expect of the excerpts, worked out here without our program.
"""

import argparse
import gzip
import math
import pathlib
import statistics

HERE = pathlib.Path(__file__).resolve().parent
# name of the excerpt: (log, first row, rows, every so many)
EXCERPTS = {
    "spindle-unit": ("thermal/spindle_unit.csv.gz", 0, None, 20),
    "servo-gap": ("encoder/k12m.csv.gz", None, 2000, 1),
    "servo-slow": ("encoder/k3m0.07.csv.gz", 4000, 2000, 1),
}


def rows_of(path):
    with gzip.open(path, "rt") as log:
        return log.read().splitlines()


def around_the_gap(rows, count):
    """The first row of `count` rows in whose middle the longest step of time lies."""
    t = [float(row.split(",")[0]) for row in rows]
    gap = max(range(1, len(t)), key=lambda i: t[i] - t[i - 1])
    return max(0, gap - count // 2)


def from_zero(rows):
    """Encoder logs begin at t = 0."""
    first = float(rows[0].split(",")[0])
    for row in rows:
        t, count = row.split(",")
        yield f"{float(t) - first:.9f},{count}"


def write(name, logs):
    log, first, count, every = EXCERPTS[name]
    head, *rows = rows_of(logs / log)
    if first is None:
        first = around_the_gap(rows, count)
    rows = rows[first:None if count is None else first + count:every]
    if log.startswith("encoder/"):
        rows = from_zero(rows)
    with gzip.GzipFile(HERE / f"{name}.csv.gz", "wb", 9, mtime=0) as out:
        out.write(("\n".join([head, *rows]) + "\n").encode())


def hysteresis(columns, channel):
    """Correlation, residual and spread (µm) over the sensor that the displacement follows best."""
    def line(sensor):
        d, c = columns[channel], columns[sensor]
        r = statistics.correlation(c, d)
        cells = {}
        for x, y in zip(c, d):
            cells.setdefault(math.floor(x / 0.5 + 0.5), []).append(y)
        spread = max(max(v) - min(v) for v in cells.values())
        return r, statistics.pstdev(d) * math.sqrt(1 - r * r), spread
    lines = [line(name) for name in columns if name.endswith("_c")]
    return max(lines, key=lambda one: abs(one[0]))


def figures(name):
    head, *rows = rows_of(HERE / f"{name}.csv.gz")
    table = [[float(x) for x in row.split(",")] for row in rows]
    columns = dict(zip(head.split(","), zip(*table)))
    if "count" in columns:
        t = columns["t_s"]
        steps = [b - a for a, b in zip(t, t[1:])]
        short = [s for s in steps if s < 0.01]
        nominal = statistics.median(short)
        off = sorted(abs(s - nominal) for s in short)
        rms = statistics.stdev(short)
        print(f"{name}: periods {len(short)}, rms {1e6 * rms:.4f} us, shortest {1e6 * min(short):.3f}, "
              f"longest {1e6 * max(short):.3f}, p99.9 {1e6 * off[math.ceil(0.999 * len(off)) - 1]:.3f}, "
              f"gaps {len(steps) - len(short)}, longest gap {max(steps):.9f} s")
        return
    print(f"{name}: {len(rows)} rows, {columns['time_s'][-1] / 3600:.3f} h")
    for channel in (c for c in columns if c.endswith("_um")):
        print("  %s correlation %.4f, residual %.4f um, spread %.4f um" % (channel, *hysteresis(columns, channel)))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("logs", nargs="?", type=pathlib.Path, default=HERE.parent.parent / "../shared/data")
    parser.add_argument("--figures", action="store_true")
    options = parser.parse_args()
    for name in EXCERPTS:
        figures(name) if options.figures else write(name, options.logs)


if __name__ == "__main__":
    main()
