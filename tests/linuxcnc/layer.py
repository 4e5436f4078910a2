#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the layer on the LinuxCNC that is up while it cuts circles: observing, then acting. GPL-2.0+ modules are imported, not linked.

layer.py PROGRAM LOG: beside LOG come the layer's answers (observe.json, reloads.json, act.json), what became of each changed machine file
(reload1.json …), and the log of sampler channel 2 (LOG).
"""
import json
import os
import signal
import subprocess
import sys
import time

import linuxcnc

from bring_up import bring_up

HERE = os.path.dirname(os.path.abspath(__file__))
MACHINE = os.path.join(HERE, "machine.toml")
# In the machine file of a layer that runs: beyond the control's; what it takes over at its start alone; the same text.
CHANGES = (
    ("max_mm = 500", "max_mm = 9000"),
    ("[envelope]", "[envelope]\noffset_slew_um_s = 40"),
    ("corner_tolerance_mm = 10", "corner_tolerance_mm = 5"),
    ("max_mm = 500", "max_mm = 500"),
)


def status(folder):
    asked = subprocess.run([os.path.join(HERE, "probe"), "status", "--socket", os.path.join(folder, "s"), "--json"], stdout=subprocess.PIPE)
    return json.loads(asked.stdout) if asked.returncode == 0 else None


def reload_changed_files(run, folder):
    with open(MACHINE) as file:
        text = file.read()
    for number in range(len(CHANGES) + 1):  # 0: it runs
        if number > 0:
            with open(MACHINE, "w") as file:
                file.write(text.replace(*CHANGES[number - 1], 1))
            run.send_signal(signal.SIGHUP)
        now = None
        while run.poll() is None and (now is None or (now["reload"] or {"number": 0})["number"] < number):
            time.sleep(0.02)
            now = status(folder)
        if now is not None and number > 0:
            with open(os.path.join(folder, "reload%d.json" % number), "w") as out:
                json.dump(now["reload"], out)
    with open(MACHINE, "w") as file:
        file.write(text)


def end_after(run, folder, cycles):
    while run.poll() is None and (status(folder) or {"cycles": 0})["cycles"] < cycles:
        time.sleep(0.02)
    run.terminate()
    run.wait()


def main():
    program, log = sys.argv[1], sys.argv[2]
    folder = os.path.dirname(log)
    command, _ = bring_up(program)

    def layer(name, mode, *until):
        with open(os.path.join(folder, name + ".json"), "w") as out, open(os.path.join(folder, name + ".said"), "w") as said:
            return subprocess.Popen([os.path.join(HERE, "probe"), "run", "--machine", MACHINE, "--mode", mode, *until,
                                     "--socket", os.path.join(folder, "s"), "--record", folder, "--json"], stdout=out, stderr=said)

    sampler = subprocess.Popen(["halsampler", "-c", "2", "-t", log])
    command.auto(linuxcnc.AUTO_RUN, 0)
    time.sleep(2.0)
    layer("observe", "observe", "--for-s", "3").wait()
    run = layer("reloads", "observe")
    reload_changed_files(run, folder)
    end_after(run, folder, 2500)
    layer("act", "act", "--for-s", "4").wait()
    time.sleep(0.5)
    command.abort()
    time.sleep(0.2)
    sampler.terminate()
    sampler.wait()
    return 0


sys.exit(main())
