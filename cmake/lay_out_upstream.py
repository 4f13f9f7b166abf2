#!/usr/bin/env python3
# Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
"""Lays this package into a LAMMPS source tree as LAMMPS' developers want to receive it.

    cmake/lay_out_upstream.py /path/to/lammps

Does what cmake/copy_to_lammps.sh does, and in addition
    src/BD-HYDRO                   gets LAMMPS' notice at the top of each file, and a README
    src/KOKKOS                     gets the /kk styles, where LAMMPS' CMake finds them alongside the plain ones
    cmake                          gets one module without other files, and the package in the presets
    doc/src                        gets our pages, and their entries in the tables of styles, howtos and packages
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
PACKAGE = "BD-HYDRO"

# Our pages, and what they are called there.
PAGES = {"fix_bd_fib": "fix_bd_fib", "fix_bd_pse": "fix_bd_pse", "compute_temp_brownian": "compute_temp_brownian",
         "pair_asakura_oosawa": "pair_asakura_oosawa", "howto_fib_or_pse": "Howto_bd_hydro",
         "howto_changes": "Howto_bd_hydro_changes", "howto_companions": "Howto_bd_hydro_companions", "howto_rheology": "Howto_bd_hydro_rheology",
         "howto_ranks": "Howto_bd_hydro_ranks", "kokkos": "Howto_bd_hydro_kokkos"}

# Passages that are worded differently there, wherever their lines break.
# (Text between the comments "ours begins" and "ours ends" is left out.)
REWORDED = {
    "fix_bd_pse": [("For the scenes of ``bench/README.md`` measured times are",
                    "Measured times were")],
    "fix_bd_fib": [("*examples/cluster*", "*examples/PACKAGES/bd-hydro*")],
    "pair_asakura_oosawa": [
        ("   # The file is in the folder potentials of the package: give its path, or set LAMMPS_POTENTIALS"
         " # to that folder\n", ""),
        ("The package's own files are in the package's *potentials* folder.",
         "One such file is\nDelong2014.asakura_oosawa."),
    ],
}

# The page and the line in the list of each style; the headers say which of them have /kk variants.
FIB = ("fix_bd_fib", "Brownian dynamics by the fluctuating immersed boundary method")
PSE = ("fix_bd_pse", "Brownian dynamics with positively split Ewald sums")
STYLES = {
    "fix": {"bd/fib": FIB, "brownian/fib": FIB, "temp/bd/fib": FIB,
            "bd/pse": PSE, "brownian/pse": PSE, "temp/bd/pse": PSE},
    "compute": {"temp/brownian": ("compute_temp_brownian", "temperature imposed by fix bd/fib or bd/pse")},
    "pair": {"asakura/oosawa": ("pair_asakura_oosawa", "depletion attraction between colloids")},
}
LISTS = {"fix": "fix.rst", "compute": "compute.rst", "pair": "pair_style.rst"}

DETAILS = """.. _PKG-BD-HYDRO:

BD-HYDRO package
----------------

**Contents:**

Brownian dynamics with hydrodynamic interactions, at a cost that grows
as *N* log *N*: :doc:`fix bd/fib <fix_bd_fib>` (fluctuating immersed
boundary method, also with walls), :doc:`fix bd/pse <fix_bd_pse>`
(positively split Ewald sums, to a given tolerance),
:doc:`compute temp/brownian <compute_temp_brownian>`, and
:doc:`pair_style asakura/oosawa <pair_asakura_oosawa>`.

**Authors:** the BD-HYDRO authors.

.. versionadded:: TBD

**Install:**

This package has :ref:`specific installation instructions <bd-hydro>` on
the :doc:`Build extras <Build_extras>` page.

**Supporting info:**

* ``src/BD-HYDRO``: filenames -> commands
* ``src/BD-HYDRO/README``
* :doc:`Howto BD-HYDRO <Howto_bd_hydro>`
* ``examples/PACKAGES/bd-hydro``

----------

"""

ROW = """   * - :ref:`BD-HYDRO <PKG-BD-HYDRO>`
     - Brownian dynamics with hydrodynamic interactions
     - :doc:`Howto BD-HYDRO <Howto_bd_hydro>`
     - ``PACKAGES/bd-hydro``
     - sys
