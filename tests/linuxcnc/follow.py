#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the layer says of the program that LinuxCNC has loaded, in turn: opened, replaced, run, relative, joined. GPL-2.0+ modules are imported,
not linked.

follow.py PROGRAM LOG: beside LOG comes said.json: the status's `program` at each step, the answer, and how a machine file with another servo
period is refused.
"""
import json
import os
import subprocess
import sys
import time

import linuxcnc

from bring_up import bring_up

HERE = os.path.dirname(os.path.abspath(__file__))
PROBE = os.path.join(HERE, "probe")
HEAD = "G21 G90 G94 G17 G64\nM52 P1 F3000\n"
ABSOLUTE = HEAD + "G0 X0 Y0 Z0\no1 repeat [3]\nG1 X%d\nY8\nX0\nY0\no1 endrepeat\nM2\n"
RELATIVE = HEAD + "G91\no1 repeat [500]\nG1 X12\nY8\nX-12\nY-8\no1 endrepeat\nM2\n"
KEPT = HEAD + "G1 X#31 Y1 Z1\nM2\n"


class Layer:
    def __init__(self, folder, machine="machine.toml"):
        self.socket = os.path.join(folder, "s")
        self.out = open(os.path.join(folder, "run.json"), "w")
        self.process = subprocess.Popen([PROBE, "run", "--machine", os.path.join(HERE, machine), "--mode", "observe", "--socket", self.socket,
                                         "--json"], stdout=self.out, stderr=subprocess.DEVNULL)

    def program(self):
        asked = subprocess.run([PROBE, "status", "--socket", self.socket, "--json"], capture_output=True, text=True)
        return json.loads(asked.stdout).get("program", {}) if asked.returncode == 0 else {}

    def until(self, holds, seconds=60.0):
        """The first status that `holds`, else the last one."""
        end = time.monotonic() + seconds
        while True:
            seen = self.program()
            if holds(seen) or time.monotonic() > end:
                return seen

    def end(self):
        self.process.terminate()
        self.process.wait()


def main():
    folder = os.path.dirname(sys.argv[2])
    part = os.path.join(folder, "part.ngc")
    said = {}

    def write(text):
        with open(part + ".new", "w") as out:
            out.write(text)
        os.replace(part + ".new", part)

    def planned(seen):
        return seen.get("segments", 0) > 0

    def told(words):
        return lambda seen: seen.get("segments") == 0 and words in (seen.get("words") or "")

    def opened(text):
        write(text)
        command.program_open(part)
        command.wait_complete(10)

    def stopped():
        command.abort()
        command.wait_complete(10)
        time.sleep(0.3)

    write(ABSOLUTE % 12)
    command, _ = bring_up(part)
    with open(os.path.join(HERE, "machine.toml")) as machine, open(os.path.join(HERE, "other.toml"), "w") as other:
        other.write(machine.read().replace("_period_ms = 1", "_period_ms = 2"))
    refused = subprocess.run([PROBE, "run", "--machine", os.path.join(HERE, "other.toml"), "--for-s", "1",
                              "--socket", os.path.join(folder, "t")], capture_output=True, text=True)
    said["refused"] = {"code": refused.returncode, "words": refused.stderr}
    layer = Layer(folder)
    said["opened"] = layer.until(planned)
    write(ABSOLUTE % 11)
    said["replaced"] = layer.until(told("has changed"))
    opened(ABSOLUTE % 11)
    said["opened_again"] = layer.until(planned)
    command.auto(linuxcnc.AUTO_RUN, 0)
    said["run"] = layer.until(lambda seen: seen.get("place") == "on_path")
    stopped()
    command.auto(linuxcnc.AUTO_RUN, 8)  # the second pass's line: which pass it is cannot be known
    said["searched"] = layer.until(lambda seen: seen.get("place") == "searching")
    said["from_line"] = layer.until(lambda seen: seen.get("place") == "on_path", 1.0)
    stopped()
    opened(KEPT)
    said["kept"] = layer.until(told("#31"))
    opened(RELATIVE)
    layer.until(planned)
    time.sleep(5.0)  # the position at which the axes rest is told every second, and shown nowhere
    command.auto(linuxcnc.AUTO_RUN, 0)
    said["relative"] = layer.until(lambda seen: seen.get("place") == "on_path")
    layer.end()
    with open(os.path.join(folder, "run.json")) as answer:
        said["answer"] = json.load(answer)
    layer = Layer(folder)
    said["joined"] = layer.until(lambda seen: seen.get("place") in ("on_path", "start_unseen"))
    layer.end()
    stopped()
    with open(os.path.join(folder, "said.json"), "w") as out:
        json.dump(said, out, indent=1)
    open(sys.argv[2], "w").close()
    return 0


sys.exit(main())
