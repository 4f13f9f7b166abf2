#!/usr/bin/env python3
# Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
"""Lays this package into a LAMMPS source tree as LAMMPS' developers want to receive it.

    cmake/lay_out_upstream.py /path/to/lammps

Does what cmake/copy_to_lammps.sh does, and in addition
    src/BD-HYDRO                   gets LAMMPS' notice at the top of each file
    doc/src                        gets our pages, their entries in the tables of styles, the howtos and the packages
    examples/PACKAGES/bd-hydro     gets a few input scripts with their logs
    unittest/force-styles/tests    gets reference values for LAMMPS' own test drivers

Then run LAMMPS' own checks: make -C src check.  May be run again; entries are not added twice.
"""

import glob
import os
import re
import shutil
import subprocess
import sys

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

# Our pages, and what they are called there.
PAGES = {"fix_bd_fib": "fix_bd_fib", "fix_bd_pse": "fix_bd_pse", "compute_temp_brownian": "compute_temp_brownian",
         "pair_asakura_oosawa": "pair_asakura_oosawa", "howto_fib_or_pse": "Howto_bd_hydro",
         "howto_changes": "Howto_bd_hydro_changes", "howto_companions": "Howto_bd_hydro_companions",
         "kokkos": "Howto_bd_hydro_kokkos"}

# Style, page, and its line in the list of the command.
FIB = "Brownian dynamics by the fluctuating immersed boundary method"
PSE = "Brownian dynamics with positively split Ewald sums"
STYLES = {
    "fix": [("bd/fib", "fix_bd_fib", FIB), ("brownian/fib", "fix_bd_fib", FIB), ("temp/bd/fib", "fix_bd_fib", FIB),
            ("bd/pse", "fix_bd_pse", PSE), ("brownian/pse", "fix_bd_pse", PSE), ("temp/bd/pse", "fix_bd_pse", PSE)],
    "compute": [("temp/brownian", "compute_temp_brownian", "temperature imposed by fix bd/fib or bd/pse")],
    "pair": [("asakura/oosawa", "pair_asakura_oosawa", "depletion attraction between colloids")],
}
LISTS = {"fix": "fix.rst", "compute": "compute.rst", "pair": "pair_style.rst"}

PACKAGE = """.. _PKG-BD-HYDRO:

BD-HYDRO package
----------------

**Contents:**

Brownian dynamics with hydrodynamic interactions, at a cost that grows as N log N: :doc:`fix bd/fib <fix_bd_fib>`
(fluctuating immersed boundary method, also with walls), :doc:`fix bd/pse <fix_bd_pse>` (positively split Ewald sums, to a
given tolerance), :doc:`compute temp/brownian <compute_temp_brownian>`, and :doc:`pair_style asakura/oosawa
<pair_asakura_oosawa>`.

**Authors:** the BD-HYDRO authors.

**Install:**

This package can only be built with CMake.  It requires FFTW 3, Eigen 3 and Random123.

Example inputs are in the ``examples/PACKAGES/bd-hydro`` folder.

----------

"""

ROW = """   * - :ref:`BD-HYDRO <PKG-BD-HYDRO>`
     - Brownian dynamics with hydrodynamic interactions
     - :doc:`Howto bd-hydro <Howto_bd_hydro>`
     - ``PACKAGES/bd-hydro``
     - no
"""

AUTHORS = """
/* ----------------------------------------------------------------------
   Contributing authors: the BD-HYDRO authors
------------------------------------------------------------------------- */
"""

EXAMPLES = ["cluster/in.cluster", "cluster/data.cluster", "tutorial/in.1_sphere", "tutorial/in.2_diffusion",
            "tutorial/in.3_pair", "tutorial/in.4_wall", "tutorial/in.5_suspension", "tutorial/in.6_gel"]


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(path, text):
    """Also where the file is a hard link, whose other names keep the old text."""
    if os.path.exists(path):
        os.remove(path)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


# ---- sources --------------------------------------------------------------------------------------------------------

def notice(tree):
    """LAMMPS' own, from one of its files, without the first line."""
    text = read(f"{tree}/src/fix.cpp")
    begin = text.index("   LAMMPS - Large-scale")
    return text[begin:text.index("*/", begin) + 3]


def with_notice(text, lammps_notice, header):
    """Our notice, in either of its two forms, replaced by that of LAMMPS."""
    text = re.sub(r"\A/\*.*?\*/\n", "", text, flags=re.S)
    text = re.sub(r"\A// Copyright \(c\) the BD-HYDRO authors\.[^\n]*\n", "", text)
    first = "/* -*- c++ -*- ----------------------------------------------------------\n" if header else \
        "/* ----------------------------------------------------------------------\n"
    return first + lammps_notice + ("" if header else AUTHORS) + "\n" + text.lstrip("\n")


def sources(tree):
    lammps_notice = notice(tree)
    for folder, _, files in os.walk(f"{tree}/src/BD-HYDRO"):
        for name in files:
            path = os.path.join(folder, name)
            if name.endswith((".h", ".cpp")):
                write(path, with_notice(read(path), lammps_notice, name.endswith(".h")))


# ---- manual ---------------------------------------------------------------------------------------------------------

