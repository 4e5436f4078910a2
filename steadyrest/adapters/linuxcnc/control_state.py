#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Prints what LinuxCNC has loaded: one JSON object a line, at each change and every second; {"error": …} ends it.

Lengths in mm, angles in degrees. It runs as a separate process: it imports LinuxCNC's modules (GPL-2.0+), which the layer never links.
"""
import glob
import json
import os
import sys
import time

try:
    import hal
    import linuxcnc
except ImportError as fault:
    print(json.dumps({"error": "LinuxCNC's Python module is missing: %s" % fault}), flush=True)
    sys.exit(1)

POLL_S = 0.01
REPEAT_S = 1.0
LINEAR = (0, 1, 2, 6, 7, 8)
PLANES = {170: "xy", 180: "zx", 190: "yz"}
PATH_MODES = {610: "exact_path", 611: "exact_stop", 640: "continuous"}
OFFSETS = ("xoffset", "yoffset", "zoffset", "aoffset", "boffset", "coffset", "uoffset", "voffset", "woffset")


class Lengths:
    """Turns the control's units into mm."""

    def __init__(self, status):
        self.mm = 1.0 / status.linear_units if status.linear_units > 0 else 1.0

    def of_axes(self, values):
        return [v * self.mm if i in LINEAR else v for i, v in enumerate(values[:9])]


def stamp(name):
    try:
        return os.stat(name).st_mtime_ns
    except OSError:
        return 0


def tools(status, lengths):
    return [
        {
            "number": tool.id,
            "offset": lengths.of_axes([getattr(tool, name) for name in OFFSETS]),
            "diameter_mm": tool.diameter * lengths.mm,
            "front_deg": tool.frontangle,
            "back_deg": tool.backangle,
            "orientation": tool.orientation,
        }
        for tool in status.tool_table[1:]
        if tool.id > 0
    ]


def files(ini):
    """The variable file, the folders of subprograms and the remapped words, as the INI file names them."""
    config = linuxcnc.ini(ini)
    home = os.path.dirname(os.path.abspath(ini))

    def absolute(name):
        return os.path.normpath(os.path.join(home, os.path.expanduser(name)))

    variables = config.find("RS274NGC", "PARAMETER_FILE")
    folders = [config.find("DISPLAY", "PROGRAM_PREFIX")]
    folders += (config.find("RS274NGC", "SUBROUTINE_PATH") or "").split(":")
    return absolute(variables) if variables else "", [absolute(f) for f in folders if f], config.findall("RS274NGC", "REMAP")


def tolerance_mm(status, lengths, inch):
    """P of the G64 in force, which is in the program's unit. LinuxCNC shows 0.001 inch, in the machine's, before the first G64, but rounds
    without a limit then."""
    tolerance, merging = status.settings[3], status.settings[4]
    if merging == 0.0 and abs(tolerance * lengths.mm - 0.0254) < 1e-6:
        return 0.0
    return tolerance * (25.4 if inch else 1.0)


def selected_tool(status):
    """The number of the tool that T has selected; None: none."""
    index = status.pocket_prepped
    return status.tool_table[index].id if 0 < index < len(status.tool_table) else None


def unread(status, codes, remaps):
    """What is in force at the start that the layer's reader does not take over, in words."""
    unusual = ["G%g" % (code / 10) for code in sorted(codes & {70, 410, 420, 411, 421, 930, 950, 960})]
    return ", ".join(unusual + ["[RS274NGC] REMAP = %s" % remap for remap in remaps])


def without_offsets(position, lengths):
    """The machine's position without the external offsets that it contains."""
    found = list(position)
    for i, letter in enumerate("xyzabcuvw"):
        try:
            found[i] -= hal.get_value("axis.%s.eoffset" % letter) * (lengths.mm if i in LINEAR else 1.0)
        except RuntimeError:
            pass  # no such axis
    return found


