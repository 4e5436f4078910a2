#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs what README.md and the pages of docs/ show.

run_snippets.py ROOT BIN FILE...
    Runs every fenced `sh` block of each FILE, in order and unchanged, in ROOT, with BIN first on the path; it must exit 0.
    Every fenced `cpp` block must be found, line for line, in a file under examples/ (which the build compiles and ctest
    runs). Fences of any other language are text. A page of docs/ with such blocks that no FILE names is a fault.
"""

import os
import pathlib
import re
import subprocess
import sys

FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LIMIT_S = 300


def snippets(text):
    for match in FENCE.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        yield line, match.group(1), match.group(2)


def run_shell(code, root, programs):
    environment = dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}")
    # ctest is itself started by make: the inner make is on its own.
    for name in ("MAKEFLAGS", "MAKELEVEL", "MFLAGS"):
        environment.pop(name, None)
    done = subprocess.run(
        ["sh", "-eu", "-c", code], cwd=root, env=environment, timeout=LIMIT_S,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    return None if done.returncode == 0 else f"exit {done.returncode}\n{done.stdout}"


def is_in_examples(code, root):
    for path in sorted((root / "examples").rglob("*.cpp")):
        if code in path.read_text(encoding="utf-8"):
            return None
    return "is in no file under examples/"


def main():
    root, programs = pathlib.Path(sys.argv[1]), sys.argv[2]
    failures = 0
    for name in sys.argv[3:]:
        failures += faults_of(name, root, programs)
    failures += len(unnamed(root, sys.argv[3:]))
    return 1 if failures or not sys.argv[3:] else 0


def unnamed(root, names):
    missing = []
    for page in sorted((root / "docs").glob("*.md")):
        name = page.relative_to(root).as_posix()
        shown = {language for _, language, _ in snippets(page.read_text(encoding="utf-8"))}
        if name not in names and shown & {"sh", "cpp"}:
            print(f"{name} shows snippets that nothing runs: name it in tests/readme/CMakeLists.txt")
            missing.append(name)
    return missing


def faults_of(name, root, programs):
    text = (root / name).read_text(encoding="utf-8")
    failures = checked = 0
    for line, language, code in snippets(text):
        if language == "sh":
            fault = run_shell(code, root, programs)
        elif language == "cpp":
            fault = is_in_examples(code, root)
        else:
            continue
        checked += 1
        print(f"{name}:{line}: {language}: {'ok' if fault is None else fault}")
        failures += fault is not None
    if checked == 0:
        print(f"{name} shows no snippet")
    return failures + (checked == 0)


if __name__ == "__main__":
    sys.exit(main())
