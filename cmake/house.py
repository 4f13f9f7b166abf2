#!/usr/bin/env python3
"""Measures of the source tree as Markdown tables.  Usage: house.py [ROOT ...]

One column for each root, so that two states of the tree can be compared.  A tree without the folder
src/BD-HYDRO/core has no rooms, so no include can run upwards.  The parser only knows the C++ of this
tree.  The length of a function goes from the first line of its signature to the closing brace,
lambdas included; the methods of a class are all functions that it declares, and classes within
others or of the same name elsewhere are classes of their own."""
import collections
import math
import os
import re
import sys

TOP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
LAYERS = open(os.path.join(TOP, "unittest/check_layers.cmake")).read()
ROOMS = re.search(r"set\(rooms ([\w ]+)\)", LAYERS).group(1).split()[::-1]    # from the bottom up
RECORD = re.compile(r"\s*(?:typedef\s+)?(class|struct|union|enum)(?:\s+(?:class|struct))?\s+"
                    r"((?:\w+(?:<[^{}]*>)?::)*\w+)")
ALIGNED = re.compile(r"\balignas\s*\([^()]*\)")
METHOD = re.compile(r"[\w~\])]\s*\([^()]*(\([^()]*\)[^()]*)*\)\s*(const|override|noexcept|final|\s)*$")
NO_METHOD = re.compile(r"\s*(using|friend|typedef|static_assert)\b")
INITIALIZED = re.compile(r"(?!.*\boperator\b)[^(]*=", re.S)    # a member variable
PARTS = ["src", "kokkos", "unittest", "bench"]


def sources(root):
    """Paths of all C++ files, relative to root."""
    for part in PARTS:
        for folder, _, names in os.walk(os.path.join(root, part)):
            for name in sorted(names):
                if name.endswith((".h", ".cpp")):
                    yield os.path.relpath(os.path.join(folder, name), root)


def blank(match):
    return re.sub(r"[^\n]", " ", match.group(0))


def without_comments(text):
    """The text with comments, preprocessor lines, and the content of literals blanked out."""
    tokens = r'//[^\n]*|/\*.*?\*/|R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\''
    text = re.sub(tokens, lambda m: blank(m) if m.group(0)[0] == "/" else '"' + blank(m)[1:-1] + '"',
                  text, flags=re.S)
    return re.sub(r"^[ \t]*#(?:[^\n]*\\\n)*[^\n]*", blank, text, flags=re.M)


def line_of(text, place):
    return text.count("\n", 0, place) + 1


Scope = collections.namedtuple("Scope", "kind name start")


def without_template(head):
    """A declaration without the parameters of its template."""
    return re.sub(r"template\s*<[^{}()]*?>\s*(?=class|struct|union|[A-Za-z_:])", "", head)


def is_method(head):
    """True for the declaration of a function within a class."""
    return METHOD.search(head) and not NO_METHOD.match(head) and not INITIALIZED.match(head)


def functions_and_classes(text):
    """[lines of each function] and {scope of a class: number of methods}, by following the braces."""
    lengths, methods = [], collections.Counter()
    scopes, start = [], 0    # start: of the current declaration
    for m in re.finditer(r"[{};]", text):
        kind = scopes[-1].kind if scopes else "namespace"
        head = text[start:m.start()]
        outside = kind in ("namespace", "class")
        if m.group(0) == "{":
            plain = re.sub(r"\b(public|private|protected)\s*:", " ", head)
            bare = without_template(ALIGNED.sub("", plain))
            record = RECORD.match(bare) if "(" not in bare else None
            if not outside:
                scopes.append(Scope("block", "", start))
            elif re.search(r"\b(namespace|extern\s*\")", head):
                scopes.append(Scope("namespace", "", m.end()))
                start = m.end()
            elif record:
                scopes.append(Scope("block" if record.group(1) == "enum" else "class", record.group(2), m.end()))
                start = m.end()
            elif "(" not in plain or re.search(r"[=,]\s*$|\)\s*:[^:].*[\w>]$", plain, re.S):
                scopes.append(Scope("initializer", "", start))
            else:
                scopes.append(Scope("function", "", start + len(head) - len(head.lstrip())))
                if kind == "class":
                    methods[scopes[-2]] += 1
        elif m.group(0) == "}":
            if not scopes:
                continue
            closed = scopes.pop()
            if closed.kind == "function":
                lengths.append(line_of(text, m.end()) - line_of(text, closed.start) + 1)
            if closed.kind != "initializer" and (not scopes or scopes[-1].kind in ("namespace", "class")):
                start = m.end()
        elif outside:
            plain = re.sub(r"\b(public|private|protected)\s*:|=\s*(0|default|delete)\s*$", " ", head)
            if kind == "class" and is_method(without_template(plain)):
                methods[scopes[-1]] += 1
            start = m.end()
    return lengths, methods


