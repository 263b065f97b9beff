"""Reads every exported file of a folder by meshio, meshlane (its fork), VTK (pyvista) and h5py; all must give the same bits.

Usage: test_readers.py FOLDER      (written by tests/python_readers.rs, with the raw values beside the files)
Prints one line per check; exits with 1 if any failed. Leaves FOLDER/results.npz for dolfinx_mesh.py.
"""
import sys
from pathlib import Path

import h5py
import meshio
import meshlane
import numpy as np
import pyvista
import vtk
from vtk.util.numpy_support import vtk_to_numpy

FAILED = []


def check(what, good):
    print(("ok    " if good else "FAIL  ") + what)
    if not good:
        FAILED.append(what)


def same_bits(a, b):
    """Equal shapes (but for a last axis of length 1) and equal bits, NaN and -0.0 included."""
    a, b = (np.ascontiguousarray(np.asarray(v, dtype=np.float64)) for v in (a, b))
    return a.size == b.size and len(a) == len(b) and np.array_equal(a.ravel().view("u8"), b.ravel().view("u8"))


def raw(path, rows=None):
    values = np.fromfile(path, dtype="<f8")
    return values if rows is None else values.reshape(rows, -1)


def raw_fields(folder, rows):
    return {p.stem: raw(p, rows) for p in sorted(folder.glob("*.f64"))}


def total_area(grid):
    """Area of all cells by VTK's own evaluation of its (possibly high-order) cells."""
    sizes = grid.compute_cell_sizes(length=False, volume=False)
    return float(np.sum(np.abs(sizes["Area"])))


def check_vtu(path, expected, degree, is_grid):
    """One .vtu by meshio, meshlane and VTK against the raw values."""
    name = f"{path.parent.parent.name}/{path.name}"
    points = raw(expected / "points.f64").reshape(-1, 3)
    fields = raw_fields(expected / "point", len(points))
    per_cell = (max(degree, 1) + 1) ** 2 if is_grid else 1
    cells = len(points) // per_cell
    cell_fields = raw_fields(expected / "cell", cells) if is_grid else {}
    by_vtk, by_meshio, by_meshlane = pyvista.read(path), meshio.read(path), meshlane.read(path)
    python = (by_meshio, by_meshlane)
    kind = (9 if degree <= 1 else 70) if is_grid else 1
    check(f"{name}: VTK cells of type {kind}", by_vtk.n_cells == cells and set(by_vtk.celltypes) == {kind})
    check(f"{name}: meshio, meshlane cells", all(sum(len(b.data) for b in mesh.cells) == cells for mesh in python))
    owned = np.arange(len(points)).reshape(cells, per_cell)
    check(f"{name}: each cell owns its points", np.array_equal(by_vtk.cell_connectivity.reshape(owned.shape), owned)
          and all(np.array_equal(np.sort(np.vstack([b.data for b in mesh.cells]), axis=1), owned) for mesh in python))
    check(f"{name}: points", all(same_bits(mesh.points, points) for mesh in (by_vtk, *python)))
    check(f"{name}: names of fields", all(set(mesh.point_data) == set(fields) and set(mesh.cell_data) == set(cell_fields)
                                          for mesh in (by_vtk, *python)))
    for key, values in fields.items():
        good = all(same_bits(mesh.point_data[key], values) for mesh in (by_vtk, *python))
        check(f"{name}: point field {key}, VTK = meshio = meshlane = raw", good)
    for key, values in cell_fields.items():
        by_block = [np.concatenate(mesh.cell_data[key]) for mesh in python]
        good = all(same_bits(found, values) for found in (by_vtk.cell_data[key], *by_block))
        check(f"{name}: cell field {key}, VTK = meshio = meshlane = raw", good)
    if is_grid:
        check_order(name, by_vtk, degree)