"""

BUILD = """.. _bd-hydro:

BD-HYDRO package
----------------

This package requires the libraries `FFTW 3 <https://www.fftw.org/>`_ in
double and single precision, `Eigen 3 <https://eigen.tuxfamily.org/>`_
and `Random123 <https://github.com/DEShawResearch/random123>`_, which
most Linux distributions provide, and a compiler for C++17.

.. tabs::

   .. tab:: CMake build

      .. code-block:: bash

         -D PKG_BD-HYDRO=yes
         -D RANDOM123_INCLUDE_DIR=path   # folder that contains Random123/philox.h
                                         # (only needed if at custom location)

      FFTW is found with pkg-config, Eigen by its own CMake package.

   .. tab:: Traditional make

      The BD-HYDRO package cannot be built with traditional make: build
      LAMMPS with CMake.

----------

"""

README = """This package provides Brownian dynamics with hydrodynamic interactions:

fix bd/fib                 fluctuating immersed boundary method
fix bd/pse                 positively split Ewald sums
compute temp/brownian      the temperature that these fixes impose
pair_style asakura/oosawa  depletion attraction of colloids

The files of this folder belong to LAMMPS.  The folder core holds the
numerical method, which includes no LAMMPS header, and kokkos its
kernels for a device; the /kk styles themselves are in src/KOKKOS.

See the page Howto_bd_hydro of the manual.  The package needs FFTW 3,
Eigen 3 and Random123, and is built with CMake only.

Contributing authors: the BD-HYDRO authors
"""

AUTHORS = """
/* ----------------------------------------------------------------------
   Contributing authors: the BD-HYDRO authors
------------------------------------------------------------------------- */
"""

MODULE_HEAD = """# The core is a library of its own, which sees no LAMMPS header; the styles are compiled
# into LAMMPS' library.
"""

EXAMPLES = ["cluster/in.cluster", "cluster/data.cluster", "cluster/log.*", "tutorial/in.*", "tutorial/log.*"]

EXAMPLES_README = """Input scripts for the BD-HYDRO package.

in.cluster       collapse of a cluster of 13 colloids, with and without
                 hydrodynamic interactions; the logs are of
                 lmp -in in.cluster -var trajectories 1 -var duration 10
                 with -var mobility pse -var dt 0.01
                 and -var mobility none -var dt 0.005
in.1_sphere      a sphere is pulled through the fluid
in.2_diffusion   free diffusion in a periodic box
in.3_pair        two spheres
in.4_wall        between two plates
in.5_suspension  short-time diffusion in a suspension
in.6_gel         a gel
"""


def fail(message):
    sys.exit(f"error: {message}")


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


def edit(path, change, *arguments):
    before = read(path)
    after = change(before, *arguments)
    if after != before:
        write(path, after)


def replace_once(text, old, new, where):
    if text.count(old) != 1:
        fail(f"{where} has {text.count(old)} times and not once: {old!r}.  This script does not know it.")
    return text.replace(old, new)


def insert_before(text, old, new, where):
    return text if new in text else replace_once(text, old, new + old, where)


def insert_by_name(text, pattern, line):
    """Puts the line where it belongs by name, in the longest block of lines that match the pattern.

    The lists are not quite sorted: the line goes to the position with the fewest lines on the wrong side.
    """
    lines = text.split("\n")
    if line in lines:
        return text

    def name_of(other):
        return re.search(pattern, other)

    blocks, block = [], []
    for k, other in enumerate(lines + [""]):
        if name_of(other):
            block.append(k)
        elif block:
            blocks, block = blocks + [block], []
    if not blocks:
        fail(f"no list has entries like {line.strip()!r}.  This script does not know this version of LAMMPS.")
    block = max(blocks, key=len)
    after = [name_of(lines[k])[1].lower() > name_of(line)[1].lower() for k in block]
    wrong = [sum(after[:k]) + (len(block) - k - sum(after[k:])) for k in range(len(block) + 1)]
    place = block[0] + wrong.index(min(wrong))
    return "\n".join(lines[:place] + [line] + lines[place:])


# ---- sources --------------------------------------------------------------------------------------------------------

def notice(tree):
    """LAMMPS' own, from one of its files, without the first line."""
    text = read(f"{tree}/src/fix.cpp")
    begin = text.index("   LAMMPS - Large-scale")
    return text[begin:text.index("*/", begin) + 3]


