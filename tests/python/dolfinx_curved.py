"""Reads the mesh of a ring with curved cells (radii 30 and 40 mm) by DOLFINx, as `dgmpm mesh ring.msh --out ring.xdmf` has written it.

Usage: dolfinx_curved.py RING.XDMF      Exits with 1 where area, length of the boundary or groups are not those of the ring.
"""

import logging
import sys

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


def main(path):
    logging.disable(logging.INFO)  # the compiler's command lines
    with XDMFFile(MPI.COMM_WORLD, path, "r") as file:
        mesh = file.read_mesh()
        mesh.topology.create_connectivity(1, 2)
        cells, facets = file.read_meshtags(mesh, "cell_tags"), file.read_meshtags(mesh, "facet_tags")
    one = fem.Constant(mesh, 1.0)
    # The measures of a map of degree 2 are polynomials of degree 3 in the cells, and roots of degree 2 along the edges.
    area = fem.assemble_scalar(fem.form(one * ufl.dx(metadata={"quadrature_degree": 3})))
    length = fem.assemble_scalar(fem.form(one * ufl.ds(metadata={"quadrature_degree": 12})))
    # 32 arcs of 11 degrees by parabolas: Simpson's rule is 3e-6 off (a polygon .6 %).
    check("area", abs(area / (np.pi * (0.04**2 - 0.03**2)) - 1) < 5e-6)
    check("length of the boundary", abs(length / (2 * np.pi * 0.07) - 1) < 5e-6)
    check("all cells and all edges of the boundary are in a group", (len(cells.values), len(facets.values)) == (64, 64))
    return 1 if FAILED else 0


if __name__ == "__main__":
    assert len(sys.argv) == 2, __doc__
    sys.exit(main(sys.argv[1]))
