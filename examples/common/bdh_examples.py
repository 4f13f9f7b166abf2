"""Shared parts of the analyses of the examples: tables, error bars, tests against a reference, plot style."""

import csv
import math
import sys

import numpy as np


# ---- tables ---------------------------------------------------------------------------------------------------------

def read_csv(path):
    """Columns of a CSV file by name; lines with '#' are comments.  Columns that are not numeric stay text."""
    with open(path) as f:
        rows = list(csv.reader(line for line in f if not line.startswith("#") and line.strip()))
    columns = {}
    for name, values in zip(rows[0], zip(*rows[1:])):
        try:
            columns[name] = np.array(values, dtype=float)
        except ValueError:
            columns[name] = np.array(values)
    return columns


def read_fix_print(path):
    """Array [line, column] of what fix print or fix ave/time wrote."""
    return np.loadtxt(path, comments="#", ndmin=2)


def read_ave_time_vector(path):
    """Blocks of fix ave/time mode vector: steps [block], rows [block, row, column] (without the row number)."""
    steps, blocks = [], []
    with open(path) as f:
        lines = (line.split() for line in f if not line.startswith("#"))
        for head in lines:
            steps.append(int(head[0]))
            blocks.append([[float(w) for w in next(lines)[1:]] for _ in range(int(head[1]))])
    return np.array(steps), np.array(blocks)


def read_dump(path):
    """Frames of a text dump: list of (step, {column: values})."""
    frames = []
    with open(path) as f:
        for line in f:
            if line.startswith("ITEM: TIMESTEP"):
                step = int(next(f))
            elif line.startswith("ITEM: NUMBER"):
                count = int(next(f))
            elif line.startswith("ITEM: ATOMS"):
                names = line.split()[2:]
                table = np.array([[float(w) for w in next(f).split()] for _ in range(count)])
                frames.append((step, dict(zip(names, table.T))))
    return frames


def print_table(head, rows):
    """head: words; rows: lists of equal length, numbers already formatted."""
    rows = [head] + [[str(v) for v in row] for row in rows]
    widths = [max(len(row[c]) for row in rows) for c in range(len(head))]
    for row in rows:
        print("  " + "  ".join(v.rjust(w) for v, w in zip(row, widths)))


def plus_minus(value, error, digits=2):
    """'5.433(12)': value with the error in units of its last digits."""
    if not (error > 0 and np.isfinite(error)):
        return f"{value:.5g}"
    places = max(0, digits - 1 - int(np.floor(np.log10(error))))
    return f"{value:.{places}f}({round(error * 10**places)})"


# ---- clusters -------------------------------------------------------------------------------------------------------

def largest_cluster(x, side, reach):
    """Fraction of the particles in the largest cluster of pairs closer than `reach` in a periodic cube, and the number of axes
    along which it winds around the box."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order, connected_components
    from scipy.spatial import cKDTree
    pairs = cKDTree(np.mod(x, side), boxsize=side).query_pairs(reach, output_type="ndarray")
    graph = coo_matrix((np.ones(len(pairs)), pairs.T), shape=(len(x), len(x))).tocsr()
    _, label = connected_components(graph, directed=False)
    sizes = np.bincount(label)
    root = int(np.argmax(label == np.argmax(sizes)))
    # unfold the cluster along a spanning tree: a contact that does not close winds around the box
    order, parent = breadth_first_order(graph + graph.T, root, directed=False)
    unfolded = x.copy()
    for i in order[1:]:
        d = x[i] - x[parent[i]]
        unfolded[i] = unfolded[parent[i]] + d - side * np.round(d / side)
    inside = pairs[label[pairs[:, 0]] == label[root]]
    d = unfolded[inside[:, 0]] - unfolded[inside[:, 1]]
    return sizes.max() / len(x), int((np.abs(d) > side / 2).any(0).sum())


# ---- error bars -----------------------------------------------------------------------------------------------------

def mean_and_error(samples, axis=0):
    """Mean of independent samples and its standard error."""
    samples = np.asarray(samples, float)
    n = samples.shape[axis]
    return samples.mean(axis), samples.std(axis, ddof=1) / np.sqrt(n)


def block_means(series, blocks):
    """Means of `blocks` equal pieces of a time series [time, ...]; a remainder at the beginning is dropped."""
    series = np.asarray(series, float)
    length = len(series) // blocks
    series = series[len(series) - blocks * length:]
    return series.reshape((blocks, length) + series.shape[1:]).mean(1)


# ---- tests ----------------------------------------------------------------------------------------------------------

def f_tail(f, above, below):
    """The probability that Fisher's F with `above` and `below` degrees of freedom exceeds f: scipy.stats.f.sf, without scipy,
    for which a first picture would have to wait.

    It is the incomplete beta function I_x(below/2, above/2), x = below/(below + above f), here the integral of
    sin(t)^(below - 1) cos(t)^(above - 1) up to sin(t)^2 = x over that up to t = pi/2."""
    def integral(end):
        nodes, weights = np.polynomial.legendre.leggauss(200)
        t = 0.5 * end * (nodes + 1)
        return 0.5 * end * float(weights @ (np.sin(t) ** (below - 1) * np.cos(t) ** (above - 1)))
    return integral(math.asin(math.sqrt(below / (below + above * f)))) / integral(0.5 * math.pi)


def joint_test(samples, expected, reference_size=np.inf):
    """Hotelling's test that the means of samples [sample, number] equal `expected`, for all numbers together.

    reference_size: number of samples behind `expected`, if it is also a mean.  Returns chi2 = d . covariance^-1 . d, the
    count of numbers, and the probability of a larger chi2 by chance; nan if there are too few samples for a covariance.
    """
    samples = np.asarray(samples, float)
    n, count = samples.shape
    if n <= 2 * count:
        return float("nan"), count, float("nan")
    difference = samples.mean(0) - expected
    covariance = np.atleast_2d(np.cov(samples.T)) * (1.0 / n + 1.0 / reference_size)
    chi2 = float(difference @ np.linalg.solve(covariance, difference))
    return chi2, count, f_tail(chi2 * (n - count) / (count * (n - 1)), count, n - count)


def verdict(probabilities, level, good, bad):
    """`good` if no probability is below level, `bad` otherwise; undecided if one could not be computed."""
    if any(p < level for p in probabilities):
        return bad
    return good if all(p >= level for p in probabilities) else "undecided: too few samples, make the run longer"


def rms(z):
    return float(np.sqrt(np.mean(np.square(z))))


# ---- plots ----------------------------------------------------------------------------------------------------------

COLORS = ["#1b6ca8", "#d1495b", "#2e8b57", "#e08e0b", "#6a4c93", "#555555"]


def pyplot():
    """matplotlib.pyplot in the style of the examples."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({
        "figure.dpi": 110, "savefig.dpi": 110, "savefig.bbox": "tight", "font.size": 10, "axes.grid": True,
        "grid.alpha": 0.25, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False,
        "axes.prop_cycle": matplotlib.cycler(color=COLORS), "errorbar.capsize": 2, "lines.linewidth": 1.4,
        "lines.markersize": 4,
    })
    return plt


def save(figure, path):
    figure.savefig(path)
    print(f"figure: {path}")


def fail(message):
    sys.exit(f"analyse.py: {message}")