def include_graph(root, paths):
    """{path: paths that it includes} for src and kokkos."""
    by_name = {}
    for path in paths:
        if path.startswith(("src", "kokkos")):
            for key in (os.path.basename(path), "/".join(path.split("/")[-2:])):
                by_name[key] = path
    graph = {}
    for path in sorted(set(by_name.values())):
        names = re.findall(r'#include "([^"]+)"', open(os.path.join(root, path)).read())
        graph[path] = {by_name[name] for name in names if name in by_name} - {path}
    return graph


def height(path):
    """Level of a file's room: a file may only include files that are not higher.  Styles are above all rooms."""
    room = os.path.basename(os.path.dirname(path))
    return ROOMS.index(room) if room in ROOMS else len(ROOMS)


def longest_chain(graph):
    """Number of files in the longest chain of includes."""
    length = {}

    def visit(path):
        if path not in length:
            length[path] = 1    # ends a cycle
            length[path] = 1 + max((visit(other) for other in graph[path]), default=0)
        return length[path]
    return max(map(visit, graph), default=0)


def quantile(ordered, share):
    return ordered[math.ceil(share * len(ordered)) - 1] if ordered else 0


def measure(root):
    """{row: text of the cell}, in the order of the rows."""
    paths = list(sources(root))
    flat = not os.path.isdir(os.path.join(root, "src/BD-HYDRO/core"))
    rooms, files, methods = collections.Counter(), [], []
    code, casts, wide = collections.Counter(), collections.Counter(), collections.Counter()
    lengths = collections.defaultdict(list)
    for path in paths:
        text = open(os.path.join(root, path)).read()
        part = path.split("/")[0]
        stripped = without_comments(text)
        rooms[os.path.dirname(path) if part in ("src", "kokkos") else part] += 1
        code[part] += sum(bool(line.strip()) for line in re.sub(r"//[^\n]*", "", text).split("\n"))
        casts[part] += stripped.count("static_cast<")
        wide[part] += sum(len(line) > 100 for line in text.split("\n"))
        its_lengths, its_methods = functions_and_classes(stripped)
        lengths[part] += its_lengths
        if part in ("src", "kokkos"):
            methods += [(n, scope.name) for scope, n in its_methods.items()]
            files.append((text.count("\n"), path))
    graph = include_graph(root, paths)
    up = sum(height(other) > height(path) for path in graph for other in graph[path])
    rows = {"files in " + room: str(n) for room, n in sorted(rooms.items())}
    rows["includes that run upwards"] = "(no rooms)" if flat else str(up)
    rows["longest chain of includes"] = f"{longest_chain(graph)} files"
    most = sorted(methods, key=lambda entry: -entry[0])[:2]
    rows["longest class"] = ", ".join(f"{name} ({n} methods)" for n, name in most)
    longest = sorted(files)[:-3:-1]
    rows["longest file"] = ", ".join(f"{os.path.basename(path)} ({n} lines)" for n, path in longest)
    for part in PARTS:
        if code[part]:
            rows[f"{part}: static_cast per 1000 code lines"] = f"{1000 * casts[part] / code[part]:.1f}"
    for part in PARTS:
        if code[part]:
            rows[f"{part}: lines over 100 columns"] = str(wide[part])
    for part in PARTS:
        if code[part]:
            n = sorted(lengths[part])
            cell = f"{quantile(n, .5)}, {quantile(n, .9)}, {max(n, default=0)} ({len(n)} functions)"
            rows[f"{part}: function lengths (median, p90, max)"] = cell
    return rows


def main():
    roots = sys.argv[1:] or [TOP]
    columns = [measure(root) for root in roots]
    if not any(columns):
        sys.exit("house.py: no sources below " + " ".join(roots))
    names = []
    for column in columns:
        names += [row for row in column if row not in names]
    folders = [row for row in names if row.startswith("files in ")]
    names = sorted(folders) + [row for row in names if row not in folders]
    print("| measure | " + " | ".join(os.path.basename(os.path.abspath(root)) for root in roots) + " |")
    print("|---" * (1 + len(roots)) + "|")
    for row in names:
        print(f"| {row} | " + " | ".join(column.get(row, "-") for column in columns) + " |")


main()
