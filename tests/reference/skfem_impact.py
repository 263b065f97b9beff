"""The impact (or the smooth box) by displacement finite elements in scikit-fem: a reference of another kind.

Biquadratic elements, mass lumped by Simpson's rule, velocity Verlet; unlike dgmpm it has a continuous
displacement as its unknown, so F is a gradient by construction and no flux is chosen. `--viscosity b` adds
b rho0 c_p h dF/dt to the stress, with h the spacing of nodes: it damps the ringing behind the front.

Relative L1 of the block averages at 3e-4 s against the finite-volume reference of tests/data (sigma11, v1):
60 cells b=0: 1.3 %, 1.5 %;  60 cells b=.05: 0.9 %, 1.2 %;  60 cells b=.1: 1.8 %, 2.5 %;
90 cells b=.05: 0.5 %, 0.7 %;  120 cells b=.05: 0.3 %, 0.5 %;  120 cells b=0: 0.5 %, 0.6 %.

usage: skfem_impact.py OUT.npz [--cells 60] [--viscosity 0.05] [--end 3e-4]
"""

import argparse
import time
from functools import partial

import numpy as np
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, LinearForm, MeshQuad

import impact

# Simpson's rule on [0,1]: its points are the nodes of quadratic elements, hence a diagonal mass.
SIMPSON = np.array([0.0, 0.5, 1.0]), np.array([1.0, 4.0, 1.0]) / 6


@BilinearForm
def inertia(v, w, _):
    return impact.DENSITY * (v[0] * w[0] + v[1] * w[1])


@LinearForm
def internal_force(w, fields):
    """- integral of P : grad w; scikit-fem keeps tensor indices in front, the law behind."""
    stress = np.moveaxis(impact.piola(deformation(fields.u)), (-2, -1), (0, 1))
    stress += fields.viscosity * fields.v.grad
    return -np.einsum("ia...,ia...", stress, w.grad)


def deformation(u):
    """F = 1 + Grad u, as an array [..., 2, 2]."""
    return np.eye(2) + np.moveaxis(u.grad, (0, 1), (-2, -1))


def solve(problem, cells, viscosity=0.0, end=None):
    """Runs a problem on cells x cells elements; returns the basis and the nodal vectors (u, v) at the end."""
    line = np.linspace(0.0, problem.size, cells + 1)
    mesh = MeshQuad.init_tensor(line, line)
    element = ElementVector(ElementQuad2())
    points, weights = SIMPSON
    rule = np.stack([p.ravel() for p in np.meshgrid(points, points)]), np.outer(weights, weights).ravel()
    mass = inertia.assemble(Basis(mesh, element, quadrature=rule)).diagonal()
    basis = Basis(mesh, element, intorder=4)

    steps, dt, eta = impact.explicit_stepping(problem.size / cells, viscosity, end or problem.end)

    fixed = []
    for axis, place in problem.walls():
        facets = mesh.facets_satisfying(partial(impact.on_side, axis=axis, place=place), boundaries_only=True)
        fixed.append(basis.get_dofs(facets).all(f"u^{axis + 1}"))
    fixed = np.concatenate(fixed)

    def acceleration(u, v):
        force = internal_force.assemble(basis, u=basis.interpolate(u), v=basis.interpolate(v), viscosity=eta)
        force[fixed] = 0.0
        return force / mass

    u = basis.zeros()
    v = np.where(basis_component(basis) == 0, *problem.velocity(*basis.doflocs))
    v[fixed] = 0.0
    a = acceleration(u, v)
    for _ in range(steps):
        v += dt / 2 * a
        u += dt * v
        a = acceleration(u, v)
        v += dt / 2 * a
    return basis, u, v


def basis_component(basis):
    """0 or 1 for each degree of freedom: the direction it moves in."""
    component = np.ones(basis.N, dtype=int)
    component[basis.get_dofs(elements=np.arange(basis.mesh.nelements)).all("u^1")] = 0
    return component


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out")
    parser.add_argument("--cells", type=int, default=60)
    parser.add_argument("--viscosity", type=float, default=0.05)
    parser.add_argument("--end", type=float, default=impact.IMPACT.end)
    args = parser.parse_args()

    start = time.perf_counter()
    basis, u, v = solve(impact.IMPACT, args.cells, args.viscosity, args.end)
    x = np.moveaxis(np.asarray(basis.global_coordinates()), 0, -1)
    velocity = np.moveaxis(np.asarray(basis.interpolate(v)), 0, -1)
    impact.save_blocks(args.out, args.end, x, basis.dx, deformation(basis.interpolate(u)), velocity)
    seconds = time.perf_counter() - start
    print(f"scikit-fem: {args.cells}x{args.cells} Q2 to {args.end:g} s in {seconds:.1f} s, wrote {args.out}")


if __name__ == "__main__":
    main()