def with_notice(text, lammps_notice, header):
    """Our notice, in either of its two forms, replaced by that of LAMMPS."""
    text, long_form = re.subn(r"\A/\*(?:(?!\*/).)*copyright \(c\) the BD-HYDRO.*?\*/\n", "", text, flags=re.S)
    text, short_form = re.subn(r"\A// Copyright \(c\) the BD-HYDRO authors\.[^\n]*\n", "", text)
    if long_form + short_form != 1:
        fail(f"a source file has no notice of ours at its top: {text[:80]!r}")
    first = "/* -*- c++ -*- ----------------------------------------------------------\n" if header else \
        "/* ----------------------------------------------------------------------\n"
    return first + lammps_notice + ("" if header else AUTHORS) + "\n" + text.lstrip("\n")


def sources(tree):
    lammps_notice = notice(tree)
    for folder, _, files in os.walk(f"{tree}/src/{PACKAGE}"):
        for name in files:
            path = os.path.join(folder, name)
            if name.endswith((".h", ".cpp")):
                write(path, with_notice(read(path), lammps_notice, name.endswith(".h")))
    kokkos_styles(tree)
    write(f"{tree}/src/{PACKAGE}/README", README)


def kokkos_styles(tree):
    """/kk variants of our own styles go where LAMMPS has all of them; it finds them by the name of the plain style."""
    for path in glob.glob(f"{tree}/src/{PACKAGE}/*.h"):
        for variant in glob.glob(f"{tree}/src/{PACKAGE}/kokkos/{os.path.basename(path)[:-2]}_kokkos.*"):
            if "Style(" in read(path):
                os.replace(variant, f"{tree}/src/KOKKOS/{os.path.basename(variant)}")


def styles_of(tree):
    """{command: {style: whether it has a /kk variant}} by the headers."""
    found = {command: {} for command in STYLES}
    for path in glob.glob(f"{tree}/src/{PACKAGE}/*.h") + glob.glob(f"{tree}/src/KOKKOS/*.h"):
        for kind, name in re.findall(r"^(Fix|Compute|Pair)Style\(([^,]+),", read(path), flags=re.M):
            plain = re.sub(r"/kk(/host|/device)?$", "", name)
            if plain == name and f"/{PACKAGE}/" in path:
                found[kind.lower()].setdefault(name, False)
            elif plain != name and plain in STYLES[kind.lower()]:
                found[kind.lower()][plain] = True
    for command, styles in STYLES.items():
        if set(styles) != set(found[command]):
            fail(f"the headers have the {command} styles {sorted(found[command])}, this script {sorted(styles)}.")
    return found


# ---- CMake ----------------------------------------------------------------------------------------------------------

def without_head(text):
    """Without the comment at the top, which is about the other places of the file."""
    return re.sub(r"\A(#[^\n]*\n)+", "", text)


def build_files(tree):
    """One module in place of three files, and the package in its place in the lists."""
    module, parts = f"{tree}/cmake/Modules/Packages/{PACKAGE}.cmake", f"{tree}/src/{PACKAGE}/cmake"
    text = re.sub(r"^include\(\$\{BDH_SOURCE_DIR\}/cmake/(\w+\.cmake)\)\n",
                  lambda m: "\n" + without_head(read(f"{parts}/{m[1]}")), read(module), flags=re.M)
    write(module, MODULE_HEAD + re.sub(r"\n{3,}", "\n\n", without_head(text)))
    shutil.rmtree(parts)
    main = f"{tree}/cmake/CMakeLists.txt"
    edit(main, lambda text: put_in_list(text.replace(f"\n  {PACKAGE}\n", "\n")))
    for preset in ("all_on", "all_off", "nolib"):
        edit(f"{tree}/cmake/presets/{preset}.cmake", put_in_list)


def put_in_list(text):
    return insert_by_name(text, r"^  ([A-Z0-9-]+)\)?$", f"  {PACKAGE}")


