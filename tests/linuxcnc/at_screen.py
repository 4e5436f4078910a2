#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the page docs/linuxcnc.md asks its reader to do at the machine's screen. GPL-2.0+ modules are imported, not linked.

at_screen.py start PROGRAM: waits for LinuxCNC, homes the axes where they are not, opens PROGRAM and starts it.
at_screen.py stop: closes LinuxCNC.
"""
import subprocess
import sys
import time

import linuxcnc

from bring_up import bring_up


def is_true(pin):
    return subprocess.run(["halcmd", "getp", pin], capture_output=True, text=True).stdout.strip() == "TRUE"


def ready():
    return is_true("joint.2.active") and (is_true("halui.mode.is-manual") or is_true("halui.mode.is-auto"))


def start(program):
    for _ in range(1500):
        if ready():
            break
        time.sleep(0.02)
    linuxcnc.command().abort()
    time.sleep(0.2)
    command, _ = bring_up(program)
    command.auto(linuxcnc.AUTO_RUN, 0)
    time.sleep(0.5)


def stop():
    linuxcnc.command().abort()
    subprocess.run(["pkill", "-TERM", "-x", "hold"], check=True)
    for _ in range(500):
        if subprocess.run(["pgrep", "-f", "headless.ini"], capture_output=True).returncode != 0:
            return
        time.sleep(0.02)


if sys.argv[1] == "start":
    start(sys.argv[2])
else:
    stop()
