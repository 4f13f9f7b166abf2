#!/usr/bin/python3
"""BD-HYDRO compared with other styles of LAMMPS: error of the pair mobility against seconds per diffusive time a^2/D0.

    peers.py plot                       draws doc/charts/peers.csv again
    peers.py path/to/lmp                writes doc/charts/peers.csv and peers.png
    peers.py path/to/lmp diffusion      writes doc/charts/peers_diffusion.csv

Units: radius, viscosity and kT are 1.  Two measurements for each method:
  pull   temperature 0; a sphere in a periodic box of side 16 is pulled, with four more at 3a and 6a along and across the
         force.  Their velocities are compared with Ewald sums of the RPY mobility.  In a second system there is one neighbor
         at 2.1a, near contact, compared with the exact solution for two rigid spheres.
  cost   64 soft spheres (phi = 0.065) in the same box with noise; processor seconds per step times steps per diffusive time.
And a third, of the same suspension:
  diffusion   mean square displacement over windows of a^2/D0, divided by 6 a^2/D0; the short-time limit for RPY is M_ii,
         the same for all configurations."""
import os
import re
import sys

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = os.path.dirname(os.path.abspath(__file__))
CHARTS = os.path.join(HERE, "..", "..", "doc", "charts")
sys.path.insert(0, os.path.join(HERE, ".."))
import chart_tables
import theory
from lammps_timing import run

SIDE, FORCE, N = 16.0, 0.01, 64
PULL = [(8.3, 8.3, 8.3), (11.3, 8.3, 8.3), (2.3, 8.3, 8.3), (8.3, 11.3, 8.3), (8.3, 2.3, 8.3)]
CONTACT = [(8.3, 8.3, 8.3), (10.4, 8.3, 8.3)]
REPULSION = "lj/cut 2.5"                        # minimum at 2.5 a: spheres rarely come closer than 2.1 a
SIGMA = 2.5 / 2**(1 / 6)


class Method:
    """One style with one setting.  `move(noise)` gives the lines after the atoms; `time` is how long the velocity takes to settle after a pull."""
    atoms, time, friction = "atomic", None, 6 * np.pi

    def __init__(self, name, family, dt):
        self.name, self.family, self.dt = name, family, dt


class BdHydro(Method):
    def __init__(self, name, family, dt, line):
        super().__init__(name, family, dt)
        self.line = line

    def move(self, noise, extra=0.0):
        return f"fix move all {self.line.format(T=1.0 if noise else 0.0)}\n"


class Free(Method):
    """fix brownian with gamma_t 1: no hydrodynamic interactions.

    In this version of LAMMPS its noise is correct only for gamma_t = 1, and brownian/sphere requires the package DIPOLE for its
    atoms, which this build lacks.  So time is measured in units of 6 pi eta a^3/kT here, which changes nothing else."""
    friction = 1.0

    def move(self, noise, extra=0.0):
        return f"fix move all brownian 1.0 77 gamma_t 1.0 rng {'gaussian' if noise else 'none'}\n"


class Lubricate(Method):
    """pair lubricate and brownian (fast lubrication dynamics) with fix nve/sphere; density 1."""
    atoms, time = "sphere", 10.0

    def move(self, noise, extra=0.0):
        return "set type 1 diameter 2.0 density 1.0\ncomm_modify vel yes\nfix move all nve/sphere\n"

    def pairs(self, noise):
        styles, coeffs = "lubricate 1.0 1 1 2.01 2.9", "pair_coeff * * lubricate\n"
        if noise:
            styles += " brownian 1.0 1 1 2.01 2.9 1.0 99"
            coeffs += "pair_coeff * * brownian\n"
        return styles, coeffs


class LatticeBoltzmann(Method):
    """fix lb/fluid with point particles: lattice spacing 1, relaxation time tau = 3 eta dt/(rho dx^2) sets the step, and
    the coupling is calibrated so that a single sphere has the mobility of radius 1.  The Schmidt number is 6 pi/rho."""
    time = 8.0

    def __init__(self, kind, tau, rho):
        super().__init__(f"lb/fluid type {kind}, tau {tau:g}, Sc {6 * np.pi / rho:.0f}", "fix lb/fluid", tau * rho / 3)
        self.kind, self.rho, self.gamma = kind, rho, 94.0

    def move(self, noise, extra=0.0):
        heat = "noise 1.0 4711" if noise else f"bodyforce {-extra / (self.rho * SIDE**3):.12g} 0 0"
        return (f"mass 1 2.0\nfix fluid all lb/fluid 1 {self.kind} 1.0 {self.rho} setGamma {self.gamma:.6g} dx 1.0 dm {self.rho} {heat}\n"
                "fix move all lb/pc\n")