# ---- manual ---------------------------------------------------------------------------------------------------------

def page(ours, styles):
    text = read(f"{TOP}/doc/src/{ours}.rst")
    text = re.sub(r"^\.\. ours begins\n.*?^\.\. ours ends\n\n?", "", text, flags=re.S | re.M)
    for here, there in REWORDED.get(ours, []):
        found = re.findall(r"\s+".join(map(re.escape, re.split(r"(?<=\S)\s+(?=\S)", here))), text)
        if len(found) != 1:
            fail(f"doc/src/{ours}.rst says {len(found)} times and not once: {here!r}.  See REWORDED.")
        text = text.replace(found[0], there)
    text = with_their_links(text)
    left = re.search(r"(unittest|bench|cmake)/.*|\bprepare\.sh|:doc:`[^`]*</|\bours\b.*", text)
    if left:
        fail(f"doc/src/{ours}.rst names what only this repository has: {left[0]}.  See REWORDED, or put it between "
             '".. ours begins" and ".. ours ends".')
    return with_lammps_conventions(text, styles) if text.startswith(".. index::") else text


def with_their_links(text):
    """Links to what only our own manual has are left out, with their parentheses, or become plain text."""
    for ours, theirs in PAGES.items():
        text = re.sub(rf"(:doc:`[^`<]*<){ours}>`", rf"\g<1>{theirs}>`", text)
    text = re.sub(r"\s*\([^()]*:doc:`[^`<]*</[^`>]*>`[^()]*\)", "", text)
    text = re.sub(r":doc:`([^`<]*?)\s*</[^`>]*>`", r"\1", text)
    text = re.sub(r"\s*\((?:``(?:unittest|bench)/[^`]*``,?\s*)+\)", "", text)
    return re.sub(r"[;,]\s*``bench/[^`]*``", "", text)


def with_lammps_conventions(text, styles):
    """Entries of the index for all /kk variants, a mark of the version, and LAMMPS' text on variants."""
    for command, names in styles.items():
        for name, accelerated in names.items():
            entry = f".. index:: {command}{'_style' if command == 'pair' else ''} {name}\n"
            if accelerated and f"{entry[:-1]}/kk\n" not in text:
                text = text.replace(entry, f"{entry}{entry[:-1]}/kk\n")
    text = replace_once(text, "\nDescription\n\"\"\"\"\"\"\"\"\"\"\"\n\n", "\nDescription\n\"\"\"\"\"\"\"\"\"\"\"\n\n"
                        ".. versionadded:: TBD\n\n", "a page")
    if re.search(r"^\.\. index:: .*/kk$", text, flags=re.M):
        text = replace_once(text, "\nRestrictions\n\"\"\"",
                            "\n.. include:: accel_styles.rst\n\n----------\n\nRestrictions\n\"\"\"", "a page")
    return text


def manual(tree):
    doc, styles = f"{tree}/doc/src", styles_of(tree)
    for ours, theirs in PAGES.items():
        write(f"{doc}/{theirs}.rst", page(ours, styles))
    for command, entries in STYLES.items():
        for style, (where, what) in entries.items():
            mark = " (k)" if styles[command][style] else ""
            edit(f"{doc}/Commands_{command}.rst", insert_by_name, rf"^   \* :doc:`(\S+).* <{command}",
                 f"   * :doc:`{style}{mark} <{where}>`")
            edit(f"{doc}/{LISTS[command]}", insert_by_name, rf"^\* :doc:`(\S+) <{command}.*> ?` -",
                 f"* :doc:`{style} <{where}>` - {what}")
    howtos = "".join(f"   {theirs}\n" for theirs in PAGES.values() if theirs.startswith("Howto"))
    edit(f"{doc}/Howto.rst", insert_before, "   Howto_spins\n", howtos, "Howto.rst")
    package_lists(doc)
    words(f"{tree}/doc/utils/sphinx-config/false_positives.txt", doc)


