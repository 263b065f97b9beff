"""Reads the folder of a run: arrays of numpy, meshes of meshio, functions of DOLFINx.

Needs numpy and h5py; meshio or DOLFINx only where their objects are asked for. Where tools/ is on Python's path:

    from dgmpm_io import Run

    run = Run("runs/square")
    last = run.snapshots()[-1]              # the state after a step
    last.field("velocity")                  # m/s at the Gauss nodes, [cell, component, node]
    last.at([[0.5, 1.0]], "displacement")   # at points X: [point, component]
    last.norm("deformation")                # sqrt(int |F|^2 dX)
    last.to_meshio().write("last.vtu")      # bilinear in each cell, cells apart from each other
    last.function("velocity")               # a discontinuous Function of degree N, without loss

Positions are those of the initial configuration. Numbers are in SI units, per metre of thickness. A snapshot has the unknowns that
dgmpm steps (seals of files are not checked here: `dgmpm verify` does); stresses are made from them by the law of the scene and are in what `dgmpm export` writes.
docs/files.md has the layout of snapshots.
"""

import json
import tomllib
from pathlib import Path

import h5py
import numpy as np

#: Fields of a snapshot: the number of components of each.
FIELDS = {"deformation": 4, "momentum": 2, "velocity": 2, "displacement": 2, "jacobian": 1}


def gauss_nodes(degree):
    """The degree + 1 Gauss-Legendre points on [0, 1], and their weights."""
    x, w = np.polynomial.legendre.leggauss(degree + 1)
    return 0.5 * (x + 1), 0.5 * w


def lagrange(nodes, x):
    """l_k(x) of the polynomials through `nodes`: [..., k]."""
    x = np.asarray(x, float)[..., None]
    out = np.ones(x.shape[:-1] + (len(nodes),))
    for k, at in enumerate(nodes):
        for other in np.delete(nodes, k):
            out[..., k] *= (x[..., 0] - other) / (at - other)
    return out


