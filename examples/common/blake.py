"""Rotne-Prager-Yamakawa (RPY) spheres of radius 1 above a no-slip plate at z = 0, in fluid without end: mobilities of forces and
torques, and the sums over periodic images along the plate.  Mobilities are in units of 1/(6 pi viscosity radius).  Positions
are arrays [..., 3]; mobilities [..., component, force or torque]."""

import itertools

import numpy as np

ONE, NORMAL = np.eye(3), np.array([0.0, 0.0, 1.0])


def outer(a, b):
    return a[..., :, None] * b[..., None, :]


def blake(x, source, wall_part_only=False):
    """Velocity at x due to unit forces at `source` (Blake, Proc. Camb. Phil. Soc. 70, 303, 1971)."""
    x, source = np.broadcast_arrays(np.asarray(x, float), np.asarray(source, float))
    mirror = source * np.array([1.0, 1.0, -1.0])
    h = source[..., 2, None, None]
    R = x - mirror
    n = np.linalg.norm(R, axis=-1)[..., None, None]
    G = -(ONE / n + outer(R, R) / n**3)
    if not wall_part_only:
        r = x - source
        m = np.linalg.norm(r, axis=-1)[..., None, None]
        G = G + ONE / m + outer(r, r) / m**3
    # d/dR_k [h R_i/R^3 - (delta_i3/R + R_i R_3/R^3)]
    R3, normal = R[..., 2, None, None], np.broadcast_to(NORMAL, R.shape)
    slope = h * (ONE / n**3 - 3 * outer(R, R) / n**5)
    slope = slope - (-outer(normal, R) + ONE * R3 + outer(R, normal)) / n**3 + 3 * outer(R, R) * R3 / n**5
    return 0.75 * (G + 2 * h * slope * np.array([1.0, 1.0, -1.0]))


def shifted(x, axis, by):
    y = np.array(x, float)
    y[..., axis] += by
    return y


def averaged(f, x, step=0.05):
    """(1 + Laplacian/6) f at x, the average over the surface of a sphere, with differences of fourth order."""
    middle = f(x)
    total = middle
    for axis, (points, weight), sign in itertools.product(range(3), ((1, 4 / 3), (2, -1 / 12)), (-1, 1)):
        total = total + weight * (f(shifted(x, axis, sign * points * step)) - middle) / (6 * step**2)
    return total


def rpy(x, source, wall_part_only=False):
    """Velocity of a sphere at x due to forces on one at `source`, or the plate's part of it."""
    return averaged(lambda s: averaged(lambda y: blake(y, s, wall_part_only), x), source)


def half_curl(velocity, source, step):
    """Half the curl of velocity(source) [..., component, force] with respect to the source: what torques there cause."""
    slope = [sum(weight * sign * velocity(shifted(source, axis, sign * points * step)) / step
                 for points, weight in ((1, 2 / 3), (2, -1 / 12)) for sign in (-1, 1)) for axis in range(3)]
    return 0.5 * np.stack([slope[(axis + 1) % 3][..., (axis + 2) % 3] - slope[(axis + 2) % 3][..., (axis + 1) % 3]
                           for axis in range(3)], axis=-1)


def point_rotlet(x, source, step=0.02):
    """Velocity at the point x due to torques at `source`, in units of 1/(6 pi viscosity radius^2)."""
    return half_curl(lambda s: blake(x, s), source, step)


def rotlet(x, source, wall_part_only=False, step=0.02):
    """The same averaged over the sphere at x.  (An average over the sphere at the source changes nothing.)"""
    return half_curl(lambda s: averaged(lambda y: blake(y, s, wall_part_only), x), source, step)


def lattice(sides, reach):
    """Vectors to the periodic images within `reach`, without the origin; sides: of the box along the plate."""
    most = [int(reach / side) for side in sides]
    n = [(i * sides[0], j * sides[1], 0.0) for i in range(-most[0], most[0] + 1) for j in range(-most[1], most[1] + 1)]
    return np.array([v for v in n if 0 < np.hypot(v[0], v[1]) <= reach])


def beyond(H, sides, reach):
    """What all images beyond `reach` add to the mobility along the plate, at the height H of their forces, by an integral."""
    return 9 * np.pi * H**2 / (sides[0] * sides[1] * reach)


def images(x, source, side, reach=40):
    """Velocity at x due to unit forces on the periodic images of `source` at the same height, in a square of this side;
    reach: sides of those that are summed one by one."""
    total = blake(x, source + lattice((side, side), reach * side)).sum(0)
    tail = beyond(x[2], (side, side), reach * side)
    return total + np.diag([tail, tail, 0.0])


def self_mobility(H, side):
    """Along and across, of a sphere with its images and of one without."""
    at = np.array([0.0, 0.0, H])
    single = 1 + np.diag(rpy(at, at, wall_part_only=True))[[0, 2]]
    return single + np.diag(images(at, at, side))[[0, 2]], single


def expansions(H):
    """Delong et al. (2014), eq. (40), and its counterpart along the plate, which RPY spheres obey exactly."""
    x = 1 / np.asarray(H)
    return 1 - 9 / 16 * x + x**3 / 8 - x**5 / 16, 1 - 9 / 8 * x + x**3 / 2 - x**5 / 8
