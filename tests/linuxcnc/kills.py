#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Kills the layer again and again on the LinuxCNC that is up while it cuts circles. GPL-2.0+ modules are imported, not linked.

kills.py PROGRAM LOG KILLS SEED: LOG is that of sampler channel 2 (lag_log.hal). Beside it come `kills`, for each kill the servo
cycle by which the process had ended, and 1 where the next layer came only after the feed was back at the panel's; `said`, what the
layers said; and their records. Before the first layer comes, 50 um against heat are in force on Z, as an earlier one leaves them.
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
FEED_MM_S = 66.6
SLOWED = 0.5      # of the panel; the circle asks for 0.13
LONGEST_S = 30.0  # until a layer has slowed the cut, however busy the computer


def main():
    program, log, kills, seed = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    folder = os.path.dirname(log)
    moments = random.Random(seed)
    command, _ = bring_up(program)
    eyes = hal.component("kills")
    eyes.ready()
    said = open(os.path.join(folder, "said"), "w")

    def layer():
        return subprocess.Popen([os.path.join(HERE, "probe"), "run", "--machine", os.path.join(HERE, "machine.toml"), "--mode", "act",
                                 "--socket", os.path.join(folder, "s"), "--record", folder, "--json"], stdout=said, stderr=said)

    def slowed_by(process):
        try:
            return (hal.get_value("steadyrest.process") == process.pid and hal.get_value("layer-alive") and
                    hal.get_value("layer-feed-in-force") < SLOWED)
        except RuntimeError:
            return False  # no layer has been here yet

    def wait_for_panel():
        limit = time.monotonic() + LONGEST_S
        while (hal.get_value("layer-feed-in-force") < 1.0 or hal.get_value("layer-path-speed") < FEED_MM_S) and time.monotonic() < limit:
            time.sleep(0.002)

    def wait_until_slowed(process):
        limit = time.monotonic() + LONGEST_S
        while not slowed_by(process):
            if process.poll() is not None or time.monotonic() > limit:
                print("kills.py: the layer does not slow the cut", file=sys.stderr)
                return False
            time.sleep(0.002)
        return True

    sampler = subprocess.Popen(["halsampler", "-c", "2", "-t", log])
    command.auto(linuxcnc.AUTO_RUN, 0)
    time.sleep(1.5)
    subprocess.run(["halcmd", "sets", "layer-offset-2", "0.05"], check=True)
    time.sleep(0.5)
    process = layer()
    done = wait_until_slowed(process)
    with open(os.path.join(folder, "kills"), "w") as out:
        for _ in range(kills):
            if not done:
                break
            time.sleep(moments.uniform(0.3, 1.5))
            process.send_signal(signal.SIGKILL)
            process.wait()
            waits = moments.random() < 0.5  # else the next layer comes while the feed is on its way back
            out.write("%d %d\n" % (hal.get_value("layer-tick"), waits))
            if waits:
                wait_for_panel()
            process = layer()
            done = wait_until_slowed(process)
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