def shape_functions(xi):
    """The bilinear functions of the four corners at parent coordinates [..., 2], then those of the bulges of the faces and of the
    middle: [..., 9]. A straight cell has the first four."""
    a, b = np.moveaxis(np.asarray(xi, float), -1, 0)
    bump_a, bump_b = 4 * a * (1 - a), 4 * b * (1 - b)
    corners = [(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b]
    bulges = [bump_b * (1 - a), bump_b * a, bump_a * (1 - b), bump_a * b, bump_a * bump_b]
    return np.stack(corners + bulges, axis=-1)


def shape_gradients(xi):
    """Their derivatives along xi: [..., function, 2]."""
    a, b = np.moveaxis(np.asarray(xi, float), -1, 0)
    bump_a, bump_b, slope_a, slope_b = 4 * a * (1 - a), 4 * b * (1 - b), 4 - 8 * a, 4 - 8 * b
    bulges_1 = [-bump_b, bump_b, slope_a * (1 - b), slope_a * b, slope_a * bump_b]
    bulges_2 = [slope_b * (1 - a), slope_b * a, -bump_a, bump_a, bump_a * slope_b]
    along_1 = np.stack([b - 1, 1 - b, b, -b] + bulges_1, axis=-1)
    along_2 = np.stack([a - 1, -a, a, 1 - a] + bulges_2, axis=-1)
    return np.stack([along_1, along_2], axis=-1)


def texts(dataset):
    """A list of texts of a file."""
    return [text.decode() if isinstance(text, bytes) else str(text) for text in dataset[...]]


class Mesh:
    """The cells of a run: `mesh.h5`, or a later grid. Corners of a cell run counter-clockwise; xi1 goes from the first to the second."""

    def __init__(self, path):
        with h5py.File(path) as file:
            self.nodes = file["nodes"][...]
            self.cells = file["cells"][...].astype(int)
            self.cell_group = file["cell_group"][...].astype(int)
            self.groups = texts(file["groups"])
            #: Edges of groups: cell, local face (xi1 = 0, xi1 = 1, xi2 = 0, xi2 = 1), group.
            self.edges = file["edges"][...].astype(int).reshape(-1, 3)
            self.edge_groups = texts(file["edge_groups"])
            #: The number of each cell in the file that the mesh came from.
            self.original = file["original"][...].astype(int)
            #: Of curved cells, in m: for faces 0 to 3 the way from the middle of the chord to that of the edge, then what is left at the
            #: middle of the cell, [cell, 5, 2]; None of a mesh with straight edges.
            self.bulges = file["bulges"][...] if "bulges" in file else None

    @property
    def corners(self):
        """X of the corners: [cell, corner, 2]."""
        return self.nodes[self.cells]

    @property
    def coefficients(self):
        """What the shape functions are multiplied by: the corners, and the bulges of a curved mesh, [cell, 4 or 9, 2]."""
        return self.corners if self.bulges is None else np.concatenate([self.corners, self.bulges], axis=1)

    def positions(self, xi):
        """X at parent coordinates [point, 2], of each cell: [cell, point, 2]."""
        of = self.coefficients
        return np.einsum("pk,cki->cpi", shape_functions(xi)[:, : of.shape[1]], of)

    def determinants(self, xi):
        """det dX/dxi there: [cell, point]."""
        of = self.coefficients
        return np.linalg.det(np.einsum("pkj,cki->cpij", shape_gradients(xi)[:, : of.shape[1]], of))

    def with_middles(self):
        """Of a curved mesh the numbers of the nodes in the middles of faces 0 to 3 and of each cell, [cell, 5], and X of all nodes: first
        those of the mesh."""
        places = self.positions(np.array([[0.0, 0.5], [1.0, 0.5], [0.5, 0.0], [0.5, 1.0], [0.5, 0.5]]))
        numbers, nodes, on_edges = np.empty((len(self.cells), 5), int), list(self.nodes), {}
        for cell, corners in enumerate(self.cells):
            ends = [(0, 3), (1, 2), (0, 1), (3, 2)]
            keys = [tuple(sorted((corners[a], corners[b]))) for a, b in ends] + [("cell", cell)]
            for face, key in enumerate(keys):
                if key not in on_edges:
                    on_edges[key] = len(nodes)
                    nodes.append(places[cell, face])
                numbers[cell, face] = on_edges[key]
        return numbers, np.array(nodes)

    def locate(self, points, tolerance=1e-9):
        """The cell of each point X, and its parent coordinates; a ValueError where one lies in no cell."""
        corners, points = self.corners, np.asarray(points, float).reshape(-1, 2)
        low, high = corners.min(axis=1), corners.max(axis=1)
        room = tolerance * (high - low).max(axis=1, keepdims=True)
        if self.bulges is not None:
            room = room + np.linalg.norm(self.bulges, axis=2).sum(axis=1, keepdims=True)
        cells, parents = np.empty(len(points), int), np.empty((len(points), 2))
        for number, x in enumerate(points):
            near = np.flatnonzero(((x >= low - room) & (x <= high + room)).all(axis=1))
            found = ((cell, self.parent_of(cell, x)) for cell in near)
            inside = ((cell, xi) for cell, xi in found if (np.abs(xi - 0.5) <= 0.5 + tolerance).all())
            cells[number], parents[number] = next(inside, (-1, np.nan))
            if cells[number] < 0:
                raise ValueError(f"the point X = ({x[0]}, {x[1]}) lies in no cell of the mesh")
        return cells, parents

    def parent_of(self, cell, x):
        """xi of a point X in a cell, by Newton's method."""
        of, xi = self.nodes[self.cells[cell]], np.array([0.5, 0.5])
        if self.bulges is not None:
            of = np.concatenate([of, self.bulges[cell]])
        for _ in range(30):
            step = np.linalg.solve(of.T @ shape_gradients(xi)[: len(of)], x - shape_functions(xi)[: len(of)] @ of)
            xi = xi + step
            if np.abs(step).max() < 1e-14:
                break
        return xi


class Snapshot:
    """The state after a step, at the Gauss nodes of the cells: node i M + j with i along xi1, M = degree + 1."""

    def __init__(self, path, mesh, densities):
        self.path, self.mesh = Path(path), mesh
        #: rho0 of each cell, kg/m^3.
        self.densities = densities
        with h5py.File(path) as file:
            self.time, self.step = float(file["time"][()].item()), int(file["step"][()].item())
            #: F11, F12, F21, F22, p1, p2: [cell, 6, M, M].
            self.u = file["u"][...]
            displacement = file["displacement"][...]
            #: What says where the state comes from: program, commit, kernel, hashes.
            self.attributes = {key: value.decode() if isinstance(value, bytes) else value for key, value in file.attrs.items()}
        self.degree = self.u.shape[-1] - 1
        #: u1, u2 in m: [cell, 2, M, M]; None where the run did not carry it along.
        self.displacement = displacement if displacement.size else None
        self.nodes_1d, self.weights_1d = gauss_nodes(self.degree)

    @property
    def xi(self):
        """Parent coordinates of the nodes: [node, 2]."""
        return np.stack(np.meshgrid(self.nodes_1d, self.nodes_1d, indexing="ij"), axis=-1).reshape(-1, 2)

    @property
    def masses(self):
        """The weights w J of the nodes in integrals over X, m^2: [cell, node]."""
        return self.mesh.determinants(self.xi) * np.outer(self.weights_1d, self.weights_1d).ravel()

    def field(self, name):
        """One of FIELDS at the nodes: [cell, component, node]."""
        if name not in FIELDS:
            raise KeyError(f"no field `{name}`; a snapshot has {', '.join(FIELDS)}")
        u = self.u.reshape(len(self.u), 6, -1)
        if name == "displacement":
            if self.displacement is None:
                raise KeyError(f"{self.path} has no displacement: the run did not carry it along")
            return self.displacement.reshape(len(u), 2, -1)
        if name == "velocity":
            return u[:, 4:] / self.densities[:, None, None]
        if name == "jacobian":
            return (u[:, 0] * u[:, 3] - u[:, 1] * u[:, 2])[:, None]
        return u[:, :4] if name == "deformation" else u[:, 4:]

    def in_cells(self, name, xi):
        """A field at parent coordinates [point, 2] of each cell: [cell, point, component]."""
        xi = np.asarray(xi, float).reshape(-1, 2)
        along = [lagrange(self.nodes_1d, xi[:, axis]) for axis in (0, 1)]
        weights = np.einsum("pi,pj->pij", *along).reshape(len(xi), -1)
        return np.einsum("pn,ckn->cpk", weights, self.field(name))

    def at(self, points, name):
        """A field at points X of the initial configuration: [point, component]."""
        cells, parents = self.mesh.locate(points)
        along = [lagrange(self.nodes_1d, parents[:, axis]) for axis in (0, 1)]
        weights = np.einsum("pi,pj->pij", *along).reshape(len(parents), -1)
        return np.einsum("pn,pkn->pk", weights, self.field(name)[cells])

    def integral(self, name):
        """int of each component over X."""
        return np.einsum("cn,ckn->k", self.masses, self.field(name))

    def norm(self, name):
        """sqrt(int f^2 dX) of each component, as `norms` of summary.json for a law without internal variables."""
        return np.sqrt(np.einsum("cn,ckn->k", self.masses, self.field(name) ** 2))

    def to_meshio(self, fields=None):
        """A mesh of meshio with the fields at the corners of each cell (cells share no node), and the groups of cells."""
        import meshio

        known = [name for name in FIELDS if name != "displacement" or self.displacement is not None]
        corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
        points = self.mesh.positions(corners).reshape(-1, 2)
        quads = np.arange(len(points)).reshape(-1, 4)
        data = {name: self.in_cells(name, corners).reshape(-1, FIELDS[name]) for name in fields or known}
        data = {name: values[:, 0] if values.shape[1] == 1 else values for name, values in data.items()}
        return meshio.Mesh(
            np.pad(points, ((0, 0), (0, 1))), [("quad", quads)], data, {"group": [self.mesh.cell_group]}
        )

    def function(self, name, mesh=None):
        """A discontinuous DOLFINx Function of degree N with the same polynomials, on `mesh` or on a new mesh (one process)."""
        import dolfinx
        from dolfinx import fem

        mesh = mesh or self.dolfinx_mesh()
        size = FIELDS[name]
        make = getattr(fem, "functionspace", None)
        if make is not None:
            space = make(mesh, ("DG", self.degree) if size == 1 else ("DG", self.degree, (size,)))
        else:
            space = fem.FunctionSpace(mesh, ("DG", self.degree)) if size == 1 else fem.VectorFunctionSpace(mesh, ("DG", self.degree), size)
        out = fem.Function(space)
        places = space.tabulate_dof_coordinates()[:, :2]
        values = out.x.array.reshape(-1, size)
        for cell, original in enumerate(cell_numbers(dolfinx, mesh)):
            dofs = space.dofmap.cell_dofs(cell)
            xi = np.array([self.mesh.parent_of(original, x) for x in places[dofs]])
            along = [lagrange(self.nodes_1d, xi[:, axis]) for axis in (0, 1)]
            weights = np.einsum("pi,pj->pij", *along).reshape(len(xi), -1)
            values[dofs] = weights @ self.field(name)[original].T
        return out

    def dolfinx_mesh(self):
        """The mesh for DOLFINx, on one process."""
        import ufl
        from dolfinx.mesh import create_mesh
        from mpi4py import MPI

        # DOLFINx numbers the corners of a quadrilateral line by line, then the middles of its lower, left, right and upper edge.
        cells, nodes = self.mesh.cells[:, [0, 1, 3, 2]], self.mesh.nodes
        degree = 1 if self.mesh.bulges is None else 2
        if degree == 2:
            middles, nodes = self.mesh.with_middles()
            cells = np.concatenate([cells, middles[:, [2, 0, 1, 3, 4]]], axis=1)
        cells = np.ascontiguousarray(cells).astype(np.int64)
        try:
            import basix.ufl

            element = basix.ufl.element("Lagrange", "quadrilateral", degree, shape=(2,))
        except ImportError:
            element = ufl.VectorElement("Lagrange", ufl.quadrilateral, degree)
        domain = ufl.Mesh(element)
        return create_mesh(MPI.COMM_SELF, cells, nodes, domain)


def cell_numbers(dolfinx, mesh):
    """The number in the input of each cell of a mesh of DOLFINx."""
    numbers = mesh.topology.original_cell_index
    return np.asarray(numbers if not callable(numbers) else numbers())


class Run:
    """The folder that `dgmpm run` has written."""

    def __init__(self, folder):
        self.folder = Path(folder)
        if not (self.folder / "scene.toml").is_file():
            raise FileNotFoundError(f"{self.folder} is not the folder of a run: it has no scene.toml")
        #: What the scene says, as tables.
        self.scene = tomllib.loads((self.folder / "scene.toml").read_text())
        summary = self.folder / "summary.json"
        #: What the run says at its end; empty where it has not ended.
        self.summary = json.loads(summary.read_text()) if summary.is_file() else {}
        self._meshes = {}

    def mesh(self, name="mesh.h5"):
        """A grid of the run, by the name of its file; read once."""
        if name not in self._meshes:
            self._meshes[name] = Mesh(self.folder / name)
        return self._meshes[name]

    def densities(self, mesh):
        """rho0 of each cell, kg/m^3: that of the [[material]] of its group."""
        materials = self.scene["material"]

        def of(group):
            return next(m["density"] for m in materials if m.get("group", group) == group)

        return np.array([of(group) for group in mesh.groups], float)[mesh.cell_group]

    def files(self):
        """The files of snapshots, in the order of steps."""
        files = (self.folder / "snapshots").glob("*.h5")
        return sorted((file for file in files if file.stem.isdigit()), key=lambda file: int(file.stem))

    def snapshot(self, file):
        """A snapshot, by its file or its step."""
        is_step = isinstance(file, int | np.integer)
        path = self.folder / "snapshots" / f"{file:06}.h5" if is_step else Path(file)
        if not path.is_file():
            raise FileNotFoundError(f"no snapshot {path}")
        with h5py.File(path) as store:
            name = store.attrs.get("mesh", "mesh.h5")
        mesh = self.mesh(name.decode() if isinstance(name, bytes) else name)
        return Snapshot(path, mesh, self.densities(mesh))

    def snapshots(self):
        """All snapshots, in the order of steps; each is read when it is taken."""
        return Snapshots(self)

    def table(self, name="ledger"):
        """A table as an array with named columns: `ledger`, `lines/bottom`, `tracks/walls`."""
        return np.atleast_1d(np.genfromtxt(self.folder / f"{name}.csv", delimiter=",", names=True, deletechars=""))


class Snapshots:
    """The snapshots of a run, read one by one."""

    def __init__(self, run):
        self.run, self.files = run, run.files()

    def __len__(self):
        return len(self.files)

    def __getitem__(self, number):
        if isinstance(number, slice):
            return [self.run.snapshot(file) for file in self.files[number]]
        if not -len(self.files) <= number < len(self.files):
            raise IndexError(f"{self.run.folder} has {len(self.files)} snapshots")
        return self.run.snapshot(self.files[number])
