"""Reading what `dgmpm export` wrote: the grid as Lagrange quadrilaterals, its time series, line samples.

The grid of degree N has (N+1)^2 nodes of its own per cell, equidistant in the parent square [0,1]^2. Every
field is a polynomial of degree N per direction there, so the interpolation of the nodes is the field itself.
"""

import csv
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np

VTK_QUAD = 9
VTK_LAGRANGE_QUADRILATERAL = 70


def lagrange_order(degree):
    """VTK's place of node (i, j) in a Lagrange quadrilateral, as an array [j, i]: corners, edges, interior."""
    n, inner = degree, degree - 1
    place = np.empty((n + 1, n + 1), dtype=int)
    for j in range(n + 1):
        for i in range(n + 1):
            at_i, at_j = i in (0, n), j in (0, n)
            if at_i and at_j:
                place[j, i] = (3 if j else 0) if not i else (2 if j else 1)
            elif at_j:
                place[j, i] = 4 + (i - 1) + (2 * inner if j else 0)
            elif at_i:
                place[j, i] = 4 + (j - 1) + (inner if i else 3 * inner)
            else:
                place[j, i] = 4 + 4 * inner + (i - 1) + inner * (j - 1)
    return place


def lagrange_values(degree, x):
    """Lagrange polynomials on the degree + 1 equidistant nodes of [0,1] at the points x: array [point, node]."""
    nodes = np.linspace(0.0, 1.0, degree + 1)
    values = np.ones((len(x), degree + 1))
    for a in range(degree + 1):
        for b in range(degree + 1):
            if a != b:
                values[:, a] *= (x - nodes[b]) / (nodes[a] - nodes[b])
    return values


def lagrange_slopes(degree, x):
    """Their derivatives: array [point, node]."""
    nodes = np.linspace(0.0, 1.0, degree + 1)
    slopes = np.zeros((len(x), degree + 1))
    for a in range(degree + 1):
        others = np.delete(nodes, a)
        for left_out in range(degree):
            rest = np.delete(others, left_out)
            slopes[:, a] += np.prod((x[:, None] - rest) / (nodes[a] - rest), axis=1) / (nodes[a] - others[left_out])
    return slopes


@dataclass
class Grid:
    """An exported grid: `fields[name]` is an array [cell, j, i, component], i along xi1 and j along xi2."""

    degree: int
    nodes: np.ndarray  # reference coordinates [cell, j, i, 2]
    fields: dict
    cell_fields: dict

    @property
    def corners(self):
        """Corners of the cells, counter-clockwise: [cell, 4, 2]."""
        x = self.nodes
        return np.stack([x[:, 0, 0], x[:, 0, -1], x[:, -1, -1], x[:, -1, 0]], axis=1)

    def evaluate(self, field, xi):
        """A field (its name, or [cell, j, i, component]) at parent points xi[point, 2]: [cell, point, component]."""
        values = self.fields[field] if isinstance(field, str) else field
        lx, ly = lagrange_values(self.degree, xi[:, 0]), lagrange_values(self.degree, xi[:, 1])
        return np.einsum("pi,pj,cjik->cpk", lx, ly, values, optimize=True)

    def map(self, xi):
        """X [cell, point, 2] and det dX/dxi [cell, point] of the cells at parent points xi[point, 2]; of degree 2 and more by all nodes, which
        hold curved cells exactly."""
        if self.degree >= 2:
            values, slopes = ([f(self.degree, xi[:, k]) for k in (0, 1)] for f in (lagrange_values, lagrange_slopes))
            position, t1, t2 = (
                np.einsum("pi,pj,cjik->cpk", x, y, self.nodes)
                for x, y in ((values[0], values[1]), (slopes[0], values[1]), (values[0], slopes[1]))
            )
            return position, t1[..., 0] * t2[..., 1] - t1[..., 1] * t2[..., 0]
        x, y = xi[:, 0], xi[:, 1]
        shape = np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=1)
        d_x = np.stack([y - 1, 1 - y, y, -y], axis=1)
        d_y = np.stack([x - 1, -x, x, 1 - x], axis=1)
        position, t1, t2 = (np.einsum("pa,cak->cpk", s, self.corners) for s in (shape, d_x, d_y))
        return position, t1[..., 0] * t2[..., 1] - t1[..., 1] * t2[..., 0]


