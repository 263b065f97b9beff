"""Compares the smooth box as exported by dgmpm with the spectral reference in tests/data, pointwise and by norms.

The reference displacement and velocity are cosine-sine series (the walls are mirrors), known at 33 x 33 nodes to
1e-11: they are evaluated here at the Gauss points of every exported cell, whatever the mesh.

usage: compare_box.py RUN_OR_EXPORT [--limit 1e-3] [--time 1.5e-4]

Prints sqrt(int |F-F_ex|^2 + |v-v_ex|^2/c_p^2) / sqrt(int |F_ex-1|^2 + |v_ex|^2/c_p^2), and the relative errors of
some L2 norms; exit code 1 if the first is above the limit.
"""

import argparse
import json
import sys
from pathlib import Path

import numpy as np

import compare
import exported
import impact

DATA = Path(__file__).resolve().parents[1] / "data"


class MirrorSeries:
    """A vector field on [0,1]^2 with frictionless walls on all sides, from its values at equidistant nodes.

    Component 0 is a series in sin(k pi x) cos(l pi y), component 1 in cos(k pi x) sin(l pi y).
    """

    def __init__(self, values):
        """values[component, ix, iy] at n x n equidistant nodes, walls included."""
        n = values.shape[1] - 1
        k, s = np.arange(n + 1), np.linspace(0.0, 1.0, n + 1)
        self.frequency = np.pi * k
        cos_inverse = np.linalg.inv(np.cos(np.pi * np.outer(s, k)))
        sin_inverse = np.zeros((n + 1, n + 1))
        sin_inverse[1:n, 1:n] = np.linalg.inv(np.sin(np.pi * np.outer(s[1:n], k[1:n])))
        self.coefficients = sin_inverse @ values[0] @ cos_inverse.T, cos_inverse @ values[1] @ sin_inverse.T

    def __call__(self, x):
        """Value [..., component] and gradient [..., component, direction] at x[..., 2]."""
        shape, x = x.shape[:-1], x.reshape(-1, 2)
        phase = x[:, :, None] * self.frequency
        c, s = np.cos(phase), np.sin(phase)
        value, gradient = np.empty((len(x), 2)), np.empty((len(x), 2, 2))
        factors = ((s, c, 1.0), (c, s, -1.0))  # along axis 0: the factor itself and (up to the sign) its derivative
        for i, (own, other, sign) in enumerate(factors):
            a, w = self.coefficients[i], self.frequency
            value[:, i] = np.einsum("pk,kl,pl->p", own[:, 0], a, other[:, 1], optimize=True)
            gradient[:, i, 0] = np.einsum("pk,kl,pl->p", sign * w * other[:, 0], a, other[:, 1], optimize=True)
            gradient[:, i, 1] = np.einsum("pk,kl,pl->p", own[:, 0], a, -sign * w * own[:, 1], optimize=True)
        return value.reshape(*shape, 2), gradient.reshape(*shape, 2, 2)


def box_reference():
    """The reference displacement and velocity at 1.5e-4 s."""
    data = np.load(DATA / "smooth_box_field.npz")
    return MirrorSeries(data["u"]), MirrorSeries(data["v"])


def relative_error(x, area, f, v):
    """The standard error measure of sampled F and v against the reference."""
    u_exact, v_exact = box_reference()
    f_exact = np.eye(2) + u_exact(x)[1]
    v_exact = v_exact(x)[0]

    def size(df, dv):
        return np.sqrt(
            np.sum(area * (np.sum(df**2, axis=(-1, -2)) + np.sum(dv**2, axis=-1) / impact.PRESSURE_SPEED**2))
        )

    return size(f - f_exact, v - v_exact) / size(f_exact - np.eye(2), v_exact)


def norms(area, f, v):
    """L2 norms under the names of smooth_box.json."""
    p, sigma = impact.piola(f), impact.cauchy(f)
    fields = {"v1": v[..., 0], "v2": v[..., 1], "P11": p[..., 0, 0], "P12": p[..., 0, 1], "s11": sigma[..., 0, 0]}
    return {f"L2/{name}": float(np.sqrt(np.sum(area * value**2))) for name, value in fields.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("--limit", type=float, default=1e-3)
    parser.add_argument("--time", type=float, default=impact.BOX.end)
    args = parser.parse_args()

    time, path = exported.step_at(args.run, args.time)
    if abs(time - args.time) > 1e-9 * args.time:
        sys.exit(f"{args.run}: the nearest exported step is at {time!r} s, not {args.time!r} s")
    grid = exported.read_grid(path)
    xi, w = compare.gauss_rule(grid.degree + 3)
    x, area = grid.map(xi)
    area = area * w
    f = grid.evaluate("deformation", xi).reshape(*area.shape, 3, 3)[..., :2, :2]
    v = grid.evaluate("velocity", xi)[..., :2]

    reference = json.loads((DATA / "smooth_box.json").read_text())["values"]
    for name, value in norms(area, f, v).items():
        print(f"{name} {value:.8e} relative_error {value / reference[name] - 1:.2e}")
    error = relative_error(x, area, f, v)
    print(f"relative_error {error:.4e}")
    if not error <= args.limit:
        sys.exit(f"above the limit {args.limit:g}")


if __name__ == "__main__":
    main()
