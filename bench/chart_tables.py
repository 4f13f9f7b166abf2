"""Tables of measurements for the scripts that draw them."""
import csv
import os


def number(text):
    try:
        return float(text)
    except ValueError:
        return text


def read(folder, name):
    """Rows of folder/name.csv as dictionaries, with numbers as floats; empty if there is no such file."""
    path = os.path.join(folder, name + ".csv")
    if not os.path.exists(path):
        return []
    with open(path) as f:
        return [{k: number(v) for k, v in row.items()} for row in csv.DictReader(line for line in f if not line.startswith("#"))]


def groups(rows, *keys):
    """Groups of rows with equal values of `keys`, in order of first appearance: (values, rows); for a single key, the value itself."""
    found = {}
    for row in rows:
        found.setdefault(tuple(row[k] for k in keys) if len(keys) > 1 else row[keys[0]], []).append(row)
    return found.items()


def label_short_axis(axis):
    """Labels 1, 2, 3, 5, 10 ... on a logarithmic matplotlib axis that covers two decades or less, for which powers of ten are too few."""
    from matplotlib import ticker
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 3, 5)))
    axis.set_major_formatter(ticker.FormatStrFormatter("%g"))
    axis.set_minor_formatter(ticker.NullFormatter())
