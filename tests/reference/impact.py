"""What the reference solvers and the comparisons share: problems, law, block averages. Needs numpy only.

Everything is stated a second time here, on purpose: nothing is taken from the program that is tested.
Plane strain, F33 = 1; tensors are arrays [..., 2, 2].
"""

from dataclasses import dataclass

import numpy as np

YOUNG, POISSON, DENSITY = 2e11, 0.3, 7800.0
KAPPA = YOUNG / (3 * (1 - 2 * POISSON))
MU = YOUNG / (2 * (1 + POISSON))
PRESSURE_SPEED = np.sqrt((KAPPA + 4 * MU / 3) / DENSITY)


@dataclass(frozen=True)
class Problem:
    """A square [0, size]^2 of the steel above on frictionless walls, set in motion at t = 0."""

    size: float
    end: float
    rollers: tuple  # of left, right, bottom, top: no normal velocity, no shear; the other sides are free
    velocity: object  # velocity(x, y) at t = 0, a pair

    def walls(self):
        """(axis, place) of each roller: the side where that coordinate has that value, held in that direction."""
        sides = {"left": (0, 0.0), "right": (0, self.size), "bottom": (1, 0.0), "top": (1, self.size)}
        return [sides[side] for side in self.rollers]


IMPACT = Problem(3.0, 3e-4, ("left", "bottom"), lambda x, y: (-200.0 + 0 * x, 0 * x))
"""The paper's impact: the left side is the wall, the bottom the axis of symmetry."""

BOX = Problem(
    1.0,
    1.5e-4,
    ("left", "right", "bottom", "top"),
    lambda x, y: (300 * np.sin(np.pi * x) * np.cos(np.pi * y), -150 * np.cos(np.pi * x) * np.sin(np.pi * y)),
)
"""A smooth nonlinear motion in a closed box."""


def on_side(x, axis, place):
    """Whether points x[axis, point] lie on the line where that coordinate is `place`."""
    return np.isclose(x[axis], place)


def piola(f):
    """P = dW/dF of W = kappa/2 (J-1)^2 + mu/2 (J^(-2/3) (F:F + 1) - 3)."""
    j = f[..., 0, 0] * f[..., 1, 1] - f[..., 0, 1] * f[..., 1, 0]
    cofactor = np.empty_like(f)
    cofactor[..., 0, 0], cofactor[..., 0, 1] = f[..., 1, 1], -f[..., 1, 0]
    cofactor[..., 1, 0], cofactor[..., 1, 1] = -f[..., 0, 1], f[..., 0, 0]
    invariant = np.sum(f * f, axis=(-1, -2)) + 1
    a = MU * j ** (-2 / 3)
    b = KAPPA * (j - 1) - a * invariant / (3 * j)
    return a[..., None, None] * f + b[..., None, None] * cofactor


def energy(f):
    """W, see `piola`."""
    j = np.linalg.det(f)
    return KAPPA / 2 * (j - 1) ** 2 + MU / 2 * (j ** (-2 / 3) * (np.sum(f * f, axis=(-1, -2)) + 1) - 3)


def cauchy(f):
    """sigma = P F^T / J."""
    return piola(f) @ np.swapaxes(f, -1, -2) / np.linalg.det(f)[..., None, None]


def block_averages(x, weight, value, size=3.0, blocks=30):
    """Means of a sampled field over blocks x blocks equal squares of [0, size]^2, as an array [iy, ix].

    x[..., 2] are the samples, weight[...] their areas; a sample counts for the block that holds it.
    """
    index = np.clip((np.asarray(x) * (blocks / size)).astype(int), 0, blocks - 1)
    place = (index[..., 1] * blocks + index[..., 0]).ravel()
    area = np.bincount(place, np.ravel(weight), blocks**2)
    if np.any(area == 0):
        raise ValueError(f"{np.sum(area == 0)} of {blocks**2} blocks hold no sample: sample more finely")
    return (np.bincount(place, np.ravel(weight * value), blocks**2) / area).reshape(blocks, blocks)


def relative_l1(a, b):
    """sum|a - b| / sum|b|."""
    return float(np.sum(np.abs(a - b)) / np.sum(np.abs(b)))


def explicit_stepping(length, viscosity, end, safety=0.8):
    """(steps, dt, eta) of central differences on lumped biquadratic elements of the smallest length `length`.

    eta is the viscosity in Pa s: P += eta dF/dt with eta = viscosity rho0 c_p h, h = length / 2 between nodes. The
    largest frequency is sqrt(24) c / length per direction; viscosity, taken explicitly, shortens the step to
    2 / omega (sqrt(1 + z^2) - z). `safety` leaves room for waves that compression quickens.
    """
    omega = np.sqrt(2 * 24) * PRESSURE_SPEED / length
    z = viscosity * (length / 2) * omega / (2 * PRESSURE_SPEED)
    steps = int(np.ceil(end / (safety * 2 / omega * (np.sqrt(1 + z**2) - z))))
    return steps, end / steps, viscosity * DENSITY * PRESSURE_SPEED * length / 2


def save_blocks(path, time, x, weight, f, v):
    """Writes block averages of Cauchy sigma11 and v1 under the names that `compare.py` reads."""
    np.savez(
        path,
        time=time,
        s11=block_averages(x, weight, cauchy(f)[..., 0, 0]),
        v1=block_averages(x, weight, v[..., 0]),
    )
