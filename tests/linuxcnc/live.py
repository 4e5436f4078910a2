#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lets probes read and correct the LinuxCNC that is up while it cuts circles. GPL-2.0+ modules are imported, not linked.

live.py PROGRAM LOG: beside LOG come the frames of each probe (read, hold, half, …) and what the probes said (.said).
LOG: one line for each servo period: number, tick, path speed, layer in force, heartbeat, watchdog, commanded z.
"""
import os
import signal
import subprocess
import sys
import time

import linuxcnc

from bring_up import bring_up

PROBE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "probe")


def main():
    program, log = sys.argv[1], sys.argv[2]
    folder = os.path.dirname(log)
    command, _ = bring_up(program)

    def probe(name, *arguments):
        said = open(os.path.join(folder, name + ".said"), "w")
        return subprocess.Popen([PROBE, "-o", os.path.join(folder, name + ".csv"), *arguments], stdout=said, stderr=said)

    sampler = subprocess.Popen(["halsampler", "-c", "2", "-t", log])
    command.auto(linuxcnc.AUTO_RUN, 0)
    time.sleep(2.0)

    probe("read", "--frames", "2000").wait()
    hold = probe("hold", "--frames", "1500")
    time.sleep(0.4)
    command.auto(linuxcnc.AUTO_PAUSE)
    time.sleep(0.5)
    command.auto(linuxcnc.AUTO_RESUME)
    hold.wait()
    probe("half", "--frames", "1500", "--ratio", "0.5", "--from", "500", "--spindle-ratio", "0.9").wait()
    panel = probe("panel", "--frames", "3000", "--ratio", "0.5")
    time.sleep(1.0)
    command.feedrate(0.8)
    time.sleep(0.7)
    command.feedrate(0.3)
    panel.wait()
    command.feedrate(1.0)
    stalled = probe("stalled", "--frames", "1200", "--ratio", "0.5")
    time.sleep(0.6)
    stalled.send_signal(signal.SIGSTOP)
    time.sleep(0.06)
    stalled.send_signal(signal.SIGCONT)
    stalled.wait()
    time.sleep(0.3)
    killed = probe("killed", "--frames", "100000", "--ratio", "0.2", "--name", "killed", "--offset-z-mm", "0.05",
                   "--path-offset-z-mm", "0.2")
    time.sleep(1.0)
    probe("taken", "--frames", "10", "--ratio", "0.5", "--name", "killed").wait()
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    time.sleep(2.0)
    probe("driven", "--frames", "10", "--ratio", "0.5", "--name", "driven").wait()
    probe("again", "--frames", "1000", "--ratio", "0.5", "--name", "killed").wait()
    time.sleep(0.2)
    command.abort()
    time.sleep(0.2)
    sampler.terminate()
    sampler.wait()
    return 0


sys.exit(main())
