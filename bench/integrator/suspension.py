#!/usr/bin/python3
"""Cost and error of the schemes of fix bd/pse for 1000 soft spheres: CSV.

    suspension.py         uses build/lmp; g(r) and energy against Monte Carlo (unittest/reference/rdf_wca_N1000.csv)

Error of g: root mean square over r = 1.84 ... 2.4; energy: per particle in kT, 0.08185 +- 0.0002 by Monte Carlo.
"""
import os
import re
import subprocess
import tempfile

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.join(HERE, "..", "..")
SCHEMES = [(20, "scheme euler"), (40, "scheme euler"), (80, "scheme euler"), (80, "scheme split substeps 2"),
           (160, "scheme split substeps 4"), (160, "scheme split substeps 2")]


def main():
    table = []
    with open(os.path.join(ROOT, "unittest", "reference", "rdf_wca_N1000.csv")) as f:
        for line in f:
            words = line.split(",")
            try:
                table.append([float(w) for w in words[:3]])
            except ValueError:
                continue
    exact = np.array(table)
    rows = ["dt,keywords,cpu_s_per_1000_time,g_error,energy"]
    for dt, keywords in SCHEMES:
        out = tempfile.mktemp()
        text = subprocess.run([os.path.join(ROOT, "build", "lmp"), "-in", "in.suspension", "-log", "none", "-var", "dt", str(dt), "-var",
                               "keywords", keywords, "-var", "out", out], cwd=HERE, capture_output=True, text=True,
                              env=dict(os.environ, OMP_NUM_THREADS="1"))
        energy = re.search(r"^ENERGY (\S+)", text.stdout, re.M)
        if not energy:
            rows.append(f"{dt},{keywords},failed,,")
            print(rows[-1], text.stdout[-300:], flush=True)
            continue
        loop = re.findall(r"Loop time of (\S+) .* for (\d+) steps", text.stdout)[-1]
        share = re.findall(r"([\d.]+)% CPU use", text.stdout)[-1]
        cpu = float(loop[0]) * min(1.0, float(share) / 100.0) / (int(loop[1]) * dt) * 1000.0
        g = np.array([[float(w) for w in line.split()] for line in open(out) if len(line.split()) == 4])
        at = [int(np.argmin(abs(exact[:, 0] - r))) for r in g[:, 1]]
        near = (g[:, 1] > 1.84) & (g[:, 1] < 2.4) & (abs(exact[at, 0] - g[:, 1]) < 0.005)
        error = np.sqrt(np.mean((g[near, 2] - exact[at, 1][near]) ** 2))
        rows.append(f"{dt},{keywords},{cpu:.4g},{error:.4g},{float(energy.group(1)):.5f}")
        print(rows[-1], flush=True)
        os.remove(out)
    with open(os.path.join(HERE, "suspension.csv"), "w") as f:
        f.write("# made by bench/integrator/suspension.py\n" + "\n".join(rows) + "\n")


if __name__ == "__main__":
    main()
