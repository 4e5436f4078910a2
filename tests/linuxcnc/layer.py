#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the layer on the LinuxCNC that is up while it cuts circles: observing, then acting. GPL-2.0+ modules are imported, not linked.

layer.py PROGRAM LOG: beside LOG come the layer's answers (observe.json, act.json) and the log of sampler channel 2 (LOG).
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
    command, _ = bring_up(program)

    def layer(mode, seconds):
        with open(os.path.join(folder, mode + ".json"), "w") as out, open(os.path.join(folder, mode + ".said"), "w") as said:
            subprocess.run([os.path.join(HERE, "probe"), "run", "--machine", os.path.join(HERE, "machine.toml"), "--mode", mode,
                            "--for-s", str(seconds), "--socket", os.path.join(folder, "s"), "--record", folder, "--json"],
                           stdout=out, stderr=said)

    sampler = subprocess.Popen(["halsampler", "-c", "2", "-t", log])
    command.auto(linuxcnc.AUTO_RUN, 0)
    time.sleep(2.0)
    layer("observe", 2)
    layer("act", 4)
    time.sleep(0.5)
    command.abort()
    time.sleep(0.2)
    sampler.terminate()
    sampler.wait()
    return 0


sys.exit(main())