class OpenedText:
    """Whether a program file is still the one that LinuxCNC has open: it runs that first, and opens the file anew for later runs."""

    def __init__(self, task, processes="/proc"):
        self.comm, self.processes, self.process = task[:15], processes, None
        self.opened, self.ran = None, False
        self.program, self.judged, self.judged_s, self.verdict = None, None, 0.0, True

    def is_task(self, process):
        try:
            with open(process + "/comm") as name:
                return name.read().strip() == self.comm and os.access(process + "/fd", os.R_OK | os.X_OK)
        except OSError:
            return False  # it has ended

    def held(self, program):
        """Of the file that LinuxCNC's task holds open by this name (None: none, or it is not ours to see), and whether every descriptor was seen."""
        if self.process is None or not self.is_task(self.process):
            self.process = next(filter(self.is_task, glob.iglob(self.processes + "/[0-9]*")), None)
        if self.process is None:
            return None, True
        names, all_seen = {program, os.path.realpath(program)}, True
        for entry in glob.glob(self.process + "/fd/*"):
            try:
                if os.readlink(entry).removesuffix(" (deleted)") in names:
                    return os.stat(entry), True
            except OSError:
                all_seen = False  # closed meanwhile
        return None, all_seen

    def is_file(self, program, stopped):
        """Looks where something has changed, while the answer is no, and once a second."""
        now_s, seen = time.monotonic(), (program, stopped, stamp(program))
        if self.judged == seen and self.verdict and now_s - self.judged_s < REPEAT_S:
            return True
        held, all_seen = self.held(program)
        if held is None and not all_seen:
            self.verdict = self.verdict or program != self.program
            self.judged = None
        else:
            self.verdict = self.is_held(program, stopped, held)
            self.judged, self.judged_s = seen, now_s
        self.program = program
        return self.verdict

    def is_held(self, program, stopped, held):
        if held is None:
            return True
        opened = (program, held.st_dev, held.st_ino)
        self.ran = (self.ran and opened == self.opened) or not stopped
        self.opened = opened
        if self.ran and stopped:
            return True
        try:
            now = os.stat(program)
        except OSError:
            return False
        return (now.st_dev, now.st_ino) == opened[1:]


def state(status, lengths, ini_files, home, text):
    codes = set(status.gcodes[1:])
    stopped = status.task_mode != linuxcnc.MODE_AUTO or status.interp_state == linuxcnc.INTERP_IDLE
    # What the program itself sets shows here too while it runs; the layer takes what held at its start.
    program = os.path.normpath(os.path.join(home, status.file)) if status.file else ""
    return {
        "version": linuxcnc.version,
        "ini": os.path.abspath(status.ini_filename),
        "program": program,
        "text_is_file": text.is_file(program, stopped) if program else True,
        "stopped": stopped,
        "position": without_offsets(lengths.of_axes(status.position), lengths) if stopped else None,
        "work_offset": status.g5x_index,
        "work_offset_mm": lengths.of_axes(status.g5x_offset),
        "rotation_deg": status.rotation_xy,
        "g92_mm": lengths.of_axes(status.g92_offset),
        "tool_offset_mm": lengths.of_axes(status.tool_offset),
        "tool": max(status.tool_in_spindle, 0),
        "tools": tools(status, lengths),
        "block_delete": bool(status.block_delete),
        "inch": 200 in codes,
        "incremental": 910 in codes,
        "plane": next((PLANES[c] for c in codes if c in PLANES), "xy"),
        "retract_to_initial": 980 in codes,
        "centre_absolute": 901 in codes,
        "selected_tool": selected_tool(status),
        "unread": unread(status, codes, ini_files[2]),
        "path_mode": next((PATH_MODES[c] for c in codes if c in PATH_MODES), "continuous"),
        "path_tolerance_mm": tolerance_mm(status, lengths, 200 in codes),
        "machine_inch": lengths.mm != 1.0,
        "variables": ini_files[0],
        "variables_ns": stamp(ini_files[0]),
        "folders": ini_files[1],
    }


def watch():
    status = linuxcnc.stat()
    status.poll()
    lengths = Lengths(status)
    ini_files = files(status.ini_filename)
    home = os.path.dirname(os.path.abspath(status.ini_filename))
    text = OpenedText(linuxcnc.ini(status.ini_filename).find("TASK", "TASK") or "milltask")
    told, told_s, before = None, 0.0, None
    while True:
        status.poll()
        now = state(status, lengths, ini_files, home, text)
        # A position that moves is not told before it rests.
        moves, before = before is not None and now["position"] != before, now["position"]
        if moves and told is not None:
            now["position"] = told["position"]
        if now != told or time.monotonic() - told_s >= REPEAT_S:
            told, told_s = now, time.monotonic()
            print(json.dumps(now), flush=True)
        time.sleep(POLL_S)


try:
    watch()
except (BrokenPipeError, KeyboardInterrupt):
    pass
except Exception as fault:  # the reader shows it, whatever it is
    print(json.dumps({"error": "LinuxCNC's status: %s" % fault}), flush=True)
