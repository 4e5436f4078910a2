#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Random LinuxCNC programs, right and wrong ones: `steadyrest program moves` must accept, refuse and move as `rs274` does.

    scripts/rs274_random.py [--steadyrest build/release/bin/steadyrest] [--seed 1] [--count 200]

Prints the first programs that disagree; exit code 1 then, 77 where rs274 is absent. What only ours refuses counts as well,
but for the words that README.md of steadyrest/nc names.
"""
import math
import os
import random
import re
import sys

import rs274_oracle
from rs274_oracle import installed, oracle_parser

OFFSETS = {5161: 1, 5162: 0.5, 5163: 2, 5181: -1, 5210: 1, 5212: 0.2, 5220: 1, 5221: 0.1, 5243: -0.3}  # inches
REFUSED_BY_US_ALONE = {"tapping_off_xy", "g10_form", "cutter_comp_stop", "cutter_comp_shift", "repeat_after_continue", "loop_after_break"}


def num(r,lo,hi):
    k=r.random()
    if k<.3: return str(r.randint(int(lo),int(hi)))
    if k<.6: return "%.1f"%r.uniform(lo,hi)
    return "%.4f"%r.uniform(lo,hi)


def axes(r,letters="XYZ",p=.6,lo=-20,hi=20):
    return " ".join(l+num(r,lo,hi) for l in letters if r.random()<p)


def line(r):
    k=r.random()
    if k<.25: return r.choice(["G0","G1","G1","G1 F%d"%r.randint(1,900),""])+" "+axes(r,"XYZA" if r.random()<.1 else "XYZ")
    if k<.38:
        c=r.choice(["G2","G3"])
        if r.random()<.5:
            return f"{c} {axes(r,'XYZ')} R{num(r,-30,30)}"+(r.choice([""," P2"," P3"]))
        # closing arc
        return c+" "+r.choice(["I%s","J%s","K%s","I%s J1","I%s K1"])%num(r,-9,9)+(r.choice([""," P2"," Z%s"%num(r,-5,5)]))
    if k<.55:
        c=r.choice(["G81","G82 P.5","G83 Q%s"%num(r,1,4),"G73 Q%s"%num(r,1,4),"G85","G89 P1","G86 P1","G84","G74","G88 P1","","","G87 I1 J1 K%s"%num(r,-3,3)])
        s=c+" "+axes(r,"XY",.7)
        if r.random()<.8: s+=" "+r.choice("ZZZZYX" if r.random()<.2 else "ZZZ")+num(r,-10,2)
        if r.random()<.7: s+=" R"+num(r,-5,8)
        if r.random()<.2: s+=" L"+r.choice("0123")
        if len(set(w[0] for w in s.split() if w[0]!='G'))!=len([w for w in s.split() if w[0]!='G']): return "G80"
        return s
    if k<.62: return r.choice(["G90","G91","G90","G91","G90.1","G91.1"])
    if k<.66: return r.choice(["G17","G18","G19","G17"])
    if k<.70: return r.choice(["G20","G21"])
    if k<.76: return r.choice(["G92 ","G52 ","G92 "])+axes(r,"XYZ",.5)
    if k<.78: return r.choice(["G92.1","G92.2","G92.3"])
    if k<.82: return r.choice(["G54","G55","G56","G59.3","G54 G0 X1"])
    if k<.85: return r.choice(["G43 H1","G43 H2","G49","G43.1 Z"+num(r,-2,2),"G43.2 H1","T2 M6","T1","M6","G43"])
    if k<.88: return r.choice(["G28","G30","G28 "+axes(r),"G30 "+axes(r),"G28.1","G30.1"])
    if k<.90: return r.choice(["G98","G99"])
    if k<.92: return r.choice(["G10 L2 P%d "%r.randint(0,4)+r.choice(["","","R%s "%num(r,-90,90)]),"G10 L20 P%d "%r.randint(0,4)])+axes(r)
    if k<.94: return "G53 "+r.choice(["G0","G1",""])+" "+axes(r)
    if k<.96: return r.choice(["G93","G94","G94","G95","S100","F100","F7.5","M3","M4","M5","M3 S50","G96 S50","G97 S60","G97","M3 $0","S70 $-1","G96 S9 $0","M5 $-1"])
    if k<.962: return r.choice(["G0 G80","G80 G1 X1","G0 @%s ^%s"%(num(r,0,9),num(r,-90,200)),"G1 ^%s"%num(r,-90,90),"@%s"%num(r,1,5),"G91 G81 ^15 Z-1 R1 L2","M19 R30","M62 P1","M66 P0 L0","M70","M72","M73","G38.2 Z%s"%num(r,-9,9),"G38.3 X%s F50"%num(r,-9,9),"G10 L1 P1 Z1 R2","G10 L10 P2 Z%s"%num(r,-5,5),"G10 L11 P1 X1 Z2","#5221=1.5","#5243=2","#5211=3","#5161=4","G0 X#5063 Y#5161 Z#5222","G0 X#5403 Y#5410 Z#5220"])
    if k<.968: return r.choice(["G7","G8","G33.1 Z%s K1.5"%num(r,-5,5),"G18 G76 P1 Z%s I%s J.2 K%s R%s Q29 H%d%s"%(num(r,-9,9),r.choice(["-1","1.5"]),r.choice([".5","1.1"]),r.choice(["1","2","1.5"]),r.randint(0,2),r.choice([""," L1 E.5"," L2 E1"," L3 E.7"])),
        "G5 X%s Y%s I1 J2 P-1 Q%s"%(num(r,-9,9),num(r,-9,9),num(r,-3,3)),"G5.1 X%s Y2 I1 J-1"%num(r,-9,9),"G5.2 X1 Y2 P1 L3\nX3 Y%s P2\nX5 Y1 P1\nG5.3"%num(r,-5,5),"G0 X%s"%num(r,-9,9),"G33 Z%s K1"%num(r,-9,9)])
    if k<.97: return r.choice(["G80","G80","G4 P.1","G61","G64","G64 P.1","G61.1","M8","M9","M48","M0"])
    # junk combos
    return " ".join(r.choice(["G0","G1","G2","X1","Y1","Z1","I1","R1","P1","Q1","L2","F1","S1","T1","M3","M6","G43","H1","G90","G53","G80","G81","G92","G28","A1","D1","G91","K1","G4","M0","G10","M1","M8","M61","G98","G64","G17","G33","$0","$-1"]) for _ in range(r.randint(1,4)))


def value(r, depth=0):
    k = r.random()
    if depth > 2 or k < .3: return num(r, -9, 9).lstrip("-") if depth else num(r, -9, 9)
    if k < .45: return "#%d" % r.randint(1, 5)
    if k < .5: return r.choice(["#<a>", "#<_gg>", "#<_x>", "#5421", "#<_feed>", "#[1+#1*0]", "#<_value>", "#<_call_level>", "#<_motion_mode>", "#5220", "#5221"])
    if k < .6: return r.choice(["ABS", "COS", "SIN", "FIX", "FUP", "ROUND", "EXISTS"]) .replace("EXISTS", "ABS") + "[" + value(r, depth + 1) + "]"
    if k < .63: return "ATAN[" + value(r, depth + 1) + "]/[" + value(r, depth + 1) + "]"
    if k < .66: return r.choice(["EXISTS[#<a>]", "EXISTS[#<zz>]", "SQRT[ABS[%s]]" % value(r, depth + 1), "-[%s]" % value(r, depth + 1)])
    operators = ["+", "-", "*", "/", "**", "MOD", " EQ ", " NE ", " LT ", " GE ", " AND ", " OR ", " XOR ", "GT", "LE"]
    return "[" + value(r, depth + 1) + "".join(r.choice(operators[:4] if r.random() < .7 else operators) + value(r, depth + 1) for _ in range(r.randint(1, 3))) + "]"


def blocks(r, labels, depth, loops, in_sub):
    """Lines with nested O-words; every loop counts in a parameter of its own, so that it ends."""
    lines = []
    for _ in range(r.randint(1, 4)):
        k = r.random()
        if depth > 3 or k < .45:
            lines.append(r.choice(["G0 X%s", "G0 Y%s", "G1 X%s F90", "G91 G0 X%s", "G90 G0 Z%s", "G0 X%s #1=[#1+1]", "G0 Y%s #<a>=[#<a>*0.5]"]) % value(r))
            continue
        if k < .55:
            lines.append(r.choice(["#%d = %s" % (r.randint(1, 5), value(r)), "#<a>=%s" % value(r), "#<_gg> = %s" % value(r), "#5221=%s" % num(r, -3, 3)]))
            continue
        labels[0] += 1
        o = "o%d" % labels[0] if r.random() < .8 else "O<n%d>" % labels[0]
        if k < .7:
            lines.append(f"{o} if [{value(r)}]")
            lines += blocks(r, labels, depth + 1, loops, in_sub)
            if r.random() < .4:
                lines.append(f"{o} elseif [{value(r)}]")
                lines += blocks(r, labels, depth + 1, loops, in_sub)
            if r.random() < .5:
                lines.append(f"{o} else")
                lines += blocks(r, labels, depth + 1, loops, in_sub)
            lines.append(f"{o} endif")
        elif k < .78:
            lines.append(f"{o} repeat [{r.choice(['0', '1', '2', '3', '1.6', '-1'])}]")
            lines += blocks(r, labels, depth + 1, loops + [(o, "repeat")], in_sub)
            lines.append(f"{o} endrepeat")
        elif k < .93:
            counter = "#%d" % (100 + labels[0])
            lines.append(f"{counter}=0")
            kind = r.choice(["while", "do"]) if DO[0] else "while"
            lines.append(f"{o} while [{counter} LT {r.randint(0, 4)}]" if kind == "while" else f"{o} do")
            lines.append(f"{counter}=[{counter}+1]")
            lines += blocks(r, labels, depth + 1, loops + [(o, kind)], in_sub)
            lines.append(f"{o} endwhile" if kind == "while" else f"{o} while [{counter} LT {r.randint(0, 4)}]")
        elif loops and r.random() < .7 and not DO[0]:
            target, kind = r.choice(loops[-2:])
            labels[0] += 1
            lines += [f"o{labels[0]} if [{value(r)}]", f"{target} {r.choice(['break', 'continue'])}", f"o{labels[0]} endif"]
        elif in_sub:
            lines += [f"o{labels[0]} if [{value(r)}]", f"{in_sub} return [{value(r)}]", f"o{labels[0]} endif"]
    return lines


DO = [False]  # do loops, or break and continue: after a break rs274 2.9 leaves a later do loop after its first turn


def structured(r):
    DO[0] = r.random() < .4
    labels = [10]
    lines = ["F100 S100 M3", "#<a>=2", "#<_gg>=3"]
    subs = ["o1", "o<Two>"][:r.randint(0, 2)]
    for index, sub in enumerate(subs):
        body = [f"{sub} sub", "#<a>=1"] + blocks(r, labels, 1, [], sub)
        if index:
            body.append(f"{subs[0]} call [{value(r)}]")
        lines += body + [f"{sub} endsub" + r.choice(["", f" [{value(r)}]"])]
    for _ in range(r.randint(1, 3)):
        lines += blocks(r, labels, 0, [], "")
        if subs:
            lines.append(f"{r.choice(subs)} call [{value(r)}] [{value(r)}]")
    return lines


FORBIDDEN = ["G18", "G19", "G54", "G55", "G43 H1", "G49", "G64", "G61", "G98", "G92 X1", "G52 X1", "G28", "G28.1", "G30 X1",
             "G53 G0 X1", "M6", "T2", "M48", "M62 P1", "M66 P0 L0", "G81 X1 Z-1 R1", "G38.2 Z-9", "G41 D1", "G42", "G10 L2 P1 X1",
             "G10 L2 P3 X1", "G10 L1 P1 Z1", "G10 L20 P0 X1", "#1=#5420", "#1=#<_x> #2=#<_ccomp>", "G0 X#<_y>", "G1 X[#<_abs_x>+1]", "G1 Z#<_abs_y>", "A[EXISTS[#5420]]", "#1=#5421", "G17",
             "G1 X[#<_x>+1]", "M50 P0", "G20", "G21", "M19 R1", "M8", "G4 P.1", "G80", "G97", "(note)", "D1", "G41.1", "G92.2",
             "M60", "G8", "G96 S50", "G40 G1 X3 Y4", "G40 G49", "G40 G18", "G40 G2 X1 I1", "M2", "T1 M6", "G5 X9 I1 J1 P1 Q1"]


def contour(r):
    """Compensated contours: lines and arcs at every kind of corner, both sides, with other blocks in between."""
    first, second, centre = r.choice([("X", "Y", "IJ"), ("X", "Y", "IJ"), ("Z", "X", "KI")])
    other = "Y" if first == "Z" else "Z"
    size = r.choice([0.3, 1, 3])  # length of the pieces
    lines = ["F100 S100 M3", "G18" if first == "Z" else "G17"] + (["G20"] if r.random() < .15 else [])
    tool = r.choice([2, 2, 1, 4, 0.5, 6, -2, 0])
    on = r.choice(["G41", "G42"])
    if r.random() < .3:
        number = r.choice([0, 1, 1, 2, 3, 7, 30])
        lines += r.choice([["T%d" % number, "M6", on], [on + " D%d" % number], ["T%d M6" % number, on + " D0"], [on]])
    else:
        lines += [on + ".1 D%g" % tool + (" L%d" % r.randint(0, 9) if first == "Z" and r.random() < .4 else "")]
    u = v = 0.0
    heading = r.uniform(0, 6.283)
    handed = r.choice([-1, 1])
    if r.random() < .1:
        lines[-1] += " G1 %s%.3f %s%.3f" % (first, 9, second, 9)
        u = v = 9.0
    for index in range(r.randint(2, 9)):
        if r.random() < .12:
            lines.append(r.choice(["G1 %s%s" % (other, num(r, -5, 5)), "G0 %s%s" % (other, num(r, -5, 5)), "A%s" % num(r, 0, 90), "F%d" % r.randint(10, 900), "G4 P.1", "M5",
                                   "M3", "G0", "G1"] + (["M0", "M1"] if r.random() < .2 else [])))
        if r.random() < .03:
            lines.append(r.choice(FORBIDDEN))
        if r.random() < .05:
            lines.append("G40")
            if r.random() < .5:
                lines.append(r.choice(["G0 %s5" % other, "G1 %s%.3f" % (first, u + 3), "G4 P1", "M0", "G0", "G92.1", "G81 X3 Z-1 R1 G98", "G53 G0 X1", "G38.2 Z-9 F9", "G28", "G80", "G92 X3"]))
            if r.random() < .6:
                lines.append(r.choice(["G41.1 D2", "G42.1 D1", "G42 D3"]))
        k = r.random()
        heading += r.choice([0, 0, 1.5708, -1.5708, 3.14159, r.uniform(-.12, .12), handed * r.uniform(0, 3.1), r.uniform(-3.1, 3.1)])
        length = r.choice([1, 1, 5, 20]) * size * r.uniform(.5, 3)
        height = " %s%s" % (other, num(r, -5, 5)) if r.random() < .1 else ""
        speed = " F%d" % r.randint(10, 900) if r.random() < .1 else ""
        if k < .55:
            u += length * math.cos(heading)
            v += length * math.sin(heading)
            lines.append("%s %s%.4f %s%.4f%s%s" % (r.choice(["G1", "G1", "G1", "G0"]), first, u, second, v, height, speed))
            continue
        turn = r.choice([-1, 1])
        radius = length
        sweep = r.choice([1.5708, 3.14159, r.uniform(.1, 6), r.uniform(.1, 3)])
        a = heading + math.pi / 2 * turn
        cu, cv = radius * math.cos(a), radius * math.sin(a)
        nu = u + cu - radius * math.cos(a + turn * sweep)
        nv = v + cv - radius * math.sin(a + turn * sweep)
        code = "G3" if turn > 0 else "G2"
        if r.random() < .35:
            lines.append("%s %s%.4f %s%.4f R%.4f%s%s" % (code, first, nu, second, nv, radius * (1.00001 if sweep < 3.1 else -1.00001), height, speed))
        else:
            off = r.choice([0, 0, 0, .01, .02])
            lines.append("%s %s%.4f %s%.4f %s%.4f %s%.4f%s%s%s" % (code, first, nu + off, second, nv, centre[0], cu, centre[1], cv, height, speed, " P2" if r.random() < .05 else ""))
            nu += off
        u, v = float("%.4f" % nu), float("%.4f" % nv)
        heading += turn * sweep
    if r.random() < .2:
        lines.insert(2, "G93" if r.random() < .5 else "G95")
        if lines[2] == "G93":
            lines = [l + " F7" if l[:2] in ("G1", "G2", "G3") and l[2:3] == " " and "F" not in l else l for l in lines]
        else:
            lines.insert(3, "F0.2")
    if r.random() < .6:
        lines += ["G40", "G%d %s%s %s%s" % (r.choice([0, 1]), first, num(r, -9, 9), second, num(r, -9, 9)) + (" F5" if "G93" in lines else "")]
        lines += [r.choice(["G0 %s1" % first, "G3 %s%s I1" % (first, num(r, -9, 9)), "G1 X1 F10"])]
    return lines


def spaced(r, text):
    """Blanks mean nothing anywhere, even within a number or a name."""
    often = r.choice([.03, .2, .6])
    return "".join(c + (r.choice([" ", "\t", "  "]) if c != "\n" and r.random() < often else "") for c in text)


def variables():
    return "".join(f"{number}\t{OFFSETS.get(number, 0):.6f}\n" for number in range(5161, 5401))


def main():
    parser = oracle_parser(__doc__)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--kind", type=int, help="only these: 0 single lines, 1 O-words, 2 compensated contours")
    arguments = parser.parse_args()
    if not installed(arguments.rs274):
        return 77
    oracle = rs274_oracle.Oracle(arguments.rs274, variables())
    offsets, program = oracle.path("offsets.var"), oracle.path("random.ngc")
    with open(offsets, "w") as out:
        out.write(variables())
    bad = accepted = 0
    for index in range(arguments.count):
        r = random.Random(arguments.seed * 1000003 + index)
        kinds = [lambda: ["F100 S100 M3", "G0 X1 Y2 Z3"] + [line(r) for _ in range(r.randint(3, 9))], lambda: structured(r), lambda: contour(r)]
        body = kinds[index % 3 if arguments.kind is None else arguments.kind]()
        body.append("M2")
        text = "\n".join(body) + "\n"
        if re.search(r"M6\b", text) and re.search(r"G43", text):
            continue  # rs274 alone forgets the tool's length at M6
        if re.search(r"G43[\s\S]*(G2[01]\b|M72|M73)", text):
            continue  # rs274 keeps the tool's length as a number when the unit changes
        if re.search(r"G91[\s\S]*G5\.2", text):
            continue  # not interpreted
        if r.random() < .3:
            text = spaced(r, text)
        with open(program, "w") as out:
            out.write(text)
        result = rs274_oracle.judge(os.path.abspath(arguments.steadyrest), oracle, program,
                                   extra=("--variables", offsets))
        accepted += result["accepted"]
        verdict = result["verdict"]
        reason = (result["refusal"] or {}).get("reason")
        if reason in REFUSED_BY_US_ALONE:
            continue
        if not verdict and not result["accepted"] and result["rs274_ok"]:
            verdict = f"only ours refuses: {reason} line {result['refusal']['line']}"
        if verdict:
            bad += 1
            print(f"--- seed {arguments.seed}, program {index}: {verdict} | rs274: {result['rs274']}\n{text}")
    oracle.close()
    print(f"{arguments.count} random programs, {accepted} accepted, {bad} disagree")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
