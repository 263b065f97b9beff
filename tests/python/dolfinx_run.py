"""Reads the exported mesh and series of a run by DOLFINx's XDMFFile and integrates a result on them.

Usage: dolfinx_run.py RUN      (after exported_run.py, which leaves RUN/export/results.npz)
"""
import logging
import sys
from pathlib import Path

import dolfinx
import numpy as np
import ufl
from dolfinx import fem
from dolfinx.io import XDMFFile
from dolfinx_mesh import FAILED, check, integral, read
from mpi4py import MPI


def quadrature(points, quads, values):
    """Area, and the integral of bilinear `values`, over bilinear quadrilaterals: exact by 2 x 2 Gauss points."""
    s = np.array([0.5 - np.sqrt(1 / 12), 0.5 + np.sqrt(1 / 12)])
    x, total = points[quads], np.zeros(2)
    for r in s:
        for t in s:
            shape = np.array([(1 - r) * (1 - t), r * (1 - t), r * t, (1 - r) * t])
            x_r = np.einsum("k,cki->ci", [t - 1, 1 - t, t, -t], x)
            x_t = np.einsum("k,cki->ci", [r - 1, -r, r, 1 - r], x)
            weight = (x_r[:, 0] * x_t[:, 1] - x_r[:, 1] * x_t[:, 0]) / 4
            total += weight.sum(), weight @ (values[quads] @ shape)
    return total


def check_cells(name, mesh, points, quads):
    """Counts, coordinates and area; returns the exact area."""
    area = quadrature(points, quads, np.ones(len(points)))[0]
    check(f"{name}: {len(quads)} cells", mesh.topology.index_map(2).size_local == len(quads))
    check(f"{name}: points", np.array_equal(mesh.geometry.x[:, :2], points[mesh.geometry.input_global_indices]))
    # No rounding of an integral over a few thousand cells exceeds this.
    check(f"{name}: area", abs(integral(fem.Constant(mesh, 1.0) * ufl.dx) / area - 1) < 1e-12)
    return area


def check_groups(export, mesh, name, attribute, dimension, measure):
    """The groups of cells or edges as mesh tags: their measures add up to that of the whole."""
    mesh.topology.create_connectivity(1, 2)
    mesh.topology.create_connectivity(1, 0)
    with XDMFFile(MPI.COMM_SELF, str(export / name), "r") as file:
        tags = file.read_meshtags(mesh, attribute)
    over = measure(domain=mesh, subdomain_data=tags)
    one = fem.Constant(mesh, 1.0)
    parts, whole = [integral(one * over(int(k))) for k in np.unique(tags.values)], integral(one * measure(domain=mesh))
    check(f"{name}: {len(parts)} groups are the whole", tags.dim == dimension and abs(sum(parts) / whole - 1) < 1e-12)


def check_velocity(mesh, results):
    """The last velocity_1 of the series: its integral by DOLFINx and by numpy."""
    space = fem.FunctionSpace(mesh, ("Lagrange", 1))
    v, nodal = fem.Function(space), results["velocity"][mesh.geometry.input_global_indices, 0]
    for c in range(len(results["quads"])):
        v.x.array[space.dofmap.cell_dofs(c)] = nodal[mesh.geometry.dofmap.links(c)]
    expected = quadrature(results["points"], results["quads"], results["velocity"][:, 0])[1]
    size = quadrature(results["points"], results["quads"], abs(results["velocity"][:, 0]))[1]
    check("series.xdmf: integral of velocity_1", abs(integral(v * ufl.dx) - expected) < 1e-12 * size)


def main(run):
    logging.disable(logging.INFO)  # the compiler's command lines
    export = run / "export"
    results = np.load(export / "results.npz")
    mesh = read(export / "mesh.xdmf")
    check_cells("mesh.xdmf", mesh, results["nodes"], results["cells"])
    check_groups(export, mesh, "mesh.xdmf", "mesh", 2, ufl.dx)
    check_groups(export, mesh, "boundary.xdmf", "boundary", 1, ufl.ds)
    series = read(export / "series.xdmf")
    check_cells("series.xdmf", series, results["points"], results["quads"])
    check_velocity(series, results)
    print(f"DOLFINx {dolfinx.__version__}, {run.name}: {len(FAILED)} failed")
    return 1 if FAILED else 0


if __name__ == "__main__":
    assert len(sys.argv) == 2, __doc__
    sys.exit(main(Path(sys.argv[1])))
