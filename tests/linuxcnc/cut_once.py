#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cuts a program once on the LinuxCNC that is up, with the layer acting from its start to its end. GPL-2.0+ modules are imported, not linked.

cut_once.py PROGRAM LOG: beside LOG come the layer's answer (run.json), what it said (run.said) and its record.
"""
import os
import subprocess
import sys
import time

import linuxcnc

from bring_up import bring_up

HERE = os.path.dirname(os.path.abspath(__file__))


def main():
    program, log = sys.argv[1], sys.argv[2]
    folder = os.path.dirname(log)
    command, status = bring_up(program)
    open(log, "w").close()
    with open(os.path.join(folder, "run.json"), "w") as out, open(os.path.join(folder, "run.said"), "w") as said:
        layer = subprocess.Popen([os.path.join(HERE, "probe"), "run", "--machine", os.path.join(HERE, "machine.toml"), "--mode", "act",
                                  "--socket", os.path.join(folder, "s"), "--record", folder, "--json"], stdout=out, stderr=said)
        time.sleep(1.5)  # the program is read and planned
        command.auto(linuxcnc.AUTO_RUN, 0)
        time.sleep(0.5)
        limit = time.monotonic() + 300
        while layer.poll() is None and time.monotonic() < limit:
            status.poll()
            if status.interp_state == linuxcnc.INTERP_IDLE and status.inpos:
                break
            time.sleep(0.05)
        layer.terminate()
        return layer.wait()


sys.exit(main())
