#!/usr/bin/python3
"""Predicts how the steps of both fixes scale with the number of ranks: a model that can be wrong.

    bench/scaling_model.py                       doc/charts/scaling_*.csv, *.png, and the table of the manual
    bench/scaling_model.py compare [build/lmp]   predictions beside doc/charts/ranks.csv, and beside runs on this machine
    bench/scaling_model.py counts                messages and bytes of hand-overs: unittest/reference/traffic.csv
    bench/scaling_model.py check FILE            fails if FILE differs from `counts`

Soft spheres of radius 1 in a periodic cube, volume fraction 0.1, steps with noise: midpoint with peskin4, or scheme euler at the
tolerance 1e-3.  The step of a fix takes the time of the slowest rank for its part of the grid and of the particles, and that of
its messages, one after the other.  Forces, and what LAMMPS itself exchanges, are not part of it.

Slabs: planes of the grid are dealt to the ranks, and one hand-over among all ranks makes the third axis local.  Pencils: planes are
dealt to groups of ranks that share their rows, and two hand-overs take the place of one, within the groups and across them.
"""
import argparse
import csv
import math
import os
import re
import sys
from types import SimpleNamespace

TOP = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
FOLDER = os.path.join(TOP, "doc", "charts")
PHI = 0.1

# Two machines: seconds to send a message, and bytes per second of a rank, within a node and between nodes.
# "here" is what bench/grid/bench_messages.cpp measures on two cores; "cluster" is an assumption: nodes of 64 ranks with 12 GB/s.
MACHINES = {
    "here": SimpleNamespace(node=10**9, latency=0.6e-6, bandwidth=1.5e9, outer_latency=0.0, outer_bandwidth=1.0),
    "cluster": SimpleNamespace(node=64, latency=0.6e-6, bandwidth=1.5e9, outer_latency=2e-6, outer_bandwidth=12e9 / 64),
}

# Of one core, from the tables of bench/README.md.  transform: [s] per point of the grid and per log2 of the number of points, of all
# transforms of a step; modes: [s] per point; grid_particle, pair_particle: [s] per particle, for spreading and interpolation, and
# for pairs and the Lanczos process.  spacing: of the grid, in radii, at most.  kept: radius of the sphere of modes, in 1/radius.
# reach: planes under a particle.  word: bytes of a complex number.  carried: of particles, to the slabs and back, 24 bytes each.
# rounds: exchanges of ghosts.  sums: collective ones.  memory: bytes per point.
FIXES = {
    "fib": SimpleNamespace(transform=1.9e-9, modes=6e-9, grid_particle=600e-9, pair_particle=0.0, spacing=0.797, kept=None, reach=5,
                           word=16, carried=(3, 2), deals=2, rounds=0, ghost=0.0, sums=0, memory=23.0),
    "pse": SimpleNamespace(transform=0.43e-9, modes=12e-9, grid_particle=300e-9, pair_particle=600e-9, spacing=1.37, kept=2.011, reach=6,
                           word=8, carried=(2, 1), deals=1, rounds=5, ghost=6.905, sums=10, memory=60.0),
}
COPY_SHARE = 0.3       # assumed: of the time for a particle and the grid, what each slab that it touches spends again
RANK_MEMORY = 4e9      # bytes: with fewer ranks than that allows, a system is left out


# Counts, exact: what unittest/base/test_traffic.cpp compares with the counters.

