#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random conditions and loops of fanuc and sinumerik: `steadyrest program moves` must move as `rs274` does with the same
program in O-words. Jumps have no O-word; steadyrest/nc/interpret/flow/test/random_flow_test.cpp has those.

    scripts/rs274_flow.py [--steadyrest build/release/bin/steadyrest] [--seed 1] [--count 100]

Prints the programs that disagree; exit code 1 then, 77 where rs274 is absent.
"""
import os
import random
import sys

import rs274_oracle
from nc_in_linuxcnc_words import equivalent_of
from rs274_oracle import installed, oracle_parser

OPERATORS = {"fanuc": ["EQ", "NE", "GT", "GE", "LT", "LE"], "sinumerik": ["==", "<>", ">", ">=", "<", "<="]}


class Writer:
    def __init__(self, seed, dialect):
        self.random, self.dialect, self.lines, self.loops, self.counters = random.Random(seed), dialect, [], 0, 0

    def fanuc(self):
        return self.dialect == "fanuc"

    def variable(self, number):
        return f"#{100 + number}" if self.fanuc() else f"R{number}"

    def condition(self, variable=None, operator=None, value=None):
        operator = self.random.choice(OPERATORS[self.dialect]) if operator is None else OPERATORS[self.dialect][operator]
        variable = self.variable(self.random.randint(1, 4)) if variable is None else variable
        value = self.random.randint(-2, 6) if value is None else value
        return f"[{variable} {operator} {value}]" if self.fanuc() else f"{variable}{operator}{value}"

    def counter(self, value):
        self.counters += 1
        variable = self.variable(10 + self.counters)
        self.lines.append(f"{variable}={value}")
        return variable

    def move(self):
        variable, number = self.variable(self.random.randint(1, 4)), self.random.randint(0, 20)
        self.lines.append(f"G0 X[{variable}+{number}]" if self.fanuc() else f"G0 X={variable}+{number}")

    def assign(self):
        one, other = (self.variable(self.random.randint(1, 4)) for _ in range(2))
        self.lines.append(self.random.choice([f"{one}={self.random.randint(0, 8)}", f"{one}={one}+{self.random.randint(1, 3)}",
                                              f"{one}={other}", f"{one}={other}-{one}"]))

    def block(self, depth):
        for _ in range(self.random.randint(1, 3)):
            self.random.choice([self.move, self.move, self.assign] + [lambda: self.branch(depth), lambda: self.loop(depth)] * (depth < 3))()

    def branch(self, depth):
        if self.fanuc():
            self.lines.append(f"IF{self.condition()}THEN {self.variable(self.random.randint(1, 4))}={self.random.randint(0, 9)}")
            return
        self.lines.append("IF " + self.condition())
        self.block(depth + 1)
        if self.random.random() < .5:
            self.lines.append("ELSE")
            self.block(depth + 1)
        self.lines.append("ENDIF")

    def loop(self, depth):
        kind = self.random.randint(0, 2)
        if self.fanuc() or kind == 0:
            if self.loops == 3:
                return
            self.loops += 1
            number = self.loops
            counter = self.counter(self.random.randint(0, 3))
            condition = self.condition(counter, 2, 0)
            self.lines.append(f"WHILE{condition}DO{number}" if self.fanuc() else f"WHILE {condition}")
            self.lines.append(f"{counter}={counter}-1")
            self.block(depth + 1)
            self.lines.append(f"END{number}" if self.fanuc() else "ENDWHILE")
            self.loops -= 1
        elif kind == 1:
            self.counters += 1
            begin = self.random.randint(0, 3)
            self.lines.append(f"FOR {self.variable(10 + self.counters)}={begin} TO {begin + self.random.randint(-1, 3)}")
            self.block(depth + 1)
            self.lines.append("ENDFOR")
        else:
            counter = self.counter(self.random.randint(0, 3))
            self.lines.append("REPEAT")
            self.block(depth + 1)
            self.lines.append(f"{counter}={counter}-1")
            self.lines.append(f"UNTIL {self.condition(counter, 5, 0)}")

    def text(self):
        self.lines.append("G21 G17 G90 G94 G0 X0 Y0 Z0" if self.fanuc() else "G71 G17 G90 G94 G0 X0 Y0 Z0")
        self.lines += [f"{self.variable(number)}={self.random.randint(0, 5)}" for number in range(1, 5)]
        for _ in range(self.random.randint(2, 6)):
            self.block(0)
        return "\n".join(self.lines + ["M30"]) + "\n"


def main():
    parser = oracle_parser(__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=100)
    arguments = parser.parse_args()
    if not installed(arguments.rs274):
        return 77
    oracle = rs274_oracle.Oracle(arguments.rs274)
    bad = moves = 0
    for index in range(arguments.count):
        dialect = ("fanuc", "sinumerik")[index % 2]
        program = oracle.path("flow.ngc")
        with open(program, "w") as out:
            out.write(Writer(arguments.seed * 1000003 + index, dialect).text())
        result = rs274_oracle.judge(os.path.abspath(arguments.steadyrest), oracle, program, dialect, equivalent_of(program, dialect, oracle))
        moves += result["moves"]
        verdict = result["verdict"] or ("" if result["accepted"] else f"refused: {result['refusal']}")
        if verdict:
            bad += 1
            print(f"--- seed {arguments.seed}, program {index}: {verdict} | rs274: {result['rs274']}\n{open(program).read()}")
    oracle.close()
    print(f"{arguments.count} random programs of conditions and loops, {moves} moves, {bad} disagree")
    return 1 if bad or not moves else 0


if __name__ == "__main__":
    sys.exit(main())
