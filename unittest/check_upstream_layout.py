#!/usr/bin/python3
"""What cmake/lay_out_upstream.py makes of a LAMMPS tree: check_upstream_layout.py LAMMPS WORK [KOKKOS]

LAMMPS is a source tree, which stays as it is; WORK is a folder to work in, which is made again.
With the sources of Kokkos, LAMMPS' own CMake must find the /kk styles too.  LAMMPS' own checks
(make -C src check) must find nothing in the result that they do not find in the tree as it was.
"""

import glob
import os
import re
import shutil
import subprocess
import sys

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.dont_write_bytecode = True
sys.path.insert(0, f"{TOP}/cmake")
import lay_out_upstream as layout    # noqa: E402

PARTS = ["src", "cmake", "doc/src", "doc/utils", "examples/PACKAGES/brownian", "tools/coding_standard",
         "unittest/force-styles"]
TABLES = {"Fix": ("Commands_fix", "fix", "fix"), "Compute": ("Commands_compute", "compute", "compute"),
          "Pair": ("Commands_pair", "pair_style", "pair_style")}
ROLES = [r"[^ -~]", r" :[a-z]+`", r" `[^`]+<[a-z][^`]+`[^_]", r":(ref|doc):[^`]", r"(ref|doc)`[^`]",
         r"^ *\.\. [a-z0-9]+:(\s+.*|)$"]
IMAGES = ["*.png", "*.jpg", "*.gif", "*.pdf", "*.svg"]
failures = []


def wrong(message):
    print(f"FAILED: {message}")
    failures.append(message)


def run(*command, **options):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False, **options)
    return done.returncode, done.stdout


def lay_out(tree):
    return run(f"{TOP}/cmake/lay_out_upstream.py", tree)


def expect_refusal(tree, text):
    status, output = lay_out(tree)
    if status == 0 or text not in output:
        wrong(f"{tree} is not refused with {text!r}, but: {output}")


def contents(tree):
    found = {}
    for folder, _, names in os.walk(tree):
        for name in names:
            path = os.path.join(folder, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, tree)] = file.read()
    return found


# ---- the files ------------------------------------------------------------------------------------------------------

def check_text(path, data):
    """Plain text, without executable bit; logs and other data may be as they are."""
    if os.stat(path).st_mode & 0o111:
        wrong(f"{path} is executable")
    if not data.isascii():
        wrong(f"{path} is not ASCII")
    if re.search(rb"[ \t\r]$", data, flags=re.M) or b"\t" in data or not data.endswith(b"\n"):
        wrong(f"{path} has tabs, trailing blanks or no end of its last line")


def check_source(tree, path, text, notice):
    """LAMMPS' notice, and then our file word by word."""
    if not re.match(rf"/\* (-\*- c\+\+ -\*- )?-+\n{re.escape(notice)}", text):
        wrong(f"{path} does not begin with the notice of LAMMPS")
    if path.endswith(".cpp") != ("\n   Contributing authors: the BD-HYDRO authors\n" in text):
        wrong(f"{path}: a .cpp file names the authors, a header does not")
    if "SPDX" in text or text.count("GNU General Public License") != 1:
        wrong(f"{path} has another notice, too")
    ours = os.path.relpath(path, tree).replace("src/KOKKOS/", "kokkos/").replace("src/BD-HYDRO/kokkos/", "kokkos/")
    code = layout.read(f"{TOP}/{ours}")
    if not text.endswith(code[code.index("\n", code.index("*/") if code.startswith("/*") else 0):].lstrip("\n")):
        wrong(f"{path} differs from {ours} below its notice")


def check_files(tree, before, after):
    notice = layout.notice(tree)
    new = sorted(set(after) - set(before))
    sources = [name for name in new if name.endswith((".h", ".cpp"))]
    for name in new:
        check_text(f"{tree}/{name}", after[name])
    for name in sources:
        check_source(tree, f"{tree}/{name}", after[name].decode(), notice)
    ours = {os.path.basename(p) for folder in ("src", "kokkos") for ext in ("h", "cpp")
            for p in glob.glob(f"{TOP}/{folder}/**/*.{ext}", recursive=True)}
    missing = ours - {os.path.basename(name) for name in after}
    if missing:
        wrong(f"these sources are not in the tree: {sorted(missing)}")
    return new


# ---- styles and pages -----------------------------------------------------------------------------------------------

def our_styles():
    """[(kind, style, whether it has a /kk variant)] by the headers of this repository."""
    names = {}
    for path in glob.glob(f"{TOP}/src/BD-HYDRO/*.h") + glob.glob(f"{TOP}/kokkos/*.h"):
        for kind, name in re.findall(r"^(\w+)Style\(([^,]+),", layout.read(path), flags=re.M):
            names.setdefault((kind, re.sub(r"/kk(/\w+)?$", "", name)), set()).add(name)
    return [(kind, style, f"{style}/kk" in found) for (kind, style), found in sorted(names.items()) if style in found]