def equal_parts(n, ranks):
    """Parts of n that the ranks get (grid/slabs.h)."""
    most = -(-n // ranks)
    return [max(0, min(most, n - r * most)) for r in range(ranks)]


def dealt_columns(columns, ranks):
    """Columns of modes of each rank, which gets whole rows (grid/fft.cpp); columns: of each row."""
    total, before = sum(columns), 0
    mine = [0] * ranks
    for c in columns:
        if c:
            mine[(2 * before + c) * ranks // (2 * total)] += c
        before += c
    return mine


def row_width(n, kept):
    """Columns of a row that are transformed along y."""
    half = n[0] // 2 + 1
    return half if kept is None else min(half, whole((n[0] - 1) // 2 + 1))


def whole(columns):
    """Rounded up to what is transformed together (SlowAxis::batch)."""
    return -(-columns // 4) * 4


def columns_of_rows(n, kept):
    """Columns of each row y that are handed over; kept: radius of the sphere of modes, in indices, or None for all modes."""
    width = row_width(n, kept)
    if kept is None:
        return [width] * n[1]
    most = [(m - 1) // 2 for m in n]
    rows = []
    for y in range(n[1]):
        ny = min(y, n[1] - y)
        inside = ny <= most[1] and ny <= kept
        rows.append(min(width, whole(min(most[0], math.floor(math.sqrt(kept**2 - ny**2))) + 1)) if inside else 0)
    return rows


def hand_overs(planes, columns, word):
    """(messages, bytes) that each rank sends in the hand-overs of a step, three components there and back."""
    with_planes, with_columns = sum(p > 0 for p in planes), sum(c > 0 for c in columns)
    all_planes, all_columns = sum(planes), sum(columns)
    sent = []
    for p, c in zip(planes, columns):
        messages = (with_columns - (c > 0) if p else 0) + (with_planes - (p > 0) if c else 0)
        sent.append((3 * messages, 3 * word * (p * (all_columns - c) + c * (all_planes - p))))
    return sent


def hand_overs_of_pencils(n, share, ranks, kept, word):
    """For each rank (messages, bytes) that it sends within its slab, and the same across slabs."""
    groups = ranks // share
    planes, rows, width = equal_parts(n[2], groups), equal_parts(n[1], share), equal_parts(row_width(n, kept), share)
    columns = columns_of_rows(n, kept)
    within, across = [(0, 0)] * ranks, [(0, 0)] * ranks
    for place in range(share):
        # Ranks that are left over work on modes of the first columns.
        members = [g * share + place for g in range(groups)] + (list(range(groups * share, ranks)) if place == 0 else [])
        for g in range(groups):
            sent = [planes[g] * v for other in range(share) if other != place
                    for v in (rows[place] * width[other], rows[other] * width[place])]
            within[members[g]] = (3 * sum(v > 0 for v in sent), 3 * word * sum(sent))
        before = sum(width[:place])
        mine = dealt_columns([min(max(c - before, 0), width[place]) for c in columns], len(members))
        for rank, sent in zip(members, hand_overs(planes + [0] * (len(members) - groups), mine, word)):
            across[rank] = sent
    return within, across


def counts():
    """The lines of unittest/reference/traffic.csv."""
    cases = [("fib", n, None) for n in ((16, 16, 16), (20, 24, 16), (12, 10, 8), (12, 8, 3), (9, 7, 5))]
    cases += [("pse", n, kept) for n, kept in (((16, 16, 16), 6.3), ((24, 20, 16), 6.7), ((20, 20, 20), 4.4), ((32, 30, 28), 12.6))]
    lines = ["fix,nx,ny,nz,kept,ranks,share,rank,messages,bytes"]
    for fix, n, kept in cases:
        for ranks in (2, 3, 4):
            for share in range(1, ranks + 1):
                both = zip(*hand_overs_of_pencils(n, share, ranks, kept, FIXES[fix].word))
                lines += [f"{fix},{n[0]},{n[1]},{n[2]},{kept or 0},{ranks},{share},{r},{a[0] + b[0]},{a[1] + b[1]}"
                          for r, (a, b) in enumerate(both)]
    return lines


# The scene, and what it takes on average.

def is_fast(n):
    for p in (2, 3, 5, 7):
        while n % p == 0:
            n //= p
    return n == 1


def fast_size(wanted, nearest):
    """A number that transforms are fast for: the next one that is even, or the nearest one by its ratio to `wanted`."""
    above = next(n for n in range(math.ceil(wanted), 10**9) if is_fast(n) and (nearest or n % 2 == 0))
    if nearest:
        below = next(n for n in range(math.floor(wanted), 0, -1) if is_fast(n))
        return below if wanted / below < above / wanted else above
    return above


def bricks(ranks):
    """LAMMPS' division of a cube, which has the least surface: the last rank index runs along z."""
    best = None
    for px in range(1, ranks + 1):
        if ranks % px == 0:
            for py in range(1, ranks // px + 1):
                if ranks // px % py == 0:
                    pz = ranks // px // py
                    surface = 1 / (px * py) + 1 / (px * pz) + 1 / (py * pz)
                    if best is None or surface < best[0] - 1e-12:
                        best = (surface, (px, py, pz))
    return best[1]


def overlap(a, b, c, d, period):
    """Length that [a, b] and the periodic images of [c, d] have in common, at most b - a."""
    return min(b - a, sum(max(0.0, min(b, d + k * period) - max(a, c + k * period)) for k in (-1, 0, 1)))


def mean_and_most(values):
    return SimpleNamespace(mean=sum(values) / len(values), most=max(values))


def carried_particles(particles, ranks, grid, planes, reach):
    """Over the ranks: `out`, particles that one sends to other ranks' slabs; `to`, the number of these ranks; `back` and `back_to`,
    those that it returns from its own slab; `held`, particles in its slab, where one counts in each slab that it touches.
    Expected values, for a uniform density."""
    px, py, pz = bricks(ranks)
    each, height, margin = particles / ranks, grid / pz, (reach - 1) / 2
    starts = [sum(planes[:1]) * r for r in range(ranks)]
    share = [[overlap(iz * height, (iz + 1) * height, starts[s] - margin, starts[s] + planes[s] + margin, grid) / height
              if planes[s] else 0.0 for s in range(ranks)] for iz in range(pz)]    # of a layer's particles in a slab
    touches = [[v > 1e-9 for v in row] for row in share]
    of_layer, ranks_of = [sum(row) for row in share], [sum(row) for row in touches]
    of_slab = [sum(column) for column in zip(*share)]
    layers_of = [sum(column) for column in zip(*touches)]
    all_ranks = [(r, r % pz) for r in range(ranks)]    # with their layer
    return SimpleNamespace(
        out=mean_and_most([each * (of_layer[z] - share[z][r]) for r, z in all_ranks]),
        to=mean_and_most([ranks_of[z] - touches[z][r] for r, z in all_ranks]),
        back=mean_and_most([each * (px * py * of_slab[r] - share[z][r]) for r, z in all_ranks]),
        back_to=mean_and_most([px * py * layers_of[r] - touches[z][r] for r, z in all_ranks]),
        held=max(each * px * py * v for v in of_slab))


def ghosts(particles, ranks, cutoff):
    """(messages, particles) that a brick sends in one exchange of ghosts."""
    edge = (particles * 4 / 3 * math.pi / PHI) ** (1 / 3)
    p = bricks(ranks)
    l = [edge / n for n in p]
    messages, volume, wide = 0, 0.0, list(l)
    for d in range(3):
        across = math.prod(wide[k] for k in range(3) if k != d)
        if p[d] > 1:
            messages += 2 * math.ceil(cutoff / l[d])
            volume += 2 * cutoff * across
        wide[d] += 2 * cutoff
    return messages, volume * particles / edge**3


def plan(fix, particles):
    f = FIXES[fix]
    edge = (particles * 4 / 3 * math.pi / PHI) ** (1 / 3)
    grid = fast_size(edge / f.spacing, f.kept is None)
    return grid, None if f.kept is None else f.kept * edge / (2 * math.pi)


# Time.

def near_share(machine, ranks, stride=1):
    """Of the others in a group of ranks, `stride` apart: the share in one's own node."""
    return 1.0 if ranks == 1 else min(1.0, max(0.0, machine.node / stride - 1) / (ranks - 1))


def seconds_of_messages(machine, near, messages, size):
    """For `messages` with `size` bytes together, of which the share `near` stays in the node."""
    latency = near * machine.latency + (1 - near) * machine.outer_latency
    return messages * latency + size * (near / machine.bandwidth + (1 - near) / machine.outer_bandwidth)


def seconds_of_deal(machine, ranks):
    """All ranks send 4 bytes to all: in turn, or in log2(ranks) rounds that carry half of everything, whichever is faster."""
    rounds = math.ceil(math.log2(ranks)) if ranks > 1 else 0
    near = near_share(machine, ranks)
    return min(seconds_of_messages(machine, near, ranks - 1, 4 * (ranks - 1)), seconds_of_messages(machine, near, rounds, 2 * ranks * rounds))


def seconds_of_sum(machine, ranks):
    return sum(2 * (machine.latency if 2**k < machine.node else machine.outer_latency) for k in range(math.ceil(math.log2(ranks))))


def share_seconds():
    """The constants of the choice in grid/parts.cpp."""
    with open(os.path.join(TOP, "src", "BD-HYDRO", "core", "grid", "parts.cpp")) as f:
        return {name: float(value) for name, value in re.findall(r"double (\w+)_seconds = (\S+);", f.read())}


def best_share(n, ranks, least=1):
    """Ranks that share a slab of a cube, as grid/parts.cpp chooses them among those from `least` on."""
    cost = share_seconds()

    def seconds(share):
        groups = ranks // share
        carried = (cost["row"] if share > 1 else 0) + (cost["plane"] if groups > 1 else 0)
        points = n * -(-n // share) * -(-n // groups)
        return points * (cost["point"] + carried) + 6 * (share + groups - 2) * cost["message"]

    slabs = 0.9 * seconds(1) if least == 1 else math.inf
    times = [(seconds(share), share) for share in range(2, min(ranks, n) + 1) if share <= ranks // share or ranks // share >= n]
    least_time = min([slabs] + [t for t, _ in times])
    almost = [(-(-n // (ranks // share)), share) for t, share in times if t < slabs and t <= least_time / 0.9]
    return min(almost)[1] if almost else 1


def in_slabs(f, particles, ranks, grid, kept, machine):
    """What a step's layout means for the ranks: `share` of the grid that it works on, `share_kept` that it keeps, and
    `share_modes` of the columns, each of the busiest one; messages
    and bytes of the hand-overs, and the seconds that these take; particles that are carried (see there); ranks with planes."""
    columns = columns_of_rows((grid, grid, grid), kept)
    planes, mine = equal_parts(grid, ranks), dealt_columns(columns, ranks)
    messages, size = (mean_and_most(v) for v in zip(*hand_overs(planes, mine, f.word)))
    return SimpleNamespace(share=max(planes) / grid, share_modes=max(mine) / sum(mine), share_kept=max(planes) / grid,
                           messages=messages, size=size,
                           seconds=seconds_of_messages(machine, near_share(machine, ranks), messages.most, size.most),
                           carried=carried_particles(particles, ranks, grid, planes, f.reach), working=sum(p > 0 for p in planes))


def in_pencils(f, particles, ranks, grid, kept, machine):
    """The same for pencils: rows are dealt to `a` consecutive ranks, planes to `b` ranks that are `a` apart."""
    a = best_share(grid, ranks, least=2)
    if a == 1:
        return in_slabs(f, particles, ranks, grid, kept, machine)
    b = ranks // a
    rows, planes = -(-grid // a), -(-grid // b)
    n = (grid, grid, grid)
    within, across = hand_overs_of_pencils(n, a, ranks, kept, f.word)
    (first, first_size), (second, second_size) = ([mean_and_most(v) for v in zip(*sent)] for sent in (within, across))
    seconds = (seconds_of_messages(machine, near_share(machine, a), first.most, first_size.most)
               + seconds_of_messages(machine, near_share(machine, b, a), second.most, second_size.most))
    px, py, pz = bricks(ranks)
    held = particles / ranks * (1 + (f.reach - 1) / rows) * (1 + (f.reach - 1) / planes)
    moved = mean_and_most([held * (1 - 1 / px)])
    carried = SimpleNamespace(held=held, out=moved, back=moved, to=mean_and_most([min(ranks, (a / py + 2) * (b / pz + 2)) - 1]),
                              back_to=mean_and_most([min(ranks, px * (py / a + 2) * (pz / b + 2)) - 1]))
    share = rows * planes / grid**2
    both = lambda u, v: SimpleNamespace(mean=u.mean + v.mean, most=u.most + v.most)
    return SimpleNamespace(share=share, share_modes=share, share_kept=planes / grid,
                           messages=both(first, second), size=both(first_size, second_size), seconds=seconds, carried=carried, working=min(ranks, -(-grid // rows) * -(-grid // planes)))


LAYOUTS = {"slabs": in_slabs, "pencils": in_pencils}


def step(fix, particles, ranks, layout, machine):
    """The step of the busiest rank: seconds, and what they are spent on; messages and bytes that it sends."""
    f = FIXES[fix]
    grid, kept = plan(fix, particles)
    points = grid**3
    per_point = f.transform * math.log2(points) + f.modes
    dealt = LAYOUTS[layout](f, particles, ranks, grid, kept, machine)
    share, share_modes, messages, size, carried = dealt.share, dealt.share_modes, dealt.messages, dealt.size, dealt.carried
    grid_seconds = points * per_point * 0.5 * (share + share_modes)
    particle_seconds = f.grid_particle * ((1 - COPY_SHARE) * particles * share + COPY_SHARE * carried.held)
    brick = (particles * 4 / 3 * math.pi / PHI / ranks) ** (1 / 3)
    outside = 1 - max(0.0, 1 - 3 * f.ghost / (8 * brick)) ** 3 if ranks > 1 else 0.0
    particle_seconds += f.pair_particle * particles / ranks * (1 + outside)
    ghost_messages, ghost_particles = ghosts(particles, ranks, f.ghost) if f.rounds else (0, 0.0)
    there, back = f.carried

    deals = f.deals * (ranks - 1)    # each rank sends 4 bytes to each other one whenever particles are dealt to slabs

    def of_particles(kind):
        """Messages and bytes for slabs and ghosts: of a rank on average, or of the busiest one."""
        of = lambda v: getattr(v, kind)
        return (there * of(carried.to) + back * of(carried.back_to) + f.rounds * ghost_messages,
                24 * (there * of(carried.out) + back * of(carried.back) + f.rounds * ghost_particles))

    most, mean = of_particles("most"), of_particles("mean")
    message_seconds = (dealt.seconds + seconds_of_messages(machine, near_share(machine, ranks), *most)
                       + f.deals * seconds_of_deal(machine, ranks) + f.sums * seconds_of_sum(machine, ranks))
    return SimpleNamespace(seconds=grid_seconds + particle_seconds + message_seconds, grid=grid_seconds, particles=particle_seconds,
                           communication=message_seconds, messages=messages.most + most[0] + deals, bytes=size.most + most[1] + 4 * deals,
                           mean_messages=messages.mean + mean[0] + deals, mean_bytes=size.mean + mean[1] + 4 * deals, working=dealt.working,
                           memory=f.memory * points * dealt.share_kept)


# Tables and charts.

RANKS = [2**k for k in range(14)] + [10000]
COLUMNS = "fix,particles,ranks,layout,working,seconds,grid_seconds,particle_seconds,message_seconds,messages,bytes".split(",")


def rows_of(systems, machine):
    """For each (fix, particles, ranks) that fits into memory: both layouts."""
    found = []
    for fix, particles, ranks in systems:
        for layout in LAYOUTS:
            s = step(fix, particles, ranks, layout, machine)
            if s.memory <= RANK_MEMORY:
                found.append(dict(zip(COLUMNS, (fix, particles, ranks, layout, s.working, s.seconds, s.grid, s.particles,
                                                s.communication, s.messages, s.bytes))))
    return found


def write(name, rows):
    with open(os.path.join(FOLDER, name + ".csv"), "w", newline="") as f:
        out = csv.writer(f, lineterminator="\n")
        out.writerow(COLUMNS)
        out.writerows([f"{r[c]:.4g}" if isinstance(r[c], float) else r[c] for c in COLUMNS] for r in rows)


def line(rows, layout):
    own = [r for r in rows if r["layout"] == layout]
    return [r["ranks"] for r in own], [r["seconds"] for r in own]


def crossover(rows):
    """The fewest ranks from which on pencils are faster by a tenth, and their time; None if there is no such number."""
    slabs, pencils = dict(zip(*line(rows, "slabs"))), dict(zip(*line(rows, "pencils")))
    found = None
    for ranks in sorted(slabs, reverse=True):
        if pencils[ranks] > 0.9 * slabs[ranks]:
            break
        found = ranks, pencils[ranks]
    return found


def draw(name, rows, key, label, title):
    """A panel for each fix, with a color for each value of `key`: slabs solid, pencils dashed, their crossover a dot."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 110, "font.size": 9})
    figure, axes = plt.subplots(1, 2, figsize=(9.5, 4.2), sharey=True)
    for axis, fix in zip(axes, FIXES):
        own = [r for r in rows if r["fix"] == fix]
        for color, value in enumerate(sorted({key(r) for r in own})):
            these = [r for r in own if key(r) == value]
            axis.loglog(*line(these, "slabs"), "-", color=f"C{color}", label=label(value))
            axis.loglog(*line(these, "pencils"), "--", color=f"C{color}")
            if crossover(these):
                axis.plot(*crossover(these), "o", color=f"C{color}", ms=6)
        axis.set(title=f"bd/{fix}", xlabel="ranks")
        axis.legend(fontsize=8)
    axes[0].set_ylabel("time of a step [s], predicted")
    figure.suptitle(title)
    figure.tight_layout()
    figure.savefig(os.path.join(FOLDER, name + ".png"))
    plt.close(figure)


def exponent(n):
    return f"$10^{{{round(math.log10(n))}}}$"


def table(rows):
    """For each system: the fastest number of ranks for slabs, how many still use half of their time well, and the crossover."""
    print("| fix | particles | planes | half efficient up to [ranks] | planes each | time [s] | fastest with [ranks] | time [s] | pencils faster from [ranks] |")
    print("|---|---|---|---|---|---|---|---|---|")
    for fix in FIXES:
        for particles in sorted({r["particles"] for r in rows}):
            these = [r for r in rows if r["fix"] == fix and r["particles"] == particles]
            slabs = [r for r in these if r["layout"] == "slabs"]
            efficiency = lambda r: step(fix, particles, 1, "slabs", MACHINES["here"]).seconds / (r["ranks"] * r["seconds"])
            well = [r for r in slabs if efficiency(r) >= 0.5]
            best = min(slabs, key=lambda r: r["seconds"])
            grid = plan(fix, particles)[0]
            cross = crossover(these)
            most = f"{well[-1]['ranks']} | {grid / well[-1]['ranks']:.2g} | {well[-1]['seconds']:.2g}" if well else "- | - | -"
            print(f"| bd/{fix} | 1e{round(math.log10(particles))} | {grid} | {most} | {best['ranks']} | {best['seconds']:.2g} | "
                  f"{cross[0] if cross else '-'} |")


def seconds_with_threads(fix, particles, cores, threads, layout, machine):
    """Of a step on all cores with `threads` for each rank.  Assumed: threads share all work of their rank, and its bandwidth grows
    with them; None if it does not fit into memory."""
    m = SimpleNamespace(**vars(machine))
    m.node = max(1, machine.node // threads)
    m.bandwidth, m.outer_bandwidth = threads * machine.bandwidth, threads * machine.outer_bandwidth
    s = step(fix, particles, cores // threads, layout, m)
    return None if s.memory > threads * RANK_MEMORY else (s.grid + s.particles) / threads + s.communication


def table_of_threads(machine):
    """Time of a step, by layout, cores and threads of a rank."""
    cores = (64, 256, 1024, 4096)
    print("\n| fix | particles | layout | threads of a rank | " + " | ".join(f"{c} cores [s]" for c in cores) + " |")
    print("|---" * (4 + len(cores)) + "|")
    for fix in FIXES:
        for particles in (10**6, 10**7, 10**8):
            for layout, threads in (("slabs", 1), ("pencils", 1), ("slabs", 8), ("slabs", 32)):
                times = [seconds_with_threads(fix, particles, c, threads, layout, machine) for c in cores]
                print(f"| bd/{fix} | 1e{round(math.log10(particles))} | {layout} | {threads} | "
                      + " | ".join(f"{t:.2g}" if t else "-" for t in times) + " |")


def charts(machine):
    strong = rows_of([(fix, n, p) for fix in FIXES for n in (10**6, 10**7, 10**8, 10**9) for p in RANKS], machine)
    weak = rows_of([(fix, n * p, p) for fix in FIXES for n in (10**4, 10**5) for p in RANKS], machine)
    write("scaling_strong", strong)
    write("scaling_weak", weak)
    note = "slabs solid, pencils dashed, dot: pencils faster by a tenth from here on"
    draw("scaling_strong", strong, lambda r: r["particles"], lambda n: exponent(n) + " particles", "Strong scaling: " + note)
    draw("scaling_weak", weak, lambda r: r["particles"] // r["ranks"], lambda n: exponent(n) + " particles per rank", "Weak scaling: " + note)
    table(strong)
    table_of_threads(machine)


# Measurements.

STYLES = {"fib": "bd/fib 1.0 1.0 5 radius 1.0", "pse": "bd/pse 1.0 1.0 5 radius 1.0 tolerance 1e-3"}


def run_steps(lmp, fix, cells, ranks, steps):
    """Seconds of a step of the fix, and the mean messages and bytes of a rank.  All particles are pulled, so that forces act."""
    from lammps_timing import lattice_scene, run
    log = run(lmp, lattice_scene(cells, PHI) + f"fix move all {STYLES[fix]}\nfix pull all addforce 1 0 0\nrun 3\nrun {steps}\n", ranks).log
    seconds = float(re.findall(r"Timing breakdown of fix \S+ \S+: (\S+) s", log)[-1]) / steps
    if ranks == 1:
        return seconds, None
    sent = re.findall(r"mean \(most\): (\S+) \(\S+\) messages, (\S+) \(\S+\) bytes", log)[-1]
    return seconds, [float(v) for v in sent]


def compare(lmp, turns):
    """Predictions for the machine "here": of times beside doc/charts/ranks.csv, and of messages and times beside runs."""
    from chart_tables import read
    print("| fix | particles | ranks | measured with nothing else running [s] | predicted/measured |")
    print("|---|---|---|---|---|")
    for row in read(FOLDER, "ranks"):
        if row["kind"] == "ranks":
            fix, particles, ranks = row["method"].split()[0], round(row["N"]), round(row["count"])
            predicted = step(fix, particles, ranks, "slabs", MACHINES["here"]).seconds
            print(f"| bd/{fix} | {particles} | {ranks} | {row['step_seconds']:.4g} | {predicted / row['step_seconds']:.2f} |")
    if not lmp:
        return
    print("\n| fix | particles | ranks | messages of a rank | predicted/counted | bytes of a rank [MB] | predicted/counted | fastest run now [s] | predicted/measured |")
    print("|---|---|---|---|---|---|---|---|---|")
    for fix in FIXES:
        for cells, steps in ((24, 30), (46, 10)):
            for ranks in (1, 2, 4):
                # Four ranks do not have a core each: only their messages are of use.
                results = [run_steps(lmp, fix, cells, ranks, steps) for _ in range(turns if ranks < 4 else 1)]
                model = step(fix, cells**3, ranks, "slabs", MACHINES["here"])
                sent, time = results[0][1], min(r[0] for r in results)
                counted = (f"{sent[0]:.4g} | {model.mean_messages / sent[0]:.2f} | {sent[1] / 1e6:.4g} | {model.mean_bytes / sent[1]:.3f}"
                           if sent else "| | | ")
                timed = f"{time:.4f} | {model.seconds / time:.2f}" if ranks < 4 else "| "
                print(f"| bd/{fix} | {cells ** 3} | {ranks} | {counted} | {timed} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="?", default="charts", choices=("charts", "compare", "counts", "check"))
    parser.add_argument("file", nargs="?", help="the program lmp, or the file to check")
    parser.add_argument("--turns", type=int, default=3, help="of the runs that are compared")
    for name in ("latency", "bandwidth", "outer_latency", "outer_bandwidth", "node"):
        parser.add_argument("--" + name.replace("_", "-"), type=float, help="of the cluster")
    for fix in FIXES:
        for name in ("transform", "modes", "grid_particle", "pair_particle"):
            parser.add_argument(f"--{fix}-{name.replace('_', '-')}", type=float, help="seconds")
    args = parser.parse_args()
    for name, value in vars(args).items():
        first, _, rest = name.partition("_")
        if value is not None and first in FIXES:
            setattr(FIXES[first], rest, value)
        elif value is not None and hasattr(MACHINES["cluster"], name):
            setattr(MACHINES["cluster"], name, value)
    if args.what == "charts":
        charts(MACHINES["cluster"])
    elif args.what == "compare":
        compare(args.file or "build/lmp", args.turns)
    elif args.what == "counts":
        print("\n".join(counts()))
    else:
        with open(args.file) as f:
            if f.read().splitlines() != counts():
                sys.exit(f"{args.file} is not what `scaling_model.py counts` prints")


if __name__ == "__main__":
    main()
