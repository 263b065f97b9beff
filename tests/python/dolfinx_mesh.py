"""Reads the exported meshes by DOLFINx's XDMFFile and compares with what the other readers found.

Usage: dolfinx_mesh.py FOLDER      (after test_readers.py, which leaves FOLDER/results.npz)
"""
import sys
from pathlib import Path

import dolfinx
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.io import XDMFFile
from mpi4py import MPI

FAILED = []


def check(what, good):
    print(("ok    " if good else "FAIL  ") + what)
    if not good:
        FAILED.append(what)


def integral(form):
    return fem.assemble_scalar(fem.form(form))


def read(path, name="mesh"):
    with XDMFFile(MPI.COMM_SELF, str(path), "r") as file:
        return file.read_mesh(name=name)


def check_mesh(folder, results):
    """The bilinear mesh with the groups of its cells and of its boundary."""
    mesh = read(folder / "mesh.xdmf")
    count = mesh.topology.index_map(2).size_local
    check(f"mesh.xdmf: {count} cells", count == len(results["cells"]))
    check("mesh.xdmf: area", abs(integral(fem.Constant(mesh, 1.0) * ufl.dx) - 3.0) < 1e-13)
    order = mesh.geometry.input_global_indices
    check("mesh.xdmf: nodes", np.array_equal(mesh.geometry.x[:, :2], results["nodes"][order]))
    with XDMFFile(MPI.COMM_SELF, str(folder / "mesh.xdmf"), "r") as file:
        tags = file.read_meshtags(mesh, "mesh")
    original = np.empty(count, dtype=int)
    original[tags.indices] = tags.values
    check("mesh.xdmf: groups as mesh tags", np.array_equal(original, results["group"][mesh.topology.original_cell_index]))
    mesh.topology.create_connectivity(1, 2)
    mesh.topology.create_connectivity(1, 0)
    with XDMFFile(MPI.COMM_SELF, str(folder / "boundary.xdmf"), "r") as file:
        sides = file.read_meshtags(mesh, "boundary")
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=sides)
    lengths = [integral(fem.Constant(mesh, 1.0) * ds(k)) for k in range(4)]
    check("boundary.xdmf: lengths of left, right, bottom, top", np.allclose(lengths, [1.5, 1.5, 2.0, 2.0], atol=1e-13))


def check_series(folder, results, degree):
    """The mesh of a series, and a result on it through the npz: the integral of the (linear) velocity."""
    mesh = read(folder / f"degree{degree}/series.xdmf")
    points, quads, velocity = (results[f"{key}{degree}"] for key in ("points", "quads", "velocity"))
    name = f"degree{degree}/series.xdmf"
    count = mesh.topology.index_map(2).size_local
    check(f"{name}: {count} cells", count == len(quads))
    check(f"{name}: area", abs(integral(fem.Constant(mesh, 1.0) * ufl.dx) - 3.0) < 1e-12)
    check(f"{name}: points", np.array_equal(mesh.geometry.x[:, :2], points[mesh.geometry.input_global_indices]))
    space = fem.FunctionSpace(mesh, ("Lagrange", 1))
    dofs, nodes = space.dofmap, mesh.geometry.dofmap
    v = fem.Function(space)
    for c in range(count):
        v.x.array[dofs.cell_dofs(c)] = velocity[mesh.geometry.input_global_indices, 0][nodes.links(c)]
    # velocity_1 = 1 + 2 x - y + 1e4 t on [0, 2] x [0, 1.5], at t = 3e-4: mean value 1 + 2 - .75 + 3
    check(f"{name}: integral of velocity_1", abs(integral(v * ufl.dx) - 3.0 * 5.25) < 1e-11)


def main(folder):
    results = np.load(folder / "results.npz")
    check_mesh(folder, results)
    for degree in range(4):
        check_series(folder, results, degree)
    print(f"DOLFINx {dolfinx.__version__}: {len(FAILED)} failed")
    return 1 if FAILED else 0


if __name__ == "__main__":
    assert len(sys.argv) == 2, __doc__
    sys.exit(main(Path(sys.argv[1])))