def package_lists(doc):
    table = next((t for t in ("Packages_list.rst", "Packages.rst") if os.path.exists(f"{doc}/{t}")))
    edit(f"{doc}/{table}", insert_before, "   * - :ref:`BOCS <PKG-BOCS>`\n", ROW, table)
    edit(f"{doc}/Packages_details.rst", insert_by_name, r"^   \* :ref:`(\S+) <PKG",
         "   * :ref:`BD-HYDRO <PKG-BD-HYDRO>`")
    edit(f"{doc}/Packages_details.rst", insert_before, ".. _PKG-BOCS:\n", DETAILS, "Packages_details.rst")
    for name in ("Build_extras.rst", "Build_package.rst"):
        edit(f"{doc}/{name}", insert_by_name, r"^   \* :ref:`([A-Z0-9-]+) <\S+>`", "   * :ref:`BD-HYDRO <bd-hydro>`")
    edit(f"{doc}/Build_extras.rst", insert_before, ".. _adios:\n", BUILD, "Build_extras.rst")


def words(path, doc):
    """Words of our pages that LAMMPS' spell checker does not know."""
    ours = {line.strip() for line in read(f"{TOP}/doc/words.txt").split("\n") if line.strip() and line[0] != "#"}
    used = set(re.findall(r"[A-Za-z']+", " ".join(read(f"{doc}/{theirs}.rst") for theirs in PAGES.values())))
    known = read(path).split("\n")
    new = sorted((ours & used) - set(known), key=str.lower)
    for word in new:
        place = next((k for k, other in enumerate(known) if other.lower() > word.lower()), len(known) - 1)
        known.insert(place, word)
    if new:
        write(path, "\n".join(known))


# ---- examples and tests ---------------------------------------------------------------------------------------------

def examples(tree):
    there = f"{tree}/examples/PACKAGES/bd-hydro"
    if os.path.exists(there):
        shutil.rmtree(there)
    for pattern in EXAMPLES:
        paths = glob.glob(f"{TOP}/examples/{pattern}")
        if not paths:
            fail(f"there is no examples/{pattern}.")
        for path in paths:
            text = read(path).replace("../../potentials/", "../../../potentials/")
            write(f"{there}/{os.path.basename(path)}", re.sub(r"[ \t]+$", "", text, flags=re.M).rstrip("\n") + "\n")
    write(f"{there}/README", EXAMPLES_README)


def tests(tree):
    """Newer drivers must be told what the old one knew: the force field, that these spheres have no torques, and
    that the fixes refuse run_style respa."""
    drivers = f"{tree}/unittest/force-styles"
    told = os.path.exists(f"{drivers}/tests/coeffs.fourmol")
    for path in glob.glob(f"{TOP}/unittest/lammps_drivers/*.yaml") + [f"{TOP}/unittest/lammps_drivers/in.spheres"]:
        text, name = read(path), os.path.basename(path)
        if told and name.startswith("fix-timestep"):
            text = replace_once(text, "\ndate_generated:", "\ntags: no_respa\ndate_generated:", name)
            text = replace_once(text, "\nnatoms:", "\ninput_coeffs: coeffs.fourmol\nnatoms:", name)
            zeros = "".join(f"{atom:5} 0 0 0\n" for atom in range(1, int(re.search(r"natoms: (\d+)", text)[1]) + 1))
            text = replace_once(text, "\n...\n", f"\nrun_torque: ! |2\n{zeros}...\n", name)
        write(f"{drivers}/tests/{name}", text)


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit("usage: cmake/lay_out_upstream.py /path/to/lammps")
    tree = os.path.abspath(sys.argv[1])
    for needed in ("doc/src/Packages_details.rst", "doc/src/Commands_fix.rst", "doc/utils/sphinx-config", "src/KOKKOS",
                   "examples/PACKAGES", "unittest/force-styles/tests"):
        if not os.path.exists(f"{tree}/{needed}"):
            fail(f"{tree} has no {needed}: give a complete source tree of LAMMPS.")
    done = subprocess.run([f"{TOP}/cmake/copy_to_lammps.sh", tree], check=False, stdout=subprocess.DEVNULL)
    if done.returncode:
        sys.exit(done.returncode)
    sources(tree)
    build_files(tree)
    manual(tree)
    examples(tree)
    tests(tree)
    print(f"{tree}: sources, pages, tables, examples and tests are in place.  Now run: make -C {tree}/src check")


if __name__ == "__main__":
    main()
