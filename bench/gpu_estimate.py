#!/usr/bin/python3
"""Bytes and operations per particle and step of each kernel on a GPU, and the throughput that these allow.

    bench/gpu_estimate.py [build/lmp] [--side 64] [--rate 1.0]
    bench/gpu_estimate.py build-kokkos-cuda/lmp --side 22 46 100 --measure "-k on g 1 -sf kk"

An estimate on paper, made for a scene of the PSE paper's Table I (spheres at a volume fraction of 0.1, xi a = 0.5, tolerance
1e-3, side^3 of them).  The plan of each fix is taken from LAMMPS ("run 0").  A kernel takes the longer of bytes/bandwidth and
operations/rate, both at their peak; --rate 0.5 assumes half of the peaks.  With --measure the same scenes are run with these
options of LAMMPS, on --ranks processes, and the throughput is printed beside the bounds; see bench/gpu.sh.
"""
import argparse
import math
import os
import re
import subprocess
import sys
import tempfile

# Peaks from the vendor's data sheets: memory [byte/s], single and double precision [1/s], atomic additions in the second-level
# cache [1/s] (one per clock and cache slice; K40: per memory partition).
DEVICES = {
    "K40": dict(memory=288e9, single=4.3e12, double=1.43e12, atomics=48 * 0.75e9),
    "A100": dict(memory=1555e9, single=19.5e12, double=9.7e12, atomics=80 * 1.41e9),
    "H100": dict(memory=3350e9, single=67e12, double=34e12, atomics=96 * 1.7e9),
}
PHI = 0.1

DECK = """
units lj
atom_style atomic
boundary p p {across}
lattice sc {density} origin 0.5 0.5 0.5
region box block 0 {side} 0 {side} 0 {side}
create_box 1 box
create_atoms 1 box
mass 1 1.0
neighbor 0.3 bin
neigh_modify every 1 delay 0 check yes
timestep 0.001
fix push all setforce 0.1 0.2 0.3
fix move all {fix}
run 0
"""


PSE = "bd/pse {kT} 1.0 4711 radius 1.0 tolerance 1e-3 xi 0.5 fft estimate"
FIB = "bd/fib 1.0 1.0 4711 radius 1.0 fft estimate"
WALLS = " wall zlo noslip wall zhi noslip"


