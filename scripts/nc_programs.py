# SPDX-License-Identifier: Apache-2.0
"""The NC programs below some folders, their dialects, and a sample of the short ones."""
import os


def programs(folders):
    for folder in folders:
        for where, _, names in sorted(os.walk(folder)):
            for name in sorted(names):
                if name.lower().endswith((".ngc", ".nc", ".gcode", ".tap", ".ncf", ".eia", ".mpf")):
                    yield os.path.join(where, name)


def dialect_of(program):
    folder = os.path.basename(os.path.dirname(os.path.abspath(program)))
    if folder in ("linuxcnc", "fanuc", "sinumerik") and os.sep + "accepted" + os.sep in os.path.abspath(program):
        return folder
    if program.lower().endswith(".mpf"):
        return "sinumerik"
    if program.endswith((".NC", ".NCF", ".EIA")):
        return "fanuc"
    return "linuxcnc"


def sample(found, most):
    """Of each dialect `most` short programs, evenly out of the list; all of them without `most`. For builds that are slow."""
    if most is None:
        return found
    out = []
    for dialect in ("linuxcnc", "fanuc", "sinumerik"):
        brief = [program for program in found if dialect_of(program) == dialect and os.path.getsize(program) <= 30_000]
        out += brief[::max(1, len(brief) // most)][:most]
    return out


def short(path, root):
    return os.path.relpath(path, root) if path.startswith(root + os.sep) else path