def sorted_places(text, lines):
    """The lines that do not stand between names that come before and after by the alphabet."""
    all_lines, name = text.split("\n"), re.compile(r":doc:`([^ `]+)")
    for line in lines:
        k = all_lines.index(line)
        previous, own, following = (name.search(all_lines[j]) for j in (k - 1, k, k + 1))
        if not previous or not following or not previous[1] < own[1] < following[1]:
            yield line


def check_styles(tree):
    pages = "".join(layout.read(f"{tree}/doc/src/{page}.rst") for page in layout.PAGES.values())
    for kind, style, accelerated in our_styles():
        table, listing, index = TABLES[kind]
        text, entries = layout.read(f"{tree}/doc/src/{table}.rst"), layout.read(f"{tree}/doc/src/{listing}.rst")
        mark = " (k)" if accelerated else ""
        rows = re.findall(rf"^   \* :doc:`{style}{re.escape(mark)} <\w+>`$", text, flags=re.M)
        items = re.findall(rf"^\* :doc:`{style} <\w+>` - \w.*$", entries, flags=re.M)
        if len(rows) != 1 or len(items) != 1:
            wrong(f"{style} is {len(rows)} times in {table}.rst and {len(items)} times in {listing}.rst")
            continue
        for line in sorted_places(text, rows):
            wrong(f"{table}.rst: not in its place by the alphabet: {line}")
        for variant in [style] + [f"{style}/kk"] * accelerated:
            if f".. index:: {index} {variant}\n" not in pages:
                wrong(f"no page has an entry of the index for {variant}")


def check_links(tree, new):
    """Pages, labels and files that our pages name are there."""
    doc = f"{tree}/doc/src"
    everything = "".join(layout.read(p) for p in glob.glob(f"{doc}/*.rst"))
    labels = set(re.findall(r"^\.\. _([\w-]+):", everything, flags=re.M))
    for page in layout.PAGES.values():
        text = layout.read(f"{doc}/{page}.rst")
        for target in re.findall(r":doc:`[^`<]*<([^`>]+)>`", text):
            if not os.path.exists(f"{doc}/{target}.rst"):
                wrong(f"{page}.rst links to {target}.rst, which is not there")
        for target in re.findall(r":ref:`[^`<]*<([^`>]+)>`", text):
            if target not in labels:
                wrong(f"{page}.rst refers to {target}, which is not there")
    if not {f"doc/src/{page}.rst" for page in layout.PAGES.values()} <= set(new):
        wrong("not all pages are there")


def check_syntax(tree):
    """docutils understands the pages, and no list of theirs as one of definitions, which they have not."""
    try:
        from docutils import core, nodes
        from docutils.parsers.rst import Directive, directives, roles
    except ImportError:
        print("SKIPPED: the syntax of the pages, which needs python3-docutils")
        return

    class Ignored(Directive):
        """Of Sphinx."""
        has_content, optional_arguments, final_argument_whitespace = True, 9, True

        def run(self):
            return [nodes.paragraph("", self.name)]

    for name in ("index", "code-block", "versionadded", "include"):
        directives.register_directive(name, Ignored)
    for name in ("doc", "ref"):
        roles.register_local_role(name, lambda role, raw, text, line, inliner, **_: ([nodes.inline(raw, text)], []))
    for page in layout.PAGES.values():
        tree_of_page = core.publish_doctree(layout.read(f"{tree}/doc/src/{page}.rst"),
                                            settings_overrides={"report_level": 5, "_disable_config": True})
        for fault in tree_of_page.findall(nodes.system_message):
            if fault["level"] > 1:
                wrong(f"{page}.rst: {fault.astext()}")
        if any(tree_of_page.findall(nodes.definition_list)):
            wrong(f"{page}.rst has a list whose lines are indented too far")


# ---- LAMMPS' own tools ----------------------------------------------------------------------------------------------

def findings(tree):
    """What LAMMPS' checks print, line by line; sums aside.  None of those that its version has not."""
    found, doc = set(), f"{tree}/doc"
    commands = [[p, tree] for p in sorted(glob.glob(f"{tree}/tools/coding_standard/*.py"))
                if not p.endswith("versiontags.py")]
    commands += [[f"{doc}/utils/{name}.py", "-s", f"{tree}/src", "-d", f"{doc}/src"]
                 for name in ("check-styles", "check-packages")]
    anchors = ["-c", "from lammpsdoc.rst_anchor_check import main; main()"] + sorted(glob.glob(f"{doc}/src/*.rst"))
    for command in commands + [anchors]:
        environment = {**os.environ, "PYTHONPATH": f"{doc}/utils/converters"}
        status, output = run(sys.executable, "-B", *command, env=environment)
        if "Traceback" in output:
            wrong(f"{command[0]} does not run: {output}")
        sums = r"styles: |^Total|^Found \d+ (anchor|packages)"
        found |= {line for line in output.split("\n") if not re.search(sums, line)}
        found |= {f"{command[0]} ends with {status}"} if status else set()
    return found