def read_grid(path):
    """Reads a grid VTU through VTK itself."""
    import pyvista

    data = pyvista.read(path)
    kinds = set(np.unique(data.celltypes))
    if not kinds <= {VTK_QUAD, VTK_LAGRANGE_QUADRILATERAL} or len(kinds) != 1:
        raise ValueError(
            f"{path}: expected Lagrange quadrilaterals (70) of one degree, found VTK cell types {sorted(kinds)}"
        )
    sizes = np.diff(data.cell_offsets)
    degree = round(np.sqrt(sizes[0])) - 1
    if np.any(sizes != (degree + 1) ** 2):
        raise ValueError(f"{path}: cells of different or of no degree: {sorted(set(sizes))} nodes")
    nodes = data.cell_connectivity.reshape(-1, (degree + 1) ** 2)[:, lagrange_order(degree)]
    fields = {}
    for name in data.point_data:
        values = np.asarray(data.point_data[name])
        fields[name] = values.reshape(len(values), -1)[nodes]
    cell_fields = {name: np.asarray(data.cell_data[name]) for name in data.cell_data}
    return Grid(degree, np.asarray(data.points)[nodes][..., :2], fields, cell_fields)


def read_points(path):
    """Reads a VTU of material points: {field: array [point, ...]}, with their positions [point, 2] as `points`."""
    import pyvista

    data = pyvista.read(path)
    return {
        "points": np.asarray(data.points)[:, :2],
        **{name: np.asarray(data.point_data[name]) for name in data.point_data},
    }


def series(pvd):
    """The steps of a .pvd file: a list of (time, path)."""
    pvd = Path(pvd)
    steps = ElementTree.parse(pvd).iter("DataSet")
    return [(float(step.get("timestep")), pvd.parent / step.get("file")) for step in steps]


def export_folder(run):
    """The folder with `grid.pvd`, given a run folder or its export folder."""
    for folder in (Path(run), Path(run) / "export"):
        if (folder / "grid.pvd").is_file():
            return folder
    raise FileNotFoundError(f"{run}: no grid.pvd here nor in export/; run `dgmpm export` first")


def step_at(run, time=None, kind="grid"):
    """(time, path) of the exported step nearest to a time, the last one by default; kind: grid or points."""
    steps = series(export_folder(run) / f"{kind}.pvd")
    return steps[-1] if time is None else min(steps, key=lambda step: abs(step[0] - time))


def read_line(path, time=None):
    """A line output at the sampled time nearest to `time` (the last one by default): {column: array}."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    columns = dict(zip(rows[0], np.array(rows[1:], dtype=float).T))
    times = np.unique(columns["t"])
    chosen = times[-1] if time is None else times[np.argmin(abs(times - time))]
    return {name: values[columns["t"] == chosen] for name, values in columns.items()}


TENSOR_COMPONENTS = {"11": 0, "12": 1, "21": 3, "22": 4, "33": 8}
VECTOR_COMPONENTS = {"1": 0, "2": 1, "3": 2}


def component(values, name, field=""):
    """A component by its name: "11", "12", .. of a tensor, "1", .. or "norm" of a vector, "" of a scalar."""
    if name == "norm":
        return np.linalg.norm(values, axis=-1)
    table = {9: TENSOR_COMPONENTS, 3: VECTOR_COMPONENTS, 1: {"": 0}}[values.shape[-1]]
    if name not in table:
        raise ValueError(f"{field} has no component {name!r}; there are {', '.join(map(repr, table))}")
    return values[..., table[name]]


def subdivided(grid, pieces=None):
    """Triangles for matplotlib: each cell cut into pieces x pieces quads, nodes kept per cell.

    Returns (xi, triangles): parent points [point, 2] and the triangles of all cells over [cell * points].
    """
    pieces = pieces or max(2, 2 * grid.degree)
    s = np.linspace(0.0, 1.0, pieces + 1)
    xi = np.stack(np.meshgrid(s, s), axis=-1).reshape(-1, 2)
    a = (np.arange(pieces)[:, None] * (pieces + 1) + np.arange(pieces)).ravel()
    b, c, d = a + 1, a + pieces + 2, a + pieces + 1
    one = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    cells = np.arange(len(grid.nodes))[:, None, None] * len(xi)
    return xi, (cells + one).reshape(-1, 3)