class StochasticRotation(Method):
    """fix srd: spheres with stick collisions in a fluid of particles, 5 per bin of side 1, mean free path 0.1 bins; the time
    step is chosen for viscosity 1.  It has no temperature 0."""

    def __init__(self):
        super().__init__("srd, bins of a, 5 per bin", "fix srd", 0.04)

    def scene(self):
        mass = (self.dt / 0.1)**2                       # mean free path dt sqrt(kT/m)
        return f"""units lj
atom_style sphere
atom_modify map yes first big
boundary p p p
region box block 0 {SIDE} 0 {SIDE} 0 {SIDE}
create_box 2 box
lattice sc {N / SIDE**3} origin 0.5 0.5 0.5
create_atoms 1 box
group big type 1
set type 1 diameter 2.0 density {5 * mass}
displace_atoms all random 0.3 0.3 0.3 7
velocity big create 1.0 11
pair_style {REPULSION}
pair_coeff 1 1 1.0 {SIGMA}
pair_coeff 1 2 0.0 1.0 1.02
pair_coeff 2 2 0.0 1.0 0.0
pair_modify shift yes
neighbor 0.3 multi
comm_modify mode multi group big vel yes
neigh_modify every 1 delay 0 check yes
timestep {self.dt}
fix move big nve/sphere
fix heat big langevin 1.0 1.0 1.0 5
run 1000
unfix heat
lattice sc 5.0 origin 0.5 0.5 0.5
create_atoms 2 box
group small type 2
set type 2 diameter 0.0 mass {mass}
delete_atoms overlap 1.01 small big
pair_coeff 1 2 0.0 1.0 0.0
velocity small create 1.0 593 loop geom
neigh_modify every 1 delay 0 check yes include big
fix fluid small srd 1 big 1.0 1.0 49894 shift yes 54979 search 0.5 collision noslip inside ignore
"""

    def calibrate(self, lmp):
        """The viscosity that fix srd prints, times the density of its fluid, is proportional to the time step here."""
        log = run(lmp, self.scene() + "run 0\n").log
        kinematic, count = (float(re.findall(rf"{words} = (\S+)", log)[0]) for words in ("SRD viscosity", "SRD per actual grid cell"))
        self.dt /= kinematic * count * (self.dt / 0.1)**2


def deck(method, points, noise, steps):
    """Input script for atoms at `points`, or for the suspension if it is None."""
    text = f"units lj\natom_style {method.atoms}\natom_modify map yes\nboundary p p p\nregion box block 0 {SIDE} 0 {SIDE} 0 {SIDE}\ncreate_box 1 box\n"
    if points:
        text += "".join(f"create_atoms 1 single {x} {y} {z}\n" for x, y, z in points)
    else:
        text += f"lattice sc {N / SIDE**3} origin 0.5 0.5 0.5\ncreate_atoms 1 box\ndisplace_atoms all random 0.3 0.3 0.3 7\n"
    if method.atoms == "atomic":
        text += "mass 1 1.0\n"
    styles, coeffs = ("zero 3.0", "pair_coeff * * zero\n") if points else (REPULSION, f"pair_coeff * * lj/cut 1.0 {SIGMA}\n")
    if isinstance(method, Lubricate):
        more, more_coeffs = method.pairs(noise)
        styles, coeffs = styles + " " + more, coeffs + more_coeffs
    text += f"pair_style hybrid/overlay {styles}\n{coeffs}pair_modify shift yes\nneighbor 1.0 bin\nneigh_modify every 1 delay 0 check yes\n"
    if isinstance(method, LatticeBoltzmann):
        text = text.replace("neighbor 1.0", "neighbor 0.5")        # atoms must stay within one lattice spacing of their domain
    text += f"timestep {method.dt}\n" + method.move(noise, FORCE if points else 0.0)
    if points:
        text += f"group pulled id 1\nfix pull pulled addforce {FORCE} 0 0\n"
        text += "".join(f"variable u{i + 1} equal vx[{i + 1}]*{method.friction / FORCE}\n" for i in range(len(points)))
        return text + f"run {steps}\nprint 'U {' '.join(f'$(v_u{i + 1}:%.10g)' for i in range(len(points)))}'\n"
    warm = max(10, int(0.1 * method.friction / method.dt))
    return text + (f"run {warm}\nreset_timestep 0\ncompute e all pe\nfix mean all ave/time 1 {steps} {steps} c_e\n"
                   f"thermo_style custom step f_mean\nthermo {steps}\nrun {steps}\nprint 'E $(f_mean:%.10g)'\n")


def velocities(lmp, method, points):
    steps = 1 if method.time is None else int(np.ceil(method.time / method.dt))
    out = run(lmp, deck(method, points, False, max(steps, 2))).log
    return np.array([float(w) for w in re.findall(r"^U (.*)", out, re.M)[-1].split()])


