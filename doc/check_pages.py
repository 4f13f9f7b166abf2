#!/usr/bin/python3
"""Checks the built manual: check_pages.py HTML-FOLDER [LAMMPS-PAGES]

Links inside it, the names of LAMMPS' pages (if its source is there), paths of this repository that the pages mention, and
spelling: codespell for its list of common mistakes in all text and code, aspell for every word of the pages that is prose.
Words that aspell does not know and that are right belong in words.txt.
"""

import html.parser
import os
import re
import subprocess
import sys
import urllib.parse

DOC = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(DOC)
SILENT = {"pre", "code", "tt", "script", "style", "title", "kbd", "samp"}


class Page(html.parser.HTMLParser):
    """Links, anchors, prose and pieces of code of the part of a page that an author wrote."""

    def __init__(self, path):
        super().__init__()
        self.links, self.anchors, self.prose, self.code = [], set(), [], []
        self.stack = []    # tags; a tag is silent if it or one around it is
        with open(path, encoding="utf-8") as f:
            self.feed(f.read())

    def handle_starttag(self, tag, attributes):
        a = dict(attributes)
        self.anchors |= {a[k] for k in ("id", "name") if k in a}
        self.links += [a[k] for k in ("href", "src") if a.get(k)]
        if tag in ("br", "img", "meta", "link", "input", "hr", "col", "wbr"):
            return
        silent = tag in SILENT or "math" in a.get("class", "").split()
        body = a.get("role") == "main" or a.get("itemprop") == "articleBody"
        outer = self.stack[-1] if self.stack else ("", False, False)
        self.stack.append((tag, outer[1] or silent, outer[2] or body))

    def handle_endtag(self, tag):
        while self.stack and self.stack.pop()[0] != tag:
            pass

    def handle_data(self, data):
        if self.stack and self.stack[-1][2]:
            (self.code if self.stack[-1][1] else self.prose).append(data)


def broken_links(pages):
    faults = []
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = os.path.normpath(os.path.join(os.path.dirname(path), urllib.parse.unquote(parts.path)))
            if not parts.path:
                target = path
            if not os.path.exists(target):
                faults.append(f"{path}: no file {link}")
            elif parts.fragment and target in pages and urllib.parse.unquote(parts.fragment) not in pages[target].anchors:
                faults.append(f"{path}: no place {link}")
    return faults


def missing_files(pages):
    """Paths of this repository in the text: bench/..., cmake/..., doc/..., examples/..., src/..., unittest/..."""
    pattern = re.compile(r"^(?:\./)?(?:bench|cmake|doc|examples|potentials|src|unittest)/[\w./-]*[\w]$")
    ignored = re.compile(r"/results\b")    # what a run makes
    faults = []
    for path, page in pages.items():
        for piece in page.code:
            for word in piece.split():
                if pattern.match(word) and not ignored.search(word) and not os.path.exists(os.path.join(TOP, word)):
                    faults.append(f"{path}: no file {word} in the repository")
    return faults


def missing_lammps_pages(folder):
    sys.path.insert(0, DOC)
    sys.dont_write_bytecode = True
    from conf import LAMMPS_PAGES
    return [f"conf.py: LAMMPS has no page {name}" for name in sorted(LAMMPS_PAGES)
            if not os.path.exists(os.path.join(folder, name + ".rst"))]


def unknown_words(pages):
    """Words that neither aspell nor words.txt knows; a word with digits or underscores is a name."""
    with open(os.path.join(DOC, "words.txt")) as f:
        ours = {line.strip() for line in f if not line.startswith("#")}
    words = {}
    for path, page in pages.items():
        for word in re.findall(r"[\w'’/-]+", " ".join(page.prose)):
            for part in re.split(r"[-/]", word.replace("’", "'")):
                part = re.sub(r"^'+|'s$|'+$", "", part)
                if re.fullmatch(r"[A-Za-zÀ-ÿ']{3,}", part):
                    words.setdefault(part, path)
    known = subprocess.run(["aspell", "list", "--lang=en", "--encoding=utf-8", "--ignore-case=false"],
                           input="\n".join(words), capture_output=True, text=True, check=True)
    return [f"{words[w]}: unknown word '{w}'" for w in sorted(set(known.stdout.split()) - ours) if w in words]


def common_mistakes():
    names = re.compile(r"(\.(md|rst|h|cpp|py|sh|cmake|txt)|/in\.[\w.]+)$")
    files = [os.path.join(TOP, "README.md")]
    for folder in ("bench", "cmake", "doc", "examples", "src", "unittest"):
        for base, _, here in os.walk(os.path.join(TOP, folder)):
            files += [path for path in (os.path.join(base, name) for name in here)
                      if names.search(path) and "/results/" not in path]
    run = subprocess.run(["codespell", "--ignore-words", os.path.join(DOC, "words_codespell.txt"), *files], capture_output=True, text=True)
    return run.stdout.splitlines() + run.stderr.splitlines()


def main():
    folder = os.path.normpath(sys.argv[1])
    paths = [os.path.join(base, name) for base, _, names in os.walk(folder) for name in names if name.endswith(".html")]
    pages = {path: Page(path) for path in paths}
    authored = {p: page for p, page in pages.items() if os.path.basename(p) not in ("genindex.html", "search.html")}
    faults = broken_links(pages) + missing_files(authored) + unknown_words(authored) + common_mistakes()
    if len(sys.argv) > 2 and os.path.isdir(sys.argv[2]):
        faults += missing_lammps_pages(sys.argv[2])
    print(f"{len(pages)} pages, {sum(len(p.links) for p in pages.values())} links, "
          f"{sum(len(p.prose) for p in authored.values())} pieces of prose")
    for fault in faults:
        print("FAULT " + fault)
    if faults or len(pages) < 10:
        sys.exit(1)


if __name__ == "__main__":
    main()
