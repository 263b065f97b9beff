"""The impact by displacement finite elements in DOLFINx, on a mesh that dgmpm exported.

Reads quadrilaterals from mesh.xdmf by XDMFFile, so it also shows that DOLFINx accepts the file.
Quadratic elements, mass lumped on the nodes (Gauss-Lobatto), velocity Verlet. `--viscosity` as in skfem_impact.py,
with h half the smallest cell length. Needs DOLFINx 0.5 (Debian 12: python3-dolfinx-real under /usr/bin/python3).

usage: dolfinx_impact.py MESH.xdmf OUT.npz [--name mesh] [--viscosity 0.05] [--end 3e-4]
"""

import argparse
import logging
import time
from functools import partial

import numpy as np
import ufl
from dolfinx import fem
from dolfinx.io import XDMFFile
from mpi4py import MPI

import impact


def read_mesh(path, name):
    """The mesh of an XDMF file by the name of its grid, and its smallest cell length (area over longest edge)."""
    with XDMFFile(MPI.COMM_SELF, path, "r") as file:
        mesh = file.read_mesh(name=name)
    tdim = mesh.topology.dim
    cells = mesh.topology.index_map(tdim).size_local
    corners = mesh.geometry.x[np.array([mesh.geometry.dofmap.links(c) for c in range(cells)])][..., :2]
    ring = corners[:, [0, 1, 3, 2]]  # DOLFINx counts corners as a tensor product
    after = np.roll(ring, -1, axis=1)
    area = abs(np.sum(ring[..., 0] * after[..., 1] - ring[..., 1] * after[..., 0], axis=1)) / 2
    return mesh, np.min(area / np.linalg.norm(after - ring, axis=-1).max(axis=1))


def stress(f):
    """P of the law in impact.py, as a UFL expression."""
    j = ufl.det(f)
    a = impact.MU * j ** (-2.0 / 3)
    b = impact.KAPPA * (j - 1) - a * (ufl.inner(f, f) + 1) / (3 * j)
    cofactor = ufl.as_matrix(((f[1, 1], -f[1, 0]), (-f[0, 1], f[0, 0])))
    return a * f + b * cofactor


def solve(problem, mesh, length, viscosity, end):
    """Runs the problem; returns the functions (u, v) at the end."""
    space = fem.VectorFunctionSpace(mesh, ("Lagrange", 2))
    u, v, w = fem.Function(space), fem.Function(space), ufl.TestFunction(space)
    # General quadrilaterals get a further margin.
    steps, dt, eta = impact.explicit_stepping(length, viscosity, end, safety=0.7)
    nodes = ufl.dx(metadata={"quadrature_rule": "GLL", "quadrature_degree": 2})
    inner = ufl.dx(metadata={"quadrature_degree": 4})
    f = ufl.Identity(2) + ufl.grad(u)
    force = fem.form(-ufl.inner(stress(f) + eta * ufl.grad(v), ufl.grad(w)) * inner)
    ones = fem.Function(space)
    ones.x.array[:] = 1.0
    mass = fem.petsc.assemble_vector(fem.form(impact.DENSITY * ufl.inner(ones, w) * nodes)).array.copy()
    if mass.min() <= 0:
        raise SystemExit("the lumped mass is not positive: the Gauss-Lobatto rule is not on the nodes")

    fixed = []
    for axis, place in problem.walls():
        dofs = fem.locate_dofs_geometrical(space, partial(impact.on_side, axis=axis, place=place))
        fixed.append(2 * dofs + axis)
    fixed = np.concatenate(fixed)

    work = fem.petsc.create_vector(force)

    def acceleration():
        with work.localForm() as local:
            local.set(0.0)
        fem.petsc.assemble_vector(work, force)
        a = work.array / mass
        a[fixed] = 0.0
        return a

    v.interpolate(lambda x: np.stack(problem.velocity(x[0], x[1])))
    v.x.array[fixed] = 0.0
    a = acceleration()
    for _ in range(steps):
        v.x.array[:] += dt / 2 * a
        u.x.array[:] += dt * v.x.array
        a = acceleration()
        v.x.array[:] += dt / 2 * a
    return u, v


def samples(u, v, n=6):
    """Positions, areas, F and v at n x n Gauss points of every cell."""
    mesh = u.function_space.mesh
    s, w = np.polynomial.legendre.leggauss(n)
    s, w = (s + 1) / 2, w / 2
    points = np.stack(np.meshgrid(s, s), axis=-1).reshape(-1, 2)
    weights = np.outer(w, w).ravel()
    x = ufl.SpatialCoordinate(mesh)
    cells = np.arange(mesh.topology.index_map(mesh.topology.dim).size_local, dtype=np.int32)

    def evaluate(expression, *shape):
        return fem.Expression(expression, points).eval(cells).reshape(-1, *shape)

    area = evaluate(abs(ufl.JacobianDeterminant(mesh))) * np.tile(weights, len(cells))
    return evaluate(x, mesh.geometry.dim)[:, :2], area, evaluate(ufl.Identity(2) + ufl.grad(u), 2, 2), evaluate(v, 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("out")
    parser.add_argument("--name", default="mesh", help="name of the grid in the file")
    parser.add_argument("--viscosity", type=float, default=0.05)
    parser.add_argument("--end", type=float, default=impact.IMPACT.end)
    args = parser.parse_args()

    logging.disable(logging.INFO)  # the compiler's command lines
    start = time.perf_counter()
    mesh, length = read_mesh(args.mesh, args.name)
    u, v = solve(impact.IMPACT, mesh, length, args.viscosity, args.end)
    impact.save_blocks(args.out, args.end, *samples(u, v))
    print(f"DOLFINx: {args.mesh} to {args.end:g} s in {time.perf_counter() - start:.1f} s, wrote {args.out}")


if __name__ == "__main__":
    main()
