#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Cuts a program again and again on the LinuxCNC that is up, with the layer beside it. GPL-2.0+ modules are imported, not linked.

cut_again.py PROGRAM LAYER…: homes the axes, opens PROGRAM, starts the command LAYER… and then the program, anew whenever it has ended. On SIGINT or
SIGTERM, or when the layer ends, both are stopped, the layer first: it hands back. The layer's exit status.
"""
import signal
import subprocess
import sys
import time

import linuxcnc

from bring_up import bring_up

# What a layer needs at most to be on the control, and to read the program.
READY_S = 2.0


class Stop(Exception):
    pass


def stop(*_):
    raise Stop


def cut(command, status, layer):
    errors = linuxcnc.error_channel()
    told = None
    begin_at = time.monotonic() + READY_S
    while layer.poll() is None:
        time.sleep(0.05)
        said = errors.poll()
        if said and said[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR) and said[1] != told:
            told = said[1]
            print("LinuxCNC: " + told.strip(), file=sys.stderr, flush=True)
        status.poll()
        if status.interp_state == linuxcnc.INTERP_IDLE and status.inpos and time.monotonic() > begin_at:
            command.auto(linuxcnc.AUTO_RUN, 0)
            command.wait_complete(5)
            begin_at = time.monotonic() + 1.0


def main():
    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    command, layer = None, None
    try:
        command, status = bring_up(sys.argv[1])
        layer = subprocess.Popen(sys.argv[2:], start_new_session=True)
        cut(command, status, layer)
    except Stop:
        pass
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_IGN)
    if layer is not None and layer.poll() is None:
        layer.terminate()
    code = layer.wait() if layer is not None else 0
    if command is not None:
        command.abort()
    return code


sys.exit(main())
