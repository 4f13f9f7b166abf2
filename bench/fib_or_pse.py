#!/usr/bin/python3
"""The two tables of doc/src/howto_fib_or_pse.rst: time of a step and accuracy of fix bd/fib and fix bd/pse.

LMP=build/lmp bench/fib_or_pse.py [cost] [accuracy]        both by default: several minutes on one core
"""

import os
import re
import sys
import tempfile

import numpy as np

from lammps_timing import run

TOP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
LMP = os.path.abspath(os.environ.get("LMP", os.path.join(TOP, "build", "lmp")))
METHODS = {"FIB": "bd/fib 1.0 1.0 1 radius 1.0", "PSE 1e-2": "bd/pse 1.0 1.0 1 radius 1.0 tolerance 1e-2",
           "PSE 1e-3": "bd/pse 1.0 1.0 1 radius 1.0", "PSE 1e-5": "bd/pse 1.0 1.0 1 radius 1.0 tolerance 1e-5"}

COST_DECK = """
units lj
lattice sc {density}
region box block 0 12 0 12 0 12
create_box 1 box
create_atoms 1 box
mass 1 1.0
pair_style lj/cut 2.244924
pair_coeff 1 1 1.0 2.0
pair_modify shift yes
neighbor 1.0 bin
neigh_modify every 1 delay 0 check yes
fix move all {fix}
timestep 0.005
run {warm}
run {steps} post yes
"""

ACCURACY_DECK = """
units lj
atom_modify map array sort 0 0.0
read_data {data}
pair_style zero 2.0
pair_coeff * *
neigh_modify every 1 delay 0 check yes
fix f all store/state 0 vx vy vz
variable fx atom f_f[1]
variable fy atom f_f[2]
variable fz atom f_f[3]
fix push all addforce v_fx v_fy v_fz
fix move all {fix}
timestep 1.0e-10
run 1
print "radius $(f_move[4]:%.15g)"
write_dump all custom {dump} vx vy vz modify sort id format float %.15g
"""


def cost():
    """Milliseconds of processor time of a step, the best of three runs; memory of the grid."""
    print("packing fraction | " + " | ".join(METHODS) + " | memory FIB | memory PSE 1e-3")
    for phi in (0.4, 0.1, 0.01, 0.001):
        cells, memory = [], []
        for name, fix in METHODS.items():
            steps = 10 if name == "FIB" and phi < 0.005 else 100
            times = []
            for _ in range(1 if name == "FIB" and phi < 0.005 else 3):
                result = run(LMP, COST_DECK.format(density=phi * 3 / (4 * np.pi), fix=fix, warm=steps // 2, steps=steps))
                times.append(1e3 * result.processor_seconds / steps)
            cells.append(f"{min(times):.2g}")
            if name in ("FIB", "PSE 1e-3"):
                memory.append(re.findall(r"memory +(\S+ \S+) for the grid", result.log)[-1])
        print(f"{phi} | " + " | ".join(cells + memory), flush=True)


def chains(path):
    """6 chains of 16 beads in a box of side 20, bonds of length 1, other beads at least 1 apart; random forces in place
    of velocities."""
    random = np.random.default_rng(16)
    x = np.zeros((0, 3))
    while len(x) < 96:
        before = random.uniform(0, 20, 3) if len(x) % 16 == 0 else x[-1]
        step = random.normal(size=3)
        new = before + step / np.linalg.norm(step) if len(x) % 16 else before
        d = x[:-1] - new if len(x) % 16 else x - new
        d -= 20 * np.round(d / 20)
        if (np.linalg.norm(d, axis=1) >= 1).all():
            x = np.vstack([x, new])
    write_particles(path, np.mod(x, 20), random.normal(size=(96, 3)))


def pair(path, random):
    """Two beads of such a chain, at a random position and in a random direction; the first is pulled along the line of centers."""
    direction = random.normal(size=3)
    direction /= np.linalg.norm(direction)
    x = random.uniform(5, 15, 3)
    write_particles(path, np.array([x, x + direction]), np.array([direction, np.zeros(3)]))
    return direction


def write_particles(path, x, f):
    """A data file with positions, and forces in place of velocities."""
    with open(path, "w") as out:
        out.write(f"\n\n{len(x)} atoms\n1 atom types\n0 20 xlo xhi\n0 20 ylo yhi\n0 20 zlo zhi\n\nMasses\n\n1 1.0\n\nAtoms # atomic\n\n")
        out.writelines(f"{i + 1} 1 {r[0]:.15g} {r[1]:.15g} {r[2]:.15g}\n" for i, r in enumerate(x))
        out.write("\nVelocities\n\n")
        out.writelines(f"{i + 1} {r[0]:.15g} {r[1]:.15g} {r[2]:.15g}\n" for i, r in enumerate(f))


def velocities(data, fix):
    """Velocities of all particles and the radius in use."""
    with tempfile.TemporaryDirectory() as work:
        dump = os.path.join(work, "dump")
        out = run(LMP, ACCURACY_DECK.format(data=data, fix=fix, dump=dump)).log
        return np.loadtxt(dump, skiprows=9), float(re.findall(r"^radius (\S+)", out, re.M)[-1])


def accuracy():
    """Relative difference, in the 2-norm, between FIB and PSE with tolerance 1e-7 and the radius of FIB's grid."""
    suspension = os.path.join(TOP, "examples", "suspension")
    with tempfile.TemporaryDirectory() as work:
        chains(os.path.join(work, "chains"))
        scenes = {"phi = 0.1": (f"{suspension}/data.phi0.1", 1.0), "phi = 0.3": (f"{suspension}/data.phi0.3", 1.0),
                  "chains": (os.path.join(work, "chains"), 0.6)}
        print("scene | roma3 | peskin4 | bkp6 | radii of the grids")
        for name, (data, radius) in scenes.items():
            cells, radii = [], []
            for kernel in ("roma3", "peskin4", "bkp6"):
                fib, a = velocities(data, f"bd/fib 0.0 1.0 1 radius {radius} kernel {kernel}")
                pse, _ = velocities(data, f"bd/pse 0.0 1.0 1 radius {a} tolerance 1e-7")
                cells.append(f"{100 * np.linalg.norm(fib - pse) / np.linalg.norm(pse):.2f} %")
                radii.append(f"{100 * (a / radius - 1):+.1f} %")
            print(f"{name} | " + " | ".join(cells) + " | " + ", ".join(radii), flush=True)
        random, excess = np.random.default_rng(2), []
        for _ in range(20):
            direction = pair(os.path.join(work, "pair"), random)
            fib, a = velocities(os.path.join(work, "pair"), "bd/fib 0.0 1.0 1 radius 0.6")
            pse, _ = velocities(os.path.join(work, "pair"), f"bd/pse 0.0 1.0 1 radius {a} tolerance 1e-7")
            excess.append(fib[1] @ direction / (pse[1] @ direction) - 1)
        print(f"velocity of the other of two bonded beads, peskin4: {100 * np.mean(excess):+.1f} +- {100 * np.std(excess):.1f} %")


if __name__ == "__main__":
    for table in sys.argv[1:] or ["accuracy", "cost"]:
        {"accuracy": accuracy, "cost": cost}[table]()
