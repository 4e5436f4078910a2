#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cuts a program once on the LinuxCNC that is up, with the layer acting from its start to its end. GPL-2.0+ modules are imported, not linked.

cut_once.py PROGRAM LOG: beside LOG come the layer's answer (run.json), what it said (run.said) and its record.
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


def planned(socket):
    """The layer is there and has planned the program."""
    asked = subprocess.run([PROBE, "status", "--socket", socket, "--json"], capture_output=True, text=True)
    return asked.returncode == 0 and (json.loads(asked.stdout).get("program") or {}).get("segments", 0) > 0


def main():
    program, log = sys.argv[1], sys.argv[2]
    folder = os.path.dirname(log)
    command, status = bring_up(program)
    open(log, "w").close()
    with open(os.path.join(folder, "run.json"), "w") as out, open(os.path.join(folder, "run.said"), "w") as said:
        socket = os.path.join(folder, "s")
        layer = subprocess.Popen([PROBE, "run", "--machine", os.path.join(HERE, "machine.toml"), "--mode", "act",
                                  "--socket", socket, "--record", folder, "--json"], stdout=out, stderr=said)
        limit = time.monotonic() + 60
        while layer.poll() is None and not planned(socket) and time.monotonic() < limit:
            time.sleep(0.05)
        command.auto(linuxcnc.AUTO_RUN, 0)
        started = False
        limit = time.monotonic() + 300
        while layer.poll() is None and time.monotonic() < limit:
            status.poll()
            busy = status.interp_state != linuxcnc.INTERP_IDLE
            started = started or busy
            if started and not busy and status.inpos:
                break
            time.sleep(0.05)
        layer.terminate()
        return layer.wait()


sys.exit(main())
