"""Writes a mesh of Gmsh, with fields at its nodes, by meshio, meshlane (its fork) and VTK, in each mode of VTU, XDMF.
The test compares what dgmpm reads with the mesh and the fields.

Usage: mesh_files.py MESH FOLDER
"""
import sys
from pathlib import Path

import meshio
import meshlane
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk


def fields(points):
    """Vectors at the nodes, of two and of three numbers, which the test makes again to the bit."""
    x, y = points[:, 0], points[:, 1]
    return {"velocity": np.stack([2 * x, -y], axis=1), "displacement": np.stack([0.5 * x, 0.25 * y, 0 * x], axis=1)}


def by_meshio(library, path, folder):
    """All modes of meshio, or of a fork with its interface; its text of VTU may have 12 digits only."""
    mesh, name = library.read(path), library.__name__
    mesh.point_data = fields(mesh.points)
    # meshio 5.3.5 fails where it makes numbers of these for VTU.
    mesh.cell_sets = {}
    library.vtu.write(folder / f"{name}_text.vtu", mesh, binary=False)
    for compression in ("none", "zlib", "lzma"):
        for header in ("UInt32", "UInt64"):
            options = {"compression": None if compression == "none" else compression, "header_type": header}
            library.vtu.write(folder / f"{name}_{compression}_{header}.vtu", mesh, binary=True, **options)
    for kind in ("HDF", "XML"):
        library.xdmf.write(folder / f"{name}_{kind}.xdmf", mesh, data_format=kind)
    # As the tutorials of DOLFINx say: cells and facets in two files.
    for part, kind, plane in (("cells", "quad", True), ("facets", "line", False)):
        points = mesh.points[:, :2] if plane else mesh.points
        tags = mesh.get_cell_data("gmsh:physical", kind)
        part_mesh = library.Mesh(points, {kind: mesh.get_cells_type(kind)}, cell_data={"name_to_read": [tags]})
        library.write(folder / f"{name}_{part}.xdmf", part_mesh)


def grid_of(mesh):
    """The mesh as an unstructured grid of VTK, with the names of groups as field data."""
    grid, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    points.SetDataTypeToDouble()
    for x in mesh.points:
        points.InsertNextPoint(x)
    grid.SetPoints(points)
    kinds = {"line": vtk.VTK_LINE, "quad": vtk.VTK_QUAD}
    for block in mesh.cells:
        for nodes in block.data:
            grid.InsertNextCell(kinds[block.type], len(nodes), [int(node) for node in nodes])
    tags = numpy_to_vtk(np.concatenate(mesh.cell_data["gmsh:physical"]).astype(np.int32), deep=True)
    tags.SetName("gmsh:physical")
    grid.GetCellData().AddArray(tags)
    for name, values in fields(mesh.points).items():
        array = numpy_to_vtk(values, deep=True)
        array.SetName(name)
        grid.GetPointData().AddArray(array)
    for name, pair in mesh.field_data.items():
        array = numpy_to_vtk(np.asarray(pair, np.int64), deep=True)
        array.SetName(name)
        grid.GetFieldData().AddArray(array)
    return grid


def by_vtk(mesh, folder):
    """All modes of VTK but for lz4."""
    grid = grid_of(mesh)
    for mode in ("ascii", "binary", "appended_raw", "appended_base64"):
        for compression in ("none", "zlib", "lzma"):
            if mode == "ascii" and compression != "none":
                continue
            for header in (32, 64):
                for order in ("little", "big"):
                    writer = vtk.vtkXMLUnstructuredGridWriter()
                    writer.SetFileName(str(folder / f"vtk_{mode}_{compression}_{header}_{order}.vtu"))
                    writer.SetInputData(grid)
                    modes = {"ascii": vtk.vtkXMLWriter.Ascii, "binary": vtk.vtkXMLWriter.Binary}
                    writer.SetDataMode(modes.get(mode, vtk.vtkXMLWriter.Appended))
                    writer.SetEncodeAppendedData(mode == "appended_base64")
                    writer.SetCompressorType({"none": 0, "zlib": 1, "lzma": 3}[compression])
                    writer.SetHeaderType(header)
                    writer.SetByteOrder(0 if order == "big" else 1)
                    # Several blocks, the last of which is not full.
                    writer.SetBlockSize(256)
                    assert writer.Write() == 1


def main(path, folder):
    for library in (meshio, meshlane):
        by_meshio(library, path, folder)
    mesh = meshio.read(path)
    by_vtk(mesh, folder)
    print(f"{len(list(folder.glob('*.vtu')))} .vtu and {len(list(folder.glob('*.xdmf')))} .xdmf files")


if __name__ == "__main__":
    assert len(sys.argv) == 3, __doc__
    main(sys.argv[1], Path(sys.argv[2]))