def check_order(name, grid, degree):
    """VTK's own map of a cell is the bilinear one if, and only if, the order of the nodes is VTK's."""
    cell = vtk.vtkGenericCell()
    map_error = value_error = 0.0
    velocity = np.array(grid.point_data["velocity"])
    shift = velocity[0, 0] - (1 + 2 * grid.points[0, 0] - grid.points[0, 1])
    for c in range(grid.n_cells):
        grid.GetCell(c, cell)
        nodes = [cell.GetPointId(k) for k in range(cell.GetNumberOfPoints())]
        for r, s in ((0.3, 0.2), (0.71, 0.93)):
            x, weights = [0.0] * 3, [0.0] * len(nodes)
            cell.EvaluateLocation(vtk.reference(0), [r, s, 0.0], x, weights)
            bilinear = np.array([(1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s]) @ grid.points[nodes[:4]]
            exact = np.array([1 + 2 * x[0] - x[1] + shift, 3 * x[1] - x[0], 0.0])
            map_error = max(map_error, np.abs(x - bilinear).max())
            value_error = max(value_error, np.abs(np.array(weights) @ velocity[nodes] - exact).max())
    check(f"{name}: VTK's map of cells of degree {max(degree, 1)} (error {map_error:.1e})", map_error < 1e-13)
    check(f"{name}: VTK's interpolation of a linear field (error {value_error:.1e})", value_error < 1e-12)
    check(f"{name}: area by VTK", abs(total_area(grid) - 3.0) < 1e-9)


def check_pvd(path, expected_times, key, raw_of):
    """The series by pyvista: times, and one field at each of them."""
    reader = pyvista.PVDReader(str(path))
    name = f"{path.parent.name}/{path.name}"
    check(f"{name}: times", list(reader.time_values) == list(expected_times))
    for k, time in enumerate(reader.time_values):
        reader.set_active_time_value(time)
        values = reader.read()[0].point_data[key]
        check(f"{name}: {key} at t = {time:.3e}", same_bits(values, raw(raw_of(k), len(values))))


def vtk_series(path):
    """All steps of an XDMF file by VTK: (time, points, corner numbers, point data, cell data)."""
    reader = vtk.vtkXdmf3Reader() if hasattr(vtk, "vtkXdmf3Reader") else vtk.vtkXdmfReader()
    reader.SetFileName(str(path))
    reader.UpdateInformation()
    info = reader.GetOutputInformation(0)
    key = vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS()
    for k in range(info.Length(key)):
        reader.UpdateTimeStep(info.Get(key, k))
        data = pyvista.wrap(reader.GetOutputDataObject(0))
        while isinstance(data, pyvista.MultiBlock):
            data = data[len(data) - 1]  # the collection; before it stands the mesh alone
        yield info.Get(key, k), data


def check_xdmf(folder, degree, times):
    """The series by meshio, meshlane, VTK and h5py; the order of points is that of the .vtu."""
    path, name, n = folder / "series.xdmf", f"{folder.name}/series.xdmf", max(degree, 1)
    by_vtk = list(vtk_series(path))
    check(f"{name}: times by VTK", [t for t, _ in by_vtk] == list(times))
    with (meshio.xdmf.TimeSeriesReader(path) as reader, meshlane.xdmf.TimeSeriesReader(path) as lane,
          h5py.File(path.with_suffix(".h5")) as h5):
        points, cells = reader.read_points_cells()
        lane_points, lane_cells = lane.read_points_cells()
        check(f"{name}: mesh by meshlane", same_bits(lane_points, points)
              and np.array_equal(lane_cells[0].data, cells[0].data))
        expected_points = raw(folder / "raw/0/grid/points.f64").reshape(-1, 3)
        quads = cells[0].data
        check(f"{name}: points", same_bits(points, expected_points[:, :2]) and same_bits(h5["mesh/geometry"], points)
              and all(same_bits(d.points, expected_points) for _, d in by_vtk))
        whole = len(points) // (n + 1) ** 2
        check(f"{name}: {n} x {n} quadrilaterals a cell", quads.shape == (whole * n * n, 4)
              and all(np.array_equal(d.cell_connectivity.reshape(-1, 4), quads) for _, d in by_vtk))
        check(f"{name}: areas positive, sum 3", *[(a > 0).all() and abs(a.sum() - 3) < 1e-12 for a in [areas(points, quads)]])
        for k, time in enumerate(times):
            t, point_data, cell_data = reader.read_data(k)
            lane_t, lane_point_data, lane_cell_data = lane.read_data(k)
            data = by_vtk[k][1]
            check(f"{name}: time {k} by meshio, meshlane", t == time == lane_t)
            for key, values in raw_fields(folder / f"raw/{k}/grid/point", len(points)).items():
                stored = h5[f"step{k:06}/point/{key}"]
                good = all(same_bits(v, values) for v in (point_data[key], lane_point_data[key], stored, data.point_data[key]))
                check(f"{name}: point field {key} at {k}, meshio = meshlane = h5py = VTK = raw", good)
            for key, values in raw_fields(folder / f"raw/{k}/grid/cell", whole).items():
                values = np.repeat(values, n * n, axis=0)
                by_python = [np.concatenate(found[key]) for found in (cell_data, lane_cell_data)]
                good = all(same_bits(found, values) for found in (data.cell_data[key], *by_python))
                check(f"{name}: cell field {key} at {k}, meshio = meshlane = VTK = raw", good)
        return points, quads, reader.read_data(len(times) - 1)[1]["velocity"]


def areas(points, quads):
    a, b = points[quads[:, 2]] - points[quads[:, 0]], points[quads[:, 3]] - points[quads[:, 1]]
    return 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


def check_mesh(folder):
    """The bilinear mesh by meshio, meshlane and VTK."""
    mesh, lane = meshio.read(folder / "mesh.xdmf"), meshlane.read(folder / "mesh.xdmf")
    nodes = raw(folder / "pipeline/nodes.f64").reshape(-1, 2)
    quads = mesh.cells_dict["quad"]
    check("mesh.xdmf: nodes by meshio, meshlane", all(same_bits(one.points[:, :2], nodes) for one in (mesh, lane)))
    check("mesh.xdmf: cells by meshlane = meshio", np.array_equal(lane.cells_dict["quad"], quads)
          and np.array_equal(lane.cell_data["group"][0].ravel(), mesh.cell_data["group"][0].ravel()))
    check("mesh.xdmf: counter-clockwise, area 3", (areas(nodes, quads) > 0).all() and abs(areas(nodes, quads).sum() - 3) < 1e-12)
    group = mesh.cell_data["group"][0].ravel()
    reader = vtk.vtkXdmfReader()
    reader.SetFileName(str(folder / "mesh.xdmf"))
    reader.Update()
    by_vtk = pyvista.wrap(reader.GetOutputDataObject(0))
    by_vtk = by_vtk[0] if isinstance(by_vtk, pyvista.MultiBlock) else by_vtk
    check("mesh.xdmf: VTK = meshio", np.array_equal(by_vtk.cell_connectivity.reshape(-1, 4), quads)
          and np.array_equal(vtk_to_numpy(by_vtk.GetCellData().GetArray("group")), group))
    for library in (meshio, meshlane):
        edges = library.read(folder / "boundary.xdmf")
        check(f"boundary.xdmf: 14 edges by {library.__name__}", sum(len(b.data) for b in edges.cells) == 14)
    return nodes, quads, group


def check_pipeline(folder):
    """The project's own files by h5py."""
    with h5py.File(folder / "mesh.h5") as mesh, h5py.File(folder / "cloud.h5") as cloud:
        check("mesh.h5: nodes", same_bits(mesh["nodes"], raw(folder / "nodes.f64", len(mesh["nodes"]))))
        check("mesh.h5: names", [g.decode() for g in mesh["groups"]] == ["steel", 'acier "doux" é'])
        # Texts have fixed lengths, which h5py gives as bytes.
        format_and_version = [mesh.attrs[name].decode() for name in ("format", "version")]
        check("mesh.h5: format", format_and_version == ["dgmpm mesh", "1"])
        xi, first = np.array(cloud["xi"]), np.array(cloud["first"])
        check("cloud.h5: xi", same_bits(xi, raw(folder / "xi.f64", len(xi))))
        corners = np.array(mesh["nodes"])[np.array(mesh["cells"])][np.repeat(np.arange(len(first) - 1), np.diff(first))]
        r, s = xi.T
        weights = np.stack([(1 - r) * (1 - s), r * (1 - s), r * s, (1 - r) * s], axis=1)
        error = np.abs(np.einsum("pk,pki->pi", weights, corners) - cloud["positions"]).max()
        check("cloud.h5: positions", error < 1e-15 * 4)
    with h5py.File(folder / "snapshots/000123.h5") as state:
        check("snapshot: u", state["u"].shape == (12, 6, 3, 3) and same_bits(state["u"][()].ravel(), raw(folder / "u.f64")))
        check("snapshot: time, step", state["time"][()] == 1.77e-3 / 3 and state["step"][0] == 123)


def main(folder):
    times = [0.0, 1e-4 / 3.0, 3e-4]
    results = {}
    for degree in range(4):
        here = folder / f"degree{degree}"
        for k in range(len(times)):
            check_vtu(here / f"grid/grid_{k:06}.vtu", here / f"raw/{k}/grid", degree, True)
            check_vtu(here / f"points/points_{k:06}.vtu", here / f"raw/{k}/points", degree, False)
        check_pvd(here / "grid.pvd", times, "cauchy_stress", lambda k: here / f"raw/{k}/grid/point/cauchy_stress.f64")
        check_pvd(here / "points.pvd", times, "von_mises", lambda k: here / f"raw/{k}/points/point/von_mises.f64")
        for key, value in zip(("points", "quads", "velocity"), check_xdmf(here, degree, times)):
            results[f"{key}{degree}"] = value
    results["nodes"], results["cells"], results["group"] = check_mesh(folder)
    check_pipeline(folder / "pipeline")
    np.savez(folder / "results.npz", **results)
    versions = f"meshio {meshio.__version__}, meshlane {meshlane.__version__}, pyvista {pyvista.__version__}, VTK {vtk.vtkVersion().GetVTKVersion()}, h5py {h5py.__version__}"
    print(f"{versions}: {len(FAILED)} failed")
    return 1 if FAILED else 0


if __name__ == "__main__":
    assert len(sys.argv) == 2, __doc__
    sys.exit(main(Path(sys.argv[1])))
