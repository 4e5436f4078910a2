#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the figures that pages state against what the program answers.

    scripts/figures.py [--write] [--program PATH] [WORD]

docs/figures.toml names runs of the program and lines of pages made from their answers. Without --write a page whose line
differs is a fault, shown with what the line should be; with --write the line is put right. A line is found by its text
outside the figures; it is the whole line. WORD takes only the pages whose name contains it.
"""

import argparse
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FIELD = re.compile(r"\{([^{}:]+):(\.\d+f)(?:\*([\d.e-]+))?\}")
FIGURE = r"-?\d[\d ]*(?:\.\d+)?"


class Runs:
    """The answers of the runs, each made when a line first asks for it; later runs may use what earlier ones wrote."""

    def __init__(self, book, program, folder):
        self.book, self.program, self.folder = book, program, folder
        self.answers = {}

    def path(self, name):
        """{NAME} in a command: the changed machine file of that name, or a file in the scratch folder."""
        machine = self.book.get("machines", {}).get(name)
        if machine is None:
            return str(self.folder / name)
        text = (ROOT / machine["from"]).read_text(encoding="utf-8")
        for before, after in machine["changes"]:
            if text.count(before) != 1:
                sys.exit(f"docs/figures.toml: machine {name}: {machine['from']} has {text.count(before)} times {before!r}; once is allowed")
            text = text.replace(before, after)
        changed = self.folder / f"{name}.toml"
        changed.write_text(text, encoding="utf-8")
        return str(changed)

    def answer(self, name):
        if name not in self.answers:
            run = self.book["runs"][name]
            for earlier in run.get("after", []):
                self.answer(earlier)
            command = re.sub(r"\{([^{}]+)\}", lambda found: self.path(found[1]), run["command"])
            done = subprocess.run([self.program, *shlex.split(command), "--json"], cwd=ROOT, capture_output=True, text=True, check=False)
            if done.returncode != 0:
                sys.exit(f"docs/figures.toml: run {name}: exit {done.returncode}\n{done.stderr}")
            self.answers[name] = json.loads(done.stdout)
        return self.answers[name]

    def value(self, place):
        name, *keys = place.split(".")
        found = self.answer(name)
        for key in keys:
            if "=" in key:  # the element of a list with this value
                field, wanted = key.split("=")
                found = next(element for element in found if str(element[field]) == wanted)
            else:
                found = found[int(key)] if isinstance(found, list) else found[key]
        return found


def rendered(template, runs):
    def figure(found):
        over, _, under = found[1].partition("/")
        value = runs.value(over) / (runs.value(under) if under else 1.0)
        return format(float(found[3] or 1) * value, found[2])

    return FIELD.sub(figure, template)


def pattern_of(template):
    parts = [re.escape(part) for part in FIELD.sub("\0", template).split("\0")]
    return re.compile("^" + FIGURE.join(parts) + "$", re.MULTILINE)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", action="store_true", help="put the pages right")
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/steadyrest"))
    parser.add_argument("word", nargs="?", default="")
    options = parser.parse_args()
    book = tomllib.loads((ROOT / "docs/figures.toml").read_text(encoding="utf-8"))
    faults = stated = 0
    with tempfile.TemporaryDirectory() as folder:
        runs = Runs(book, options.program, pathlib.Path(folder))
        for entry in book["pages"]:
            if options.word not in entry["page"]:
                continue
            page = ROOT / entry["page"]
            text = page.read_text(encoding="utf-8")
            for template in entry["lines"]:
                stated += 1
                right = rendered(template, runs)
                places = pattern_of(template).findall(text)
                if len(places) != 1:
                    print(f"{entry['page']}: {len(places)} places read like {template!r}; exactly one is allowed")
                    faults += 1
                elif places[0] != right and not options.write:
                    print(f"{entry['page']}:{text.count(chr(10), 0, text.index(places[0])) + 1}: says\n  {places[0]}\nthe program answers\n  {right}\nrun scripts/figures.py --write")
                    faults += 1
                text = text.replace(places[0], right) if len(places) == 1 else text
            if options.write:
                page.write_text(text, encoding="utf-8")
    print(f"{stated} lines of figures, {faults} faults")
    return 1 if faults or stated == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