def page(text, accelerated):
    """Links to pages that only this package's own manual has become plain text."""
    for ours, theirs in PAGES.items():
        text = re.sub(rf"(:doc:`[^`<]*<){ours}>`", rf"\g<1>{theirs}>`", text)
    text = re.sub(r":doc:`([^`<]*?)\s*</[^`>]*>`", r"\1", text)
    if re.search(r"^\.\. index:: .*/kk$", text, flags=re.M) and accelerated not in text:
        text = text.replace("\nRestrictions\n\"\"\"", f"\n{accelerated}\n\n----------\n\nRestrictions\n\"\"\"", 1)
    return text


def insert_sorted(text, pattern, line):
    """Puts the line before the first that matches the pattern and comes after it by name; once."""
    if line in text:
        return text
    name = re.search(pattern, line)[1]
    lines, last = text.split("\n"), None
    for k, other in enumerate(lines):
        found = re.search(pattern, other)
        if found and found[1].lower() > name.lower():
            return "\n".join(lines[:k] + [line] + lines[k:])
        if found:
            last = k
    return "\n".join(lines[:last + 1] + [line] + lines[last + 1:])


def manual(tree):
    doc = f"{tree}/doc/src"
    for ours, theirs in PAGES.items():
        write(f"{doc}/{theirs}.rst", page(read(f"{TOP}/doc/src/{ours}.rst"), ".. include:: accel_styles.rst"))
    for command, styles in STYLES.items():
        table, listing = f"{doc}/Commands_{command}.rst", f"{doc}/{LISTS[command]}"
        for style, where, what in styles:
            write(table, insert_sorted(read(table), rf"^   \* :doc:`(\S+).* <{command}", f"   * :doc:`{style} <{where}>`"))
            write(listing, insert_sorted(read(listing), rf"^\* :doc:`(\S+) <{command}.*> ?` - ",
                                         f"* :doc:`{style} <{where}>` - {what}"))
    for name in sorted(theirs for theirs in PAGES.values() if theirs.startswith("Howto")):
        howto = f"{doc}/Howto.rst"
        text = read(howto)
        if f"   {name}\n" not in text:
            write(howto, text.replace("   Howto_manifold\n", f"   Howto_manifold\n   {name}\n", 1))
    packages(doc)
    words(f"{tree}/doc/utils/sphinx-config/false_positives.txt")


def packages(doc):
    details = f"{doc}/Packages_details.rst"
    text = insert_sorted(read(details), r"^   \* :ref:`(\S+) <PKG", "   * :ref:`BD-HYDRO <PKG-BD-HYDRO>`")
    if ".. _PKG-BD-HYDRO:" not in text:
        text = text.replace(".. _PKG-BOCS:", PACKAGE + ".. _PKG-BOCS:", 1)
    write(details, text)
    table, next_row = f"{doc}/Packages.rst", "   * - :ref:`BOCS <PKG-BOCS>`\n"
    if "PKG-BD-HYDRO" not in read(table):
        write(table, read(table).replace(next_row, ROW + next_row, 1))


def words(path):
    """Words of our pages that LAMMPS' spell checker does not know."""
    if not os.path.exists(path):
        return
    ours = [line.strip() for line in read(f"{TOP}/doc/words.txt").split("\n") if line.strip() and line[0] != "#"]
    known = read(path).split("\n")
    write(path, "\n".join(sorted(set(known[:-1]) | set(ours), key=str.lower)) + "\n")


# ---- examples and tests ---------------------------------------------------------------------------------------------

def examples(tree):
    there = f"{tree}/examples/PACKAGES/bd-hydro"
    os.makedirs(there, exist_ok=True)
    logs = [os.path.relpath(p, f"{TOP}/examples") for p in glob.glob(f"{TOP}/examples/cluster/log.*")]
    for name in EXAMPLES + sorted(logs):
        text = read(f"{TOP}/examples/{name}").replace("../../potentials/", "../../../potentials/")
        write(f"{there}/{os.path.basename(name)}", re.sub(r"[ \t]+$", "", text, flags=re.M).rstrip("\n") + "\n")
    write(f"{there}/README", "Input scripts for the BD-HYDRO package.\n\n"
                             "in.cluster       collapse of a colloidal cluster, with and without hydrodynamic interactions\n"
                             "in.1_sphere ...  six small scripts, from one sphere to a gel\n")


def tests(tree):
    for path in glob.glob(f"{TOP}/unittest/lammps_drivers/*.yaml") + [f"{TOP}/unittest/lammps_drivers/in.spheres"]:
        shutil.copyfile(path, f"{tree}/unittest/force-styles/tests/{os.path.basename(path)}")


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit("\n".join(__doc__.split("\n")[2:3]).strip())
    tree = os.path.abspath(sys.argv[1])
    for needed in ("doc/src/Packages.rst", "doc/src/Commands_fix.rst", "examples/PACKAGES", "unittest/force-styles/tests"):
        if not os.path.exists(f"{tree}/{needed}"):
            sys.exit(f"error: {tree} has no {needed}: give a complete source tree of a LAMMPS of 2026 or later.")
    done = subprocess.run([f"{TOP}/cmake/copy_to_lammps.sh", tree], check=False)
    if done.returncode:
        sys.exit(done.returncode)
    sources(tree)
    manual(tree)
    examples(tree)
    tests(tree)
    print(f"{tree}: pages, tables, examples and tests are in place.  Now run: make -C {tree}/src check")


if __name__ == "__main__":
    main()
