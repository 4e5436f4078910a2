# SPDX-License-Identifier: Apache-2.0
"""Makes the LinuxCNC that is up ready to run a program: on, homed, in mode auto. GPL-2.0+ modules are imported, not linked."""
import time

import linuxcnc


def bring_up(program):
    """The command and status channels of LinuxCNC, with `program` open."""
    command, status = linuxcnc.command(), linuxcnc.stat()

    def ask(call, *arguments):
        call(*arguments)
        command.wait_complete(5)
        status.poll()

    ask(command.state, linuxcnc.STATE_ESTOP_RESET)
    ask(command.state, linuxcnc.STATE_ON)
    ask(command.mode, linuxcnc.MODE_MANUAL)
    ask(command.teleop_enable, 0)
    if not all(status.homed[:3]):
        command.home(-1)
    for _ in range(3000):
        status.poll()
        if all(status.homed[:3]):
            break
        time.sleep(0.02)
    ask(command.mode, linuxcnc.MODE_AUTO)
    command.program_open(program)
    command.wait_complete(60)
    return command, status
