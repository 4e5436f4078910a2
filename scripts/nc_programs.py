# SPDX-License-Identifier: Apache-2.0
"""The NC programs below some folders, their dialects, and a sample of the short ones; the options of every script that compares."""
import argparse
import os

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def script_parser(doc):
    parser = argparse.ArgumentParser(description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--steadyrest", default=os.path.join(ROOT, "build/release/bin/steadyrest"))
    return parser


def add_folders(parser):
    shared = os.environ.get("STEADYREST_SHARED_DATA", os.path.join(ROOT, "../shared/data"))
    parser.add_argument("--data", default=os.path.join(shared, "nc"))
    parser.add_argument("--linuxcnc", nargs="*", default=["/usr/share/linuxcnc", "/usr/share/doc/linuxcnc/examples"])


def programs(folders):
    for folder in folders:
        for where, _, names in sorted(os.walk(folder)):
            for name in sorted(names):
                if name.lower().endswith((".ngc", ".nc", ".gcode", ".tap", ".ncf", ".eia", ".mpf")):
                    yield os.path.join(where, name)


def dialect_of(program):
    folder = os.path.basename(os.path.dirname(os.path.abspath(program)))
    if folder in ("linuxcnc", "fanuc", "sinumerik", "haas", "grbl", "mach3") and os.sep + "accepted" + os.sep in os.path.abspath(program):
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
