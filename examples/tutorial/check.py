#!/usr/bin/python3
"""Compares what the decks of the tutorial printed with theory and with what doc/tutorial.md quotes.  Fails if either is off."""

import math
import os
import re
import sys

TUTORIAL = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "doc", "tutorial.md")
# Steps without noise give the same digits on every machine; the others do so until round-off has grown.
REPEATABLE = ("1", "1.40", "3", "3.8", "4", "4.open")


def printed(name):
    """The result lines of a log: those of the print commands at its end."""
    with open(f"results/{name}.log") as f:
        return [line.strip() for line in f if re.match(r"(side|D/D0|distance|height|pse:|fib:|none:) ?\S* ", line)]


def numbers(line):
    return [float(w) for w in re.findall(r"(?<![\w/])-?\d+\.\d+", line)]


def main():
    faults = []

    def check(what, value, expected, allowed):
        good = abs(value - expected) <= allowed
        print(f"  {'ok ' if good else 'BAD'}  {what}: {value:g}, expected {expected:g} +- {allowed:g}")
        if not good:
            faults.append(what)

    # tolerance 1e-6, six digits printed
    for name in ("1", "1.40"):
        value, theory = numbers(printed(name)[-1])
        check(f"step {name}: mobility of a sphere", value, theory, 3e-6)
    # theory neglects terms of order (distance/side)^2 a/side, which are largest for a distance of 8: 64e-6
    for name, allowed in (("3", 2e-4), ("3.8", 6e-4)):
        value, theory = numbers(printed(name)[-1])
        check(f"step {name}: velocity of the second sphere", value, theory, allowed)
    along, across = zip(*(numbers(line)[-2:] for line in printed("4")))
    check("step 4: heights at which the mobility falls towards the wall, along and across",
          sum(a > b for row in (along, across) for a, b in zip(row, row[1:])), 14, 0)
    check("step 4: heights at which motion across is slower than along", sum(a < b for a, b in zip(across, along)), 8, 0)
    # One wall alone: FIB eq. (40) and (42).  The other wall is far away, and the radius varies by 0.7 % with the position in a cell.
    third = printed("4")[3]
    check("step 4: mobility along at height 3", numbers(third)[0], 1 - 9 / 48 + 1 / 216 - 45 / 256 / 81 - 1 / 16 / 243, 0.01)
    check("step 4: mobility across at height 3", numbers(third)[1], 1 - 9 / 24 + 1 / 54 - 1 / 8 / 243, 0.01)
    # Periodic images at 32 radii add 2.16 height^2/(viscosity side^3) along the plate, and hardly anything across.
    for name, row, height in (("3", 3, 3), ("8", 0, 8)):
        along, across = numbers(printed("4.open")[row])[-2:]
        check(f"step 4, open: mobility across at height {name}", across, 1 - 9 / 8 / height + 1 / 2 / height**3 - 1 / 8 / height**5, 0.01)
        if height < 4:
            check(f"step 4, open: mobility along at height {name}", along,
                  1 - 9 / 16 / height + 1 / 8 / height**3 - 1 / 16 / height**5 + 6 * math.pi * 2.16 * height**2 / 32**3, 0.01)
    # 125 spheres x 3 directions x 500 steps: sqrt(2/187500) = 0.33 %, slightly correlated by the fluid; 4 s.e.
    value, theory = numbers(printed("2")[-1])
    check("step 2: diffusion", value, theory, 0.015)
    # 512 x 3 x 1000: 0.12 %; forces add up to 1 % to the motion of a step
    for name, expected in (("pse", numbers(printed("5.pse")[-1])[1]), ("none", 1.0)):
        check(f"step 5, {name}: short-time diffusion", numbers(printed(f"5.{name}")[-1])[0], expected, 0.015)
    check("step 5, fib: short-time diffusion", numbers(printed("5.fib")[-1])[0],
          numbers(printed("5.pse")[-1])[1] / 1.0035, 0.015)    # its radius is 1.0035
    gel = {name: numbers(printed(f"6.{name}")[-1])[0] for name in ("pse", "none")}
    check("step 6: contacts that hydrodynamic interactions delay, per colloid", gel["none"] - gel["pse"], 0.6, 0.5)

    with open(TUTORIAL) as f:
        text = f.read()
    missing = [line for name in REPEATABLE for line in printed(name) if line not in text]
    for line in missing:
        print(f"  BAD  doc/tutorial.md does not quote: {line}")
    print("verdict: " + ("all as the tutorial says" if not faults + missing else "NOT as the tutorial says"))
    if faults or missing:
        sys.exit(1)


if __name__ == "__main__":
    main()
