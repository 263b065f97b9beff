"""Two vibrations of docs/validation.md by displacement finite elements in scikit-fem: a reference of another kind.

Biquadratic elements, implicit midpoint rule with Newton's method, plane strain: no flux, no material point, no limit
of the step.

plate: the beryllium plate, neo-Hookean, at its full amplitude: the period of the middle
flag:  the beam of Turek and Hron's test CSM3, St. Venant-Kirchhoff: lowest place of the tip and the time there and back

It prints:
plate, 24 x 4 elements, 400 / 800 / 1600 steps: 3.00021e-5 / 2.99958e-5 / 2.99943e-5 s, which
    tends to 2.9994e-5 s; 48 x 8, 800 steps: 2.99967e-5 s
plate, --share 1e-3, 24 x 4, 800 steps: 2.8919e-5 s (the linear problem has 2.8917e-5 s)
flag, 35 x 2 elements, 400 / 1000 steps: u2 -.129320 / -.129346 m, back at .9084 / .9097 s;
    70 x 4, 500 / 1000 steps: -.129551 / -.129573 m, .9115 / .9106 s

usage: vibration.py plate|flag [--cells 24 4] [--steps 1200] [--share 1.0 (of the amplitude of the plate)]
"""

import argparse

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.sparse.linalg import splu
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, LinearForm, MeshQuad

ONE = np.eye(2)[:, :, None, None]


def saint_venant_kirchhoff(young, poisson):
    """F -> P = F (lambda tr(E) 1 + 2 mu E), E = (F^T F - 1)/2; tensor indices in front."""
    lam, mu = young * poisson / ((1 + poisson) * (1 - 2 * poisson)), young / (2 * (1 + poisson))

    def stress(f):
        e = (np.einsum("ki...,kj...->ij...", f, f) - ONE) / 2
        return np.einsum("ik...,kj...->ij...", f, lam * (e[0, 0] + e[1, 1]) * ONE + 2 * mu * e)

    return stress


def neo_hookean(young, poisson):
    """F -> P = dW/dF of W = kappa/2 (J-1)^2 + mu/2 (J^(-2/3) (F:F + 1) - 3)."""
    kappa, mu = young / (3 * (1 - 2 * poisson)), young / (2 * (1 + poisson))

    def stress(f):
        j = f[0, 0] * f[1, 1] - f[0, 1] * f[1, 0]
        cofactor = np.stack([np.stack([f[1, 1], -f[1, 0]]), np.stack([-f[0, 1], f[0, 0]])])
        a = mu * j ** (-2 / 3)
        return a * f + (kappa * (j - 1) - a * ((f * f).sum(axis=(0, 1)) + 1) / (3 * j)) * cofactor

    return stress


def tangent(stress, f):
    """dP/dF at F, [i, j, k, m, ...], by complex steps: without a difference, hence to rounding."""
    out = np.empty((2, 2, 2, 2, *f.shape[2:]))
    for k, m in np.ndindex(2, 2):
        step = np.zeros((2, 2, 1, 1), complex)
        step[k, m] = 1e-20j
        out[:, :, k, m] = stress(f + step).imag / 1e-20
    return out


class Body:
    """A mesh with its law, density (kg/m^3), force per mass (m/s^2), and the facets that are held."""

    def __init__(self, mesh, stress, density, gravity=0.0, held=None):
        self.basis, self.stress = Basis(mesh, ElementVector(ElementQuad2()), intorder=5), stress
        self.mass = BilinearForm(lambda u, v, _: density * (u[0] * v[0] + u[1] * v[1])).assemble(self.basis).tocsc()
        self.load = LinearForm(lambda v, _: density * gravity * v[1]).assemble(self.basis)
        fixed = [] if held is None else self.basis.get_dofs(mesh.facets_satisfying(held, boundaries_only=True)).all()
        self.free = np.setdiff1d(np.arange(self.basis.N), fixed)

    def force(self, u):
        """int P : grad w dX, and its derivative."""
        field = self.basis.interpolate(u)
        f = field.grad + ONE
        stress, slope = self.stress(f), tangent(self.stress, f)
        vector = LinearForm(lambda v, _: np.einsum("ij...,ij...", stress, v.grad)).assemble(self.basis)
        form = BilinearForm(lambda u, v, _: np.einsum("ijkl...,kl...,ij...", slope, u.grad, v.grad))
        return vector, form.assemble(self.basis).tocsc()

    def run(self, v, dt, steps, dofs):
        """t and u of some degrees of freedom, [1 + dof, step], by the implicit midpoint rule from u = 0."""
        u, free, rows = self.basis.zeros(), self.free, [np.zeros(1 + len(dofs))]
        for step in range(steps):
            middle = u + dt / 2 * v
            for _ in range(20):
                force, slope = self.force(middle)
                rest = self.mass @ ((middle - u) * 2 / dt - v) * 2 / dt + force - self.load
                change = splu((4 / dt**2 * self.mass + slope)[free][:, free].tocsc()).solve(rest[free])
                middle[free] -= change
                if np.abs(change).max() < 1e-9 * np.abs(middle).max():
                    break
            else:
                raise ArithmeticError(f"Newton's method does not converge in step {step + 1}")
            u, v = 2 * middle - u, (middle - u) * 4 / dt - v
            rows.append([(step + 1) * dt, *u[dofs]])
        return np.array(rows).T

    def dofs(self, x, y):
        """The two degrees of freedom at a node of the mesh."""
        return np.flatnonzero(np.hypot(self.basis.doflocs[0] - x, self.basis.doflocs[1] - y) < 1e-9)


