#!/usr/bin/env python3
"""Registers and spilled bytes of each kernel, from the output of nvcc -Xptxas=-v.

Usage: ptxas_summary.py LOG
Prints a line for each kernel with the worst of its variants: architecture, registers, bytes of stack,
bytes spilled (stores and loads), number of variants, name of the functor.  Kernels of Kokkos that fill
and copy views are left out, and so are those of the /kk/host styles, which LAMMPS also compiles for the
GPU but never runs there."""
import re
import subprocess
import sys


def functor(name):
    """First template argument of Kokkos' ParallelFor<...> without its arguments; None for Kokkos' own."""
    found = re.search(r"Parallel(?:For|Reduce|Scan)(?:WithTotal)?<(.*)", name)
    if not found:
        return None
    short, depth = "", 0
    for c in found.group(1):
        depth += (c == "<") - (c == ">")
        if depth < 0 or (depth == 0 and c == ","):
            break
        short += c
    short = short.replace("LAMMPS_NS::", "").replace("(anonymous namespace)::", "").replace("Kokkos::Cuda", "Cuda")
    return None if short.startswith(("Kokkos::", "Impl::")) or "Kokkos::OpenMP" in short else short


def main():
    text = open(sys.argv[1]).read()
    entries = re.findall(
        r"Compiling entry function '(\S+)' for '(\S+)'\n.*\n\s*(\d+) bytes stack frame, (\d+) bytes spill stores, "
        r"(\d+) bytes spill loads\n.*Used (\d+) registers", text)
    if not entries:
        sys.exit("ptxas_summary.py: no kernel in " + sys.argv[1])
    names = subprocess.run(["c++filt"], input="\n".join(e[0] for e in entries), capture_output=True, text=True,
                           check=True).stdout.splitlines()
    worst = {}
    for name, (_, arch, stack, stores, loads, registers) in zip(names, entries):
        short = functor(name)
        if short is None:
            continue
        numbers = [int(registers), int(stack), int(stores) + int(loads)]
        key = (short, arch)
        old = worst.get(key, ([0, 0, 0], 0))
        worst[key] = ([max(a, b) for a, b in zip(old[0], numbers)], old[1] + 1)
    print("arch   registers  stack  spilled  variants  kernel")
    for (short, arch), (n, count) in sorted(worst.items()):
        print(f"{arch}  {n[0]:9d}  {n[1]:5d}  {n[2]:7d}  {count:8d}  {short}")


main()