def calibrate(lmp, method):
    """Sets the coupling of a lattice-Boltzmann particle so that the drag of one sphere in the box follows Hasimoto's series."""
    wanted = 1 - theory.HASIMOTO / SIDE + 4 * np.pi / 3 / SIDE**3
    for _ in range(2):
        found = velocities(lmp, method, PULL[:1])[0]
        method.gamma = 1 / (1 / method.gamma + (wanted - found) / (6 * np.pi))
        if not 0 < method.gamma < 1e4:
            raise SystemExit(f"{method.name}: no coupling gives the mobility of radius 1")


def cost(lmp, method, steps):
    """Processor seconds per diffusive time, mean energy per sphere."""
    result = run(lmp, deck(method, None, True, steps))
    energy = float(re.findall(r"^E (.*)", result.log, re.M)[-1]) / N
    return result.processor_seconds / steps * method.friction / method.dt, energy


def diffusion(lmp, method, windows):
    """D/D0 from the mean square displacement of the suspension over windows of a^2/D0, with its standard error from their scatter,
    and processor seconds per window."""
    steps = int(round(method.friction / method.dt))
    if isinstance(method, StochasticRotation):
        method.calibrate(lmp)
        steps, scene = int(round(method.friction / method.dt)), method.scene()
    else:
        scene = deck(method, None, True, 1).split("run ")[0]
    spheres = "big" if isinstance(method, StochasticRotation) else "all"
    result = run(lmp, scene + f"thermo {steps}\nrun {steps}\nvariable window loop {windows}\nlabel next_window\n"
                 f"compute d {spheres} msd\nthermo_style custom step c_d[4]\nrun {steps}\nprint 'MSD $(c_d[4]:%.10g)'\nthermo_style one\nuncompute d\n"
                 "next window\njump SELF next_window\n")
    msd = np.array([float(w) for w in re.findall(r"^MSD (\S+)", result.log, re.M)]) / 6
    return msd.mean(), msd.std(ddof=1) / np.sqrt(windows), result.processor_seconds


def diffusion_table(lmp):
    step = 0.02                                     # result of largest_step()
    methods = [(Free("no interactions", "fix brownian", step / (6 * np.pi)), 100),
               (Lubricate("lubricate + brownian", "pair lubricate/brownian", 0.01), 60)]
    methods += [(BdHydro(f"bd/pse {t:g}", "fix bd/pse", step, f"bd/pse {{T}} 1.0 5 radius 1.0 tolerance {t:g}"), 60) for t in (1e-2, 1e-3)]
    methods += [(BdHydro(f"bd/fib {k}", "fix bd/fib", step, f"bd/fib {{T}} 1.0 5 radius 1.0 kernel {k}"), 40) for k in ("roma3", "peskin4")]
    methods += [(StochasticRotation(), 40), (LatticeBoltzmann(1, 0.45, 0.2), 12)]
    rows = []
    for method, windows in methods:
        if isinstance(method, LatticeBoltzmann):
            calibrate(lmp, method)
        rows.append([method.name, method.family, 0.0, *diffusion(lmp, method, windows)])
        rows[-1][2] = method.dt
        print(f"{method.name:32s} D/D0 {rows[-1][3]:.3f} +- {rows[-1][4]:.3f}   {rows[-1][5]:.3g} s per a^2/D0", flush=True)
    rows.append(["short-time limit of RPY spheres", "reference", "", 1 - theory.HASIMOTO / SIDE + 4 * np.pi / 3 / SIDE**3, "", ""])
    with open(os.path.join(CHARTS, "peers_diffusion.csv"), "w") as f:
        f.write("method,style,time_step,D,standard_error,seconds_per_diffusive_time\n")
        for row in rows:
            f.write(f'"{row[0]}","{row[1]}",' + ",".join(f"{v:.4g}" if v != "" else "" for v in row[2:]) + "\n")


def largest_step(lmp):
    """Largest time step (viscous units) at which the Euler scheme without interactions through the fluid keeps the mean energy
    within 5 % of that at 0.0025; the schemes of bd/pse and bd/fib have the same equilibrium error."""
    energies, exact = {}, None
    for dt in (0.0025, 0.005, 0.01, 0.02, 0.05, 0.1):
        method = Free("", "", dt / (6 * np.pi))
        out = run(lmp, deck(method, None, True, min(int(3000 / dt), 400000)), may_fail=True)
        energies[dt] = float(re.findall(r"^E (.*)", out.log, re.M)[-1]) / N if out else np.inf
        exact = exact or energies[dt]
    print("mean energy per sphere against time step:", {k: round(v, 4) for k, v in energies.items()}, flush=True)
    return max(dt for dt, e in energies.items() if abs(e / exact - 1) < 0.05)


