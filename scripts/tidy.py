#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""clang-tidy over our translation units and through them our headers; any finding fails.

    scripts/tidy.py [--tests] [--changed] [PATTERN]

--tests takes the tests too; PATTERN (a regular expression) only files whose path matches. --changed takes
the sources whose code differs from that of the commit in scripts/tidy-base, at which all was clean (by the full
run, or by --changed from an earlier such commit), and for each such header one source that includes it; the full
run where history does not reach back that far.
A file whose preprocessed text, flags and checks are those of an earlier clean run is not examined again.
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "clang"
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME", pathlib.Path.home() / ".cache")) / "steadyrest-tidy"
FOLDERS = ("steadyrest", "tests", "bench", "examples", "fuzz")
IS_TEST = re.compile(r"(^tests/|/test/|/testing/)")
# GoogleTest's and RapidCheck's macros create their own names, statics and statements.
NOT_IN_TESTS = (
    "-readability-identifier-naming,-readability-braces-around-statements,"
    "-readability-function-size,-misc-use-internal-linkage,-cppcoreguidelines-*,"
    "-bugprone-chained-comparison,-bugprone-unused-return-value")
NOISE = re.compile(r"^(\d+ warnings?.* generated\.|Suppressed .*|Use -header-filter.*|)$")


def commands(tests, pattern):
    for entry in json.loads((BUILD / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        if path.suffix != ".cpp" or not path.is_relative_to(ROOT):
            continue
        name = str(path.relative_to(ROOT))
        if name.split("/")[0] not in FOLDERS or not re.search(pattern, name):
            continue
        if IS_TEST.search(name) and not tests:
            continue
        yield name, entry


def code_of(text):
    """The text without comments and spacing; what a comment says to clang-tidy stays."""
    token = r'"(?:\\.|[^"\\\n])*"|//[^\n]*|/\*.*?\*/'
    keep = lambda found: found[0] if found[0].startswith('"') or "NOLINT" in found[0] else ""
    return re.sub(r"\s+", "", re.sub(token, keep, text, flags=re.S))


def changed_since_base():
    """Paths that differ from the commit in scripts/tidy-base; None where git does not know it, or where
    the checks themselves differ."""
    base = (ROOT / "scripts" / "tidy-base").read_text().split()[0]
    done = subprocess.run(["git", "diff", "--name-only", "--diff-filter=d", base], cwd=ROOT,
                          capture_output=True, text=True, check=False)
    paths = set(done.stdout.split())
    if done.returncode or ".clang-tidy" in paths:
        return None
    return {path for path in paths if not has_same_code(base, path)}


def has_same_code(base, path):
    if not path.endswith((".cpp", ".hpp")):
        return False
    before = subprocess.run(["git", "show", f"{base}:{path}"], cwd=ROOT, capture_output=True, check=False)
    now = (ROOT / path).read_text(errors="replace")
    return before.returncode == 0 and code_of(before.stdout.decode(errors="replace")) == code_of(now)


def sees(header, names, includes):
    """Of the sources `names` one that includes `header`, the one named like it first; a chain of headers counts."""
    stem = re.sub(r"\.hpp$", "", header)
    reached, rings = {header}, [header]
    while rings:
        ring = [path for path in includes if includes[path] & set(rings) and path not in reached]
        sources = sorted((name for name in ring if name in names), key=lambda n: (not n.startswith(stem), n))
        if sources:
            return sources[0]
        reached.update(ring)
        rings = ring
    return None


def only_changed(work, paths):
    names = {name for name, _ in work}
    includes = {}
    for folder in FOLDERS:
        for path in (ROOT / folder).rglob("*.[hc]pp"):
            text = path.read_text(errors="replace")
            includes[str(path.relative_to(ROOT))] = set(re.findall(r"#include <([^>]+)>", text))
    wanted = names & paths
    for header in sorted(path for path in paths if path.endswith(".hpp")):
        wanted.add(sees(header, names, includes))
    return [item for item in work if item[0] in wanted]


def key_of(name, entry):
    words = [w for w in shlex.split(entry["command"]) if w != "ccache"]
    out = words.index("-o")
    flags = words[1:out] + words[out + 2:]
    text = subprocess.run([words[0], *[f for f in flags if f != "-c"], "-E", "-P"],
                          cwd=entry["directory"], capture_output=True, check=True).stdout
    parts = (name, " ".join(flags).replace(str(ROOT), ""), (ROOT / ".clang-tidy").read_text(), NOT_IN_TESTS)
    return hashlib.sha256("\0".join(parts).encode() + text).hexdigest()


def examine(name, entry):
    mark = CACHE / key_of(name, entry)
    if mark.exists():
        return name, "", True
    checks = NOT_IN_TESTS if IS_TEST.search(name) else ""
    done = subprocess.run(
        ["clang-tidy-19", f"-p={BUILD}", "--quiet", f"--checks={checks}", str(ROOT / name)],
        cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    findings = "\n".join(l for l in done.stdout.splitlines() if not NOISE.match(l))
    if done.returncode == 0:
        mark.touch()
        return name, "", False
    return name, findings or f"clang-tidy ended with {done.returncode}", False


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tests", action="store_true", help="the tests too")
    parser.add_argument("--changed", action="store_true", help="what differs from scripts/tidy-base")
    parser.add_argument("pattern", nargs="?", default="", help="only files whose path matches")
    options = parser.parse_args()
    CACHE.mkdir(parents=True, exist_ok=True)
    work = list(commands(options.tests, options.pattern))
    paths = changed_since_base() if options.changed else None
    if paths is not None:
        whole, work = len(work), only_changed(work, paths)
        print(f"clang-tidy: {len(work)} of {whole} files, what differs from scripts/tidy-base")
    seen, known, failed = set(), 0, 0
    jobs = int(os.environ.get("JOBS") or os.cpu_count() or 1)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(examine, *item) for item in work]
        for count, future in enumerate(concurrent.futures.as_completed(futures), 1):
            name, findings, was_known = future.result()
            known += was_known
            failed += bool(findings)
            if not was_known:
                print(f"[{count}/{len(work)}] {name}", flush=True)
            show = True
            for line in findings.splitlines():
                # A header's finding appears with each file that includes it: report it once.
                if re.search(r": (error|warning): ", line):
                    show = line not in seen
                    seen.add(line)
                if show:
                    print(line, flush=True)
    print(f"clang-tidy: {len(work)} files, {known} unchanged since a clean run, {failed} with findings")
    return 1 if failed or not (work or options.changed) else 0


if __name__ == "__main__":
    sys.exit(main())
