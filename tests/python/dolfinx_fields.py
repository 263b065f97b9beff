"""Writes velocity and displacement on a mesh of quadrilaterals by DOLFINx, at two times, into fields.xdmf.
The test reads them as the start of a run.

Usage: dolfinx_fields.py FOLDER
"""
import sys
from pathlib import Path

import dolfinx
from dolfinx import fem, io, mesh
from mpi4py import MPI


def space(domain):
    """Continuous vectors of degree 1, under the names that versions of DOLFINx have for them."""
    if hasattr(fem, "functionspace"):
        return fem.functionspace(domain, ("Lagrange", 1, (2,)))
    return fem.VectorFunctionSpace(domain, ("Lagrange", 1))


def main(folder):
    corners = [[-0.1, -0.1], [1.1, 0.6]]
    domain = mesh.create_rectangle(MPI.COMM_SELF, corners, [5, 3], mesh.CellType.quadrilateral)
    v, u = (fem.Function(space(domain), name=name) for name in ("v", "u"))
    with io.XDMFFile(MPI.COMM_SELF, str(folder / "fields.xdmf"), "w") as file:
        file.write_mesh(domain)
        for time in (0.0, 0.5):
            v.interpolate(lambda x, time=time: (10 * time + 3 * x[0] - 2 * x[1], 5 * x[0] + x[1]))
            u.interpolate(lambda x, time=time: (1e-2 * x[0] - 3e-3 * x[1], time * 4e-2 * x[1]))
            file.write_function(v, time)
            file.write_function(u, time)
    print(f"DOLFINx {dolfinx.__version__}: fields.xdmf")


if __name__ == "__main__":
    assert len(sys.argv) == 2, __doc__
    main(Path(sys.argv[1]))