def main():
    lmp = os.path.abspath(sys.argv[1])
    theory.check()
    if sys.argv[2:] == ["diffusion"]:
        return diffusion_table(lmp)
    ewald = theory.PeriodicRpy(SIDE)
    reference = ewald.matrix(np.array(PULL))[::3, 0]
    near = ewald.matrix(np.array(CONTACT))[::3, 0]
    stokes = near[1] + theory.two_spheres_along(2.1)[1] - theory.free_rpy(2.1)[0]
    step = largest_step(lmp)
    methods = [Free("no interactions", "fix brownian", step / (6 * np.pi))]
    methods += [BdHydro(f"bd/pse {t:g}", "fix bd/pse", step, f"bd/pse {{T}} 1.0 5 radius 1.0 tolerance {t:g}") for t in (1e-2, 1e-3, 1e-5)]
    methods += [BdHydro(f"bd/fib {k}", "fix bd/fib", step, f"bd/fib {{T}} 1.0 5 radius 1.0 kernel {k}") for k in ("roma3", "peskin4", "bkp6")]
    methods += [Lubricate("lubricate + brownian", "pair lubricate/brownian", 0.01)]
    methods += [LatticeBoltzmann(*s) for s in ((1, 0.45, 0.2), (2, 0.2, 0.2), (2, 0.1, 0.2))]
    rows = []
    for method in methods:
        if isinstance(method, LatticeBoltzmann):
            calibrate(lmp, method)
        u, c = velocities(lmp, method, PULL), velocities(lmp, method, CONTACT)
        error = np.sqrt(((u[1:] - reference[1:])**2).sum() / (reference[1:]**2).sum())
        steps = 20000 if isinstance(method, (Free, Lubricate)) else 2000 if method.time is None else 400
        seconds, energy = np.median([cost(lmp, method, steps) for _ in range(3)], axis=0)
        rows.append([method.name, method.family, method.dt, seconds, error, *u, c[1], energy])
        print(f"{method.name:32s} dt {method.dt:.4g}  {seconds:.3g} s per a^2/D0  pair error {error:.3g}  U {u.round(4)}  "
              f"2.1a {c[1]:.4f}  energy {energy:.3f}", flush=True)
    print("Ewald RPY", reference.round(5), f" 2.1a: RPY {near[1]:.4f}, rigid spheres {stokes:.4f}")
    os.makedirs(CHARTS, exist_ok=True)
    with open(os.path.join(CHARTS, "peers.csv"), "w") as f:
        f.write("method,style,time_step,seconds_per_diffusive_time,pair_error,u_self,u_3a_along,u_6a_along,u_3a_across,u_6a_across,u_2.1a_along,"
                "energy\n")
        for row in rows:
            f.write(f'"{row[0]}","{row[1]}",' + ",".join(f"{v:.5g}" for v in row[2:]) + "\n")
        f.write('"Ewald sums of RPY","reference",,,0,' + ",".join(f"{v:.5g}" for v in [*reference, near[1]]) + ",\n")
        f.write(f'"rigid spheres","reference",,,,,,,,,{stokes:.5g},\n')
    plot()


def plot():
    rows = [row for row in chart_tables.read(CHARTS, "peers") if row["style"] != "reference"]
    plt.figure(figsize=(6.4, 4.4))
    for (family, some), mark in zip(chart_tables.groups(rows, "style"), "so^Dv"):
        places = [(r["seconds_per_diffusive_time"], r["pair_error"]) for r in some]
        plt.loglog(*zip(*places), mark, label=family)
        for r, place in zip(some, places):
            text = r["method"].split(" ", 1)[-1].replace(", Sc 94", "").replace(", ", "\n") if len(some) > 1 else ""
            side = {"0.01": "right", "0.001": "left"}.get(text, "center")      # two neighbors
            plt.annotate(text, place, fontsize=6, xytext=({"right": -5, "left": 5}.get(side, 0), 0 if side != "center" else 7), ha=side,
                         va="center" if side != "center" else "bottom", textcoords="offset points")
    plt.xlabel("processor seconds per a$^2$/D$_0$, 64 spheres, phi = 0.065")
    plt.ylabel("error of pair mobilities at 3a and 6a")
    plt.grid(alpha=0.3)
    plt.xlim(3e-3, 60)
    plt.legend(fontsize=7, loc="lower left")
    plt.tight_layout()
    plt.savefig(os.path.join(CHARTS, "peers.png"), dpi=130)


if __name__ == "__main__":
    plot() if sys.argv[1:] == ["plot"] else main()