def frequency(t, u, guess):
    """w of the best a sin(w t) + b cos(w t) + c t + d, rad/s."""

    def rest(w):
        waves = np.stack([np.sin(w * t), np.cos(w * t), t / t[-1], np.ones_like(t)], axis=-1)
        return ((waves @ np.linalg.lstsq(waves, u, rcond=None)[0] - u) ** 2).sum()

    return minimize_scalar(rest, bounds=(0.9 * guess, 1.1 * guess), method="bounded", options={"xatol": 1e-7 * guess}).x


def plate(cells, steps, share):
    """Period, s, of the middle over 94 us."""
    mesh = MeshQuad.init_tensor(np.linspace(0, 0.06, cells[0] + 1), np.linspace(0, 0.01, cells[1] + 1))
    body = Body(mesh, neo_hookean(3.182656736e11, 0.053897062), 1845.0)
    x, v = body.basis.doflocs[0], body.basis.zeros()
    s = 78.834 * x
    mode = 10.233783 * (56.6368 * (np.sinh(s) + np.sin(s)) - 57.6455 * (np.cosh(s) + np.cos(s)))
    up = body.basis.get_dofs(elements=np.arange(mesh.nelements)).all("u^2")
    v[up] = share * mode[up]
    t, _, u = body.run(v, 9.4e-5 / steps, steps, body.dofs(0.03, 0.005))
    print(f"plate {cells} {steps} steps, share {share}: period {2 * np.pi / frequency(t, u, 217284):.6e} s", flush=True)


def flag(cells, steps):
    """Lowest u of the tip, m, in both directions, and the time, s, when it comes back."""
    unit = MeshQuad.init_tensor(np.linspace(0, 1, cells[0] + 1), np.linspace(-0.01, 0.01, cells[1] + 1))
    along, y = unit.p
    root = np.sqrt(0.05**2 - y**2)
    mesh = MeshQuad(np.stack([root + (0.4 - root) * along, y]), unit.t)
    body = Body(mesh, saint_venant_kirchhoff(1.4e6, 0.4), 1000.0, -2.0, lambda x: np.hypot(x[0], x[1]) < 0.0501)
    t, *tip = body.run(body.basis.zeros(), 1.0 / steps, steps, body.dofs(0.4, 0.0))
    for axis, u in enumerate(tip):
        back = (t > 0.7) & (t < 0.99)
        low, high = turn(t, u, np.argmin(u)), turn(t, u, np.flatnonzero(back)[np.argmax(u[back])])
        print(
            f"flag {cells} {steps} steps: u{axis + 1} lowest {low[1]:.6f} m at {low[0]:.5f} s, back {high[1]:.6f} m at {high[0]:.5f} s",
            flush=True,
        )


def turn(t, u, k):
    """Time and value of the top of the parabola through three rows."""
    a, b, c = u[k - 1 : k + 2]
    move = (a - c) / (2 * (a - 2 * b + c))
    return t[k] + move * (t[1] - t[0]), b - (a - c) * move / 4


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("problem", choices=["plate", "flag"])
    parser.add_argument("--cells", type=int, nargs=2, default=[24, 4])
    parser.add_argument("--steps", type=int, default=1200)
    parser.add_argument("--share", type=float, default=1.0)
    args = parser.parse_args()
    plate(args.cells, args.steps, args.share) if args.problem == "plate" else flag(args.cells, args.steps)


if __name__ == "__main__":
    main()