def output_of(command, side, fix, across="p", more=""):
    """What LAMMPS prints about the fix for this system; across: "f" for walls."""
    with tempfile.TemporaryDirectory() as folder:
        deck = os.path.join(folder, "in.plan")
        with open(deck, "w") as f:
            f.write(DECK.format(density=PHI / (4.0 / 3.0 * math.pi), side=side, fix=fix, across=across) + more)
        run = subprocess.run([*command, "-in", deck, "-log", "none"], cwd=folder, capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{run.stdout[-2000:]}{run.stderr[-2000:]}")
    return run.stdout


def plan_of(lmp, side, fix, across="p"):
    out = output_of([os.path.abspath(lmp)], side, fix, across)
    return out[out.index("plan"):]


def measured(args, side, fix, across):
    """10^6 particle steps per second in the second of two runs."""
    steps = max(5, 2000000 // side**3)
    command = ["mpirun", "-np", str(args.ranks)] if args.ranks > 1 else []
    out = output_of([*command, os.path.abspath(args.lmp), *args.measure.split()], side, fix, across, f"run {steps}\nrun {steps}\n")
    return 1e-6 * side**3 * steps / float(re.findall(r"^Loop time of (\S+)", out, re.M)[-1])


def number(text, pattern):
    return float(re.search(pattern, text).group(1))


class Kernel:
    """Per particle and step: bytes to and from memory, operations in single and double precision, atomic additions."""

    def __init__(self, name, bytes=0.0, single=0.0, double=0.0, atomics=0.0):
        self.name, self.bytes, self.single, self.double, self.atomics = name, bytes, single, double, atomics

    def seconds(self, device, rate):
        d = DEVICES[device]
        return max(self.bytes / d["memory"], self.single / d["single"] + self.double / d["double"], self.atomics / d["atomics"]) / rate


def transforms(cells, total, word, count, axes=3):
    """Transforms of real fields: each axis reads and writes the field once; 2.5 M log2 M operations for M points (`total`)."""
    operations = count * 2.5 * cells * math.log2(total)
    return dict(bytes=count * axes * 2 * word * cells, single=operations if word == 4 else 0.0, double=operations if word == 8 else 0.0)


# Philox with ten rounds and Box-Muller for four normals, as in base/rng_kernel.h: integer operations count as
# single-precision operations; the logarithms, roots and sines are in double precision.
DRAW = dict(single=110.0, double=160.0)


def pse_kernels(lmp, side, noise):
    plan = plan_of(lmp, side, PSE.format(kT="1.0"))
    points = [int(n) for n in re.search(r"wave space +(\d+) x (\d+) x (\d+)", plan).groups()]
    n, total = side**3, points[0] * points[1] * points[2]
    pairs, r_cut = number(plan, r"about (\d+) neighbors"), number(plan, r"within r_c = ([\d.]+)")
    listed = pairs * ((r_cut + 0.3) / r_cut) ** 3
    width, cells = number(plan, r"window of (\d+)"), total / n
    iterations = number(plan, r"about (\d+) iterations") if noise else 0
    word, tile = 4, 8
    per_tile = n / (total / tile**3)
    by_tile = per_tile > (tile + width) ** 3 / width**3
    spread = 3 * ((tile + width) ** 3 / per_tile if by_tile else width**3)
    # Vectors have four numbers per particle.  A Lanczos iteration does two sums over one or two vectors, w -= a v + b u, v := w/beta.
    vectors = iterations * 4 * word * (2 + 4 + 1 + 2) + (iterations + 1) * 4 * word
    kernels = [
        Kernel("positions and forces of the group", bytes=48 + 60 + 2 * 48),
        Kernel("pairs from the neighbor list", bytes=listed * 4 + pairs * 6 * word, double=listed * 10 + pairs * 25, single=pairs * 20),
        Kernel(f"M_r, {iterations + 1:.0f} times", bytes=(iterations + 1) * (pairs * 6 * word + 2 * 4 * word), single=(iterations + 1) * pairs * 20),
        Kernel("vectors of Lanczos", bytes=vectors, single=vectors / word * 2),
        Kernel("spreading by " + ("tiles" if by_tile else "particles"), bytes=2 * 3 * word * cells, single=3 * width * 14 * width + 6 * width**3, atomics=spread),
        Kernel("six transforms", **transforms(cells, total, word, 6)),
        Kernel("modes" + (" and their noise" if noise else ""), bytes=2 * 3 * word * cells, double=cells / 2 * (110 + (DRAW["double"] if noise else 0)),
               single=cells / 2 * (DRAW["single"] if noise else 0)),
        Kernel("interpolation", bytes=3 * word * cells + 48, single=3 * (3 * width * 14 + 2 * width**3)),
    ]
    title = f"fix bd/pse, {'M F and noise' if noise else 'M F'}: {n} particles, {points[0]} x {points[1]} x {points[2]} points, single precision"
    return title, n, kernels


def fib_kernels(lmp, side, slit):
    plan = plan_of(lmp, side, FIB + (WALLS if slit else ""), "f" if slit else "p")
    points = [int(n) for n in re.search(r"grid +(\d+) x (\d+) x (\d+)", plan).groups()]
    n, total, width, word = side**3, points[0] * points[1] * points[2], 4, 8
    cells, axes = total / n, 2 if slit else 3
    # A mode of a slit stores seven numbers per line on its way down the channel and reads them on its way back.
    modes = dict(bytes=(2 * 6 + 2 * 7) * word * cells / 2, operations=160) if slit else dict(bytes=2 * 3 * word * cells, operations=130)
    kernels = [
        Kernel("positions and forces of the group", bytes=48 + 60 + 4 * 48),
        Kernel("spreading, with the thermal drift", bytes=2 * 3 * word * cells, double=3 * width * 120 + 9 * width**3, atomics=3 * width**3),
        Kernel("six transforms" + (" of planes" if slit else ""), **transforms(cells, math.prod(points[:axes]), word, 6, axes)),
        Kernel("modes and their noise", bytes=modes["bytes"], double=cells / 2 * (modes["operations"] + DRAW["double"]), single=cells / 2 * DRAW["single"]),
        Kernel("interpolation, twice", bytes=2 * (3 * word * cells + 48), double=2 * 3 * (120 + 3 * width**3)),
    ]
    return f"fix bd/fib, midpoint, {'slit' if slit else 'periodic'}: {n} particles, {points[0]} x {points[1]} x {points[2]} cells, double precision", n, kernels


def show(title, kernels, rate):
    print(f"\n{title}\n")
    print("| kernel, per particle and step | bytes | operations, single | double | atomic additions | " + " | ".join(f"{d} [ns]" for d in DEVICES) + " |")
    print("|" + "---|" * (5 + len(DEVICES)))
    for k in kernels:
        times = " | ".join(f"{1e9 * k.seconds(d, rate):.2f}" for d in DEVICES)
        print(f"| {k.name} | {k.bytes:.0f} | {k.single:.0f} | {k.double:.0f} | {k.atomics:.0f} | {times} |")
    print("| sum | | | | | " + " | ".join(f"{1e9 * t:.1f}" for t in times_of(kernels, rate)) + " |")
    print("| 10^6 particle steps per second | | | | | " + " | ".join(f"{1e-6 / t:.3g}" for t in times_of(kernels, rate)) + " |")


def times_of(kernels, rate):
    """Seconds per particle and step on each device."""
    return [sum(k.seconds(d, rate) for k in kernels) for d in DEVICES]


def compare(args):
    """Throughput measured, and its bounds."""
    print(f"\n10^6 particle steps per second: lmp {args.measure} on {args.ranks} process{'es' if args.ranks > 1 else ''}, and bounds of one device\n")
    print("| | particles | measured | " + " | ".join(DEVICES) + " |\n" + "|---" * (3 + len(DEVICES)) + "|")
    for side in args.side:
        for name, fix, across, (_, n, kernels) in (
                ("bd/pse, M F", PSE.format(kT="0.0"), "p", pse_kernels(args.lmp, side, False)),
                ("bd/pse, M F and noise", PSE.format(kT="1.0"), "p", pse_kernels(args.lmp, side, True)),
                ("bd/fib, periodic", FIB, "p", fib_kernels(args.lmp, side, False)),
                ("bd/fib, slit", FIB + WALLS, "f", fib_kernels(args.lmp, side, True))):
            bounds = " | ".join(f"{1e-6 / t:.3g}" for t in times_of(kernels, args.rate))
            print(f"| {name} | {n} | {measured(args, side, fix, across):.3g} | {bounds} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lmp", nargs="?", default="build/lmp")
    parser.add_argument("--side", type=int, nargs="+", default=[64], help="side^3 particles")
    parser.add_argument("--rate", type=float, default=1.0, help="fraction of the peaks that is reached")
    parser.add_argument("--measure", metavar="OPTIONS", help="options of LAMMPS, such as \"-k on g 1 -sf kk\"")
    parser.add_argument("--ranks", type=int, default=1)
    args = parser.parse_args()
    if args.measure:
        return compare(args)
    for side in args.side:
        for title, _, kernels in (pse_kernels(args.lmp, side, False), pse_kernels(args.lmp, side, True),
                                  fib_kernels(args.lmp, side, False), fib_kernels(args.lmp, side, True)):
            show(title, kernels, args.rate)


if __name__ == "__main__":
    main()
