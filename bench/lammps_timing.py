"""Runs small decks through lmp and reads their loop times; shared by the measurements of the charts."""
import os
import re
import subprocess
import tempfile


def lattice_scene(cells, phi, pair="lj/cut 2.0", boundary="p p p"):
    """Soft spheres of radius 1 on a randomly displaced cubic lattice of cells^3, packing fraction phi; in a slit, half a lattice
    spacing at the walls is free."""
    density = phi / (4.0 / 3.0 * 3.14159265358979)
    coeff = "pair_coeff * * 1.0 1.7818" if pair.startswith("lj") else "pair_coeff * *"
    return f"""units lj
atom_style atomic
boundary {boundary}
lattice sc {density:.12g} origin 0.5 0.5 0.5
region box block 0 {cells} 0 {cells} 0 {cells}
create_box 1 box
create_atoms 1 box
mass 1 1.0
pair_style {pair}
{coeff}
displace_atoms all random 0.2 0.2 0.2 7 units box
neighbor 1.0 bin
neigh_modify every 1 delay 0 check yes
timestep 0.002
"""


class Result:
    """What a run printed, its loop times [s] in order, and the processor seconds of the last loop."""

    def __init__(self, log):
        self.log = log
        self.loops = [float(m) for m in re.findall(r"^Loop time of (\S+)", log, re.M)]
        shares = [float(m) / 100 for m in re.findall(r"^(\S+)% CPU use", log, re.M)]
        self.processor_seconds = self.loops[-1] * min(shares[-1], 1.0) if self.loops else None

    def seconds_per_step(self, steps):
        return self.loops[-1] / steps


def run(lmp, deck, ranks=1, options=(), may_fail=False):
    """Runs a deck in an empty folder.  A run that fails ends the program, or gives None if it is allowed to fail."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "in.deck")
        with open(path, "w") as f:
            f.write(deck)
        command = [os.path.abspath(lmp), "-in", path, "-log", "none", *options]
        if ranks > 1:
            command = ["mpirun", "--oversubscribe", "-n", str(ranks), *command]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    if done.returncode:
        if may_fail:
            return None
        raise SystemExit(f"{' '.join(command)}\n{deck}\nfailed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return Result(done.stdout)
