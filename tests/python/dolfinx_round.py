"""Reads a mesh of `dgmpm mesh --out mesh.xdmf` by DOLFINx, with the groups of cells and of edges, and writes it again.

Usage: dolfinx_round.py IN.xdmf FOLDER
Writes FOLDER/all.xdmf (mesh and tags), FOLDER/text.xdmf (the same as text), and FOLDER/mesh.xdmf with FOLDER/facets.xdmf.
"""
import sys
from pathlib import Path

from dolfinx import fem
from dolfinx.io import XDMFFile
from mpi4py import MPI
import ufl


def read(path):
    with XDMFFile(MPI.COMM_SELF, path, "r") as file:
        mesh = file.read_mesh(name="mesh")
        mesh.topology.create_connectivity(1, 2)
        mesh.topology.create_connectivity(1, 0)
        return mesh, file.read_meshtags(mesh, "cell_tags"), file.read_meshtags(mesh, "facet_tags")


def write(path, mesh, tags, encoding=XDMFFile.Encoding.HDF5):
    with XDMFFile(MPI.COMM_SELF, str(path), "w", encoding=encoding) as file:
        if mesh is not None:
            file.write_mesh(mesh)
        for one in tags:
            file.write_meshtags(one)


def main(path, folder):
    mesh, cells, facets = read(path)
    cells.name, facets.name = "cell_tags", "facet_tags"
    dx = ufl.Measure("dx", domain=mesh, subdomain_data=cells)
    # The areas of steel and soft are those of the geometry.
    for number, area in ((1, 1.1), (2, 0.9)):
        found = fem.assemble_scalar(fem.form(fem.Constant(mesh, 1.0) * dx(number)))
        assert abs(found - area) < 1e-12, (number, found)
    write(folder / "all.xdmf", mesh, [cells, facets])
    write(folder / "text.xdmf", mesh, [cells, facets], XDMFFile.Encoding.ASCII)
    write(folder / "mesh.xdmf", mesh, [cells])
    write(folder / "facets.xdmf", None, [facets])


if __name__ == "__main__":
    assert len(sys.argv) == 3, __doc__
    main(sys.argv[1], Path(sys.argv[2]))
