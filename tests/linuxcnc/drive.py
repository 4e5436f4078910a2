#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs one program on the LinuxCNC that is up and prints how many servo periods its motion lasted.

drive.py PROGRAM LOG: the log of the sampler goes to LOG, one line for each servo period:
in-position, speed, program line, x, y, z. Printed: periods from the first to the last one out of position.
"""
import subprocess
import sys
import time

import linuxcnc

from bring_up import bring_up


def left_in_sampler():
    return int(subprocess.run(["halcmd", "getp", "sampler.0.curr-depth"], capture_output=True, check=True).stdout)


def main():
    program, log = sys.argv[1], sys.argv[2]
    errors = linuxcnc.error_channel()
    command, status = bring_up(program)

    sampler = subprocess.Popen(["halsampler", "-t", log])
    time.sleep(0.3)
    subprocess.run(["halcmd", "setp", "sampler.0.enable", "1"], check=True)
    command.auto(linuxcnc.AUTO_RUN, 0)
    started = False
    limit = time.monotonic() + 600
    while time.monotonic() < limit:
        status.poll()
        failure = errors.poll()
        if failure and failure[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR):
            print("linuxcnc: " + failure[1], file=sys.stderr)
            return 1
        busy = status.interp_state != linuxcnc.INTERP_IDLE
        started = started or busy
        if started and not busy and status.inpos:
            break
        time.sleep(0.01)
    subprocess.run(["halcmd", "setp", "sampler.0.enable", "0"], check=True)
    while left_in_sampler() > 0 and time.monotonic() < limit:
        time.sleep(0.01)
    sampler.terminate()
    sampler.wait()
    moving = []
    last = -1
    with open(log) as rows:
        for row in rows:
            words = row.split()
            if len(words) < 7:
                continue
            number = int(words[0])
            if last >= 0 and number != last + 1:
                print("drive.py: the log has a gap", file=sys.stderr)
                return 1
            last = number
            if words[1] == "0":
                moving.append(number)
    print(moving[-1] - moving[0] + 1 if moving else 0)
    return 0


sys.exit(main())