def check_roles(tree):
    """The role_check and char_check of doc/Makefile."""
    for page in layout.PAGES.values():
        for line in layout.read(f"{tree}/doc/src/{page}.rst").split("\n"):
            for pattern in ROLES:
                if re.search(pattern, line):
                    wrong(f"{page}.rst: doc/Makefile looks for {pattern}: {line}")


def check_cmake(tree, work, kokkos):
    """LAMMPS' CMake includes each style once, and compiles each source once."""
    options = ["-D", "PKG_BD-HYDRO=on", "-D", "BUILD_MPI=on"]
    if kokkos:
        os.makedirs(f"{tree}/lib", exist_ok=True)
        os.symlink(kokkos, f"{tree}/lib/kokkos")
        options += ["-D", "PKG_KOKKOS=on"]
    status, output = run("cmake", "-S", f"{tree}/cmake", "-B", f"{work}/build", "-G", "Ninja", *options)
    if status:
        wrong(f"LAMMPS does not configure: {output}")
        return
    styles = "".join(layout.read(f"{work}/build/styles/style_{kind}.h") for kind in ("fix", "compute", "pair"))
    included = re.findall(r'"((?:fix_bd_\w+|compute_temp_brownian|pair_asakura\w+)\.h)"', styles)
    with_variants = ("fix_bd_fib", "fix_bd_pse", "pair_asakura_oosawa")
    wanted = ["compute_temp_brownian.h"] + [f"{name}{ext}.h" for name in with_variants
                                            for ext in ([""] + ["_kokkos"] * bool(kokkos))]
    if sorted(included) != sorted(wanted):
        wrong(f"the style headers include {sorted(included)}, not {sorted(wanted)}")
    rules = layout.read(f"{work}/build/build.ninja")
    compiled = re.findall(r"^build \S+\.o: CXX_COMPILER\S* (\S+)", rules, flags=re.M)
    for path in glob.glob(f"{tree}/src/BD-HYDRO/**/*.cpp", recursive=True) + glob.glob(f"{tree}/src/KOKKOS/*.cpp"):
        ours = "/BD-HYDRO/" in path or re.search(r"fix_bd_|asakura", path)
        if ours and (kokkos or "okkos" not in path.lower()) and compiled.count(path) != 1:
            wrong(f"{path} is compiled {compiled.count(path)} times")


# ---- all of it ------------------------------------------------------------------------------------------------------

def copy_of(lammps, tree):
    for part in PARTS:
        if os.path.exists(f"{lammps}/{part}"):
            shutil.copytree(f"{lammps}/{part}", f"{tree}/{part}", ignore=shutil.ignore_patterns(*IMAGES))
    os.makedirs(f"{tree}/potentials")
    for name in ("README", "LICENSE"):
        shutil.copy(f"{lammps}/{name}", tree)


def check_refusals(work, tree):
    expect_refusal(f"{work}/nowhere", "give a complete source tree of LAMMPS")
    expect_refusal(f"{tree}/src", "give a complete source tree of LAMMPS")
    version = f"{tree}/src/version.h"
    os.rename(version, f"{version}.away")
    expect_refusal(tree, "is not a LAMMPS source tree: it has no src/version.h")
    os.rename(f"{version}.away", version)


def main():
    lammps, work, kokkos = (sys.argv[1:] + [""])[:3]
    shutil.rmtree(work, ignore_errors=True)
    tree = f"{os.path.abspath(work)}/lammps"
    os.makedirs(tree)
    copy_of(lammps, tree)
    before, found = contents(tree), findings(tree)
    check_refusals(work, tree)
    if contents(tree) != before:
        wrong("a refusal changes the tree")
    status, output = lay_out(tree)
    if status:
        sys.exit(f"FAILED: {output}")
    after = contents(tree)
    new = check_files(tree, before, after)
    check_styles(tree)
    check_links(tree, new)
    check_syntax(tree)
    check_roles(tree)
    for line in sorted(findings(tree) - found):
        wrong(f"LAMMPS' own check: {line}")
    lay_out(tree)
    if contents(tree) != after:
        wrong("a second run differs from the first")
    check_cmake(tree, work, kokkos)
    if failures:
        sys.exit(f"{len(failures)} checks failed")
    shutil.rmtree(work)
    print(f"all checks passed; {len(new)} new files")


main()
