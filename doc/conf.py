"""Sphinx reads the whole repository: README.md, the pages in doc/, and the README of each example where it stands.

doc/build.sh runs it.  So every page has one place, and a link works in the manual as on a web view of the repository.
"""

import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

def version_of_cmake():
    with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "CMakeLists.txt"), encoding="utf-8") as f:
        return re.search(r"project\(bd_hydro VERSION ([\d.]+)", f.read()).group(1)


project = "BD-HYDRO"
version = release = version_of_cmake()
copyright = "the authors of BD-HYDRO; GPL version 2"
root_doc = "doc/index"
extensions = ["myst_parser", "sphinx_katex"]
html_math_renderer = "katex"    # sphinx_katex.py: no network needed to read equations
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3
source_suffix = {".rst": "restructuredtext", ".md": "markdown"}
include_patterns = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "doc/**", "examples/*.md", "examples/*/README.md", "examples/tutorial/in.*", "bench/README.md",
                    "unittest/reference/README.md"]
exclude_patterns = ["doc/README.md"]
nitpicky = True
numfig = True

html_theme = "sphinx_rtd_theme"
html_static_path = ["_static"]
html_css_files = ["manual.css"]
html_title = "BD-HYDRO"
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {"navigation_depth": 3}
pygments_style = "default"
highlight_language = "none"    # indented blocks are input scripts, shell commands or logs

# The pages of our styles are written as LAMMPS' own and name its pages: those are at docs.lammps.org.
# A list and not a rule, so that a misspelt name of our own pages is an error.
LAMMPS_MANUAL = "https://docs.lammps.org/"
LAMMPS_PAGES = {
    "atom_style", "boundary", "compute", "compute_modify", "compute_pressure", "compute_stress_atom",
    "dimension", "dump_image", "fix", "fix_adapt", "fix_brownian", "fix_deform", "fix_langevin", "fix_modify",
    "fix_momentum", "fix_press_berendsen", "fix_setforce", "fix_shake", "fix_viscosity", "fix_wall",
    "fix_wall_reflect", "minimize", "neigh_modify", "newton", "package", "pair_coeff", "pair_colloid",
    "pair_hybrid", "pair_modify", "read_data", "read_restart", "reset_timestep", "restart", "run",
    "run_style", "special_bonds", "suffix", "temper", "thermo_modify", "timer", "units", "write_data",
}


def link_to_lammps(app, env, node, contnode):
    """A :doc: reference to a page that LAMMPS has and we have not."""
    from docutils import nodes
    name = os.path.basename(node.get("reftarget", ""))
    if node.get("reftype") != "doc" or name not in LAMMPS_PAGES:
        return None
    link = nodes.reference("", "", internal=False, refuri=LAMMPS_MANUAL + name + ".html")
    link += contnode
    return link


def setup(app):
    app.connect("missing-reference", link_to_lammps)
    from pygments.lexers.special import TextLexer
    app.add_lexer("LAMMPS", TextLexer)
