#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Stops the layer again and again, and lets it go on, on the LinuxCNC that is up while it cuts circles. GPL-2.0+ modules are imported, not linked.

stalls.py PROGRAM LOG STALLS SEED: LOG is that of sampler channel 2 (lag_log.hal). Beside it comes `stalls`, for each stall the servo cycle at
which the process was stopped and the one at which it went on; `said`, what the layer said; and its record.
"""
import os
import random
import signal
import subprocess
import sys
import time

import hal
import linuxcnc

from bring_up import bring_up

HERE = os.path.dirname(os.path.abspath(__file__))
SLOWED = 0.3      # of the panel; the circle asks for 0.13
LONGEST_S = 30.0  # until the layer has slowed the cut, however busy the computer


def main():
    program, log, stalls, seed = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    folder = os.path.dirname(log)
    moments = random.Random(seed)
    command, _ = bring_up(program)
    eyes = hal.component("stalls")
    eyes.ready()
    said = open(os.path.join(folder, "said"), "w")

    def wait_until_slowed(process):
        limit = time.monotonic() + LONGEST_S
        while not (hal.get_value("layer-alive") and hal.get_value("layer-feed-in-force") < SLOWED):
            if process.poll() is not None or time.monotonic() > limit:
                print("stalls.py: the layer does not slow the cut", file=sys.stderr)
                return False
            time.sleep(0.002)
        return True

    sampler = subprocess.Popen(["halsampler", "-c", "2", "-t", log])
    command.auto(linuxcnc.AUTO_RUN, 0)
    time.sleep(1.5)
    process = subprocess.Popen([os.path.join(HERE, "probe"), "run", "--machine", os.path.join(HERE, "machine.toml"), "--mode", "act",
                                "--socket", os.path.join(folder, "s"), "--record", folder, "--json"], stdout=said, stderr=said)
    done = wait_until_slowed(process)
    time.sleep(1.0)
    with open(os.path.join(folder, "stalls"), "w") as out:
        for _ in range(stalls):
            done = done and wait_until_slowed(process)
            if not done:
                break
            time.sleep(moments.uniform(0.2, 0.6))
            process.send_signal(signal.SIGSTOP)
            begin = hal.get_value("layer-tick")
            time.sleep(moments.choice([0.01, 0.03, 0.06, 0.1, 0.2, 0.4, 0.7]))
            process.send_signal(signal.SIGCONT)
            out.write("%d %d\n" % (begin, hal.get_value("layer-tick")))
    time.sleep(1.0)
    process.send_signal(signal.SIGTERM)
    process.wait()
    time.sleep(0.3)
    command.abort()
    time.sleep(0.2)
    sampler.terminate()
    sampler.wait()
    said.close()
    if not done:
        sys.stderr.write(open(os.path.join(folder, "said")).read()[-2000:])
    return 0 if done else 1


sys.exit(main())
